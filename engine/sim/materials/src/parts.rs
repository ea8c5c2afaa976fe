//! Boxes with their faces, and clusters of ground polygons: the parts of a scene.

use crate::building_form::BuildingForm;
use crate::kerbs::KerbLine;
use crate::pattern::hash;
use crate::roof_step::RoofStep;
use crate::slanted_wall::SlantedWall;
use crate::thing_form::ThingForm;
use cosfly_domain::{Obstacle, ObstacleKind, SemanticLabel, Town};
use cosfly_frames::{DVec3, real};
use glam::Vec3A as Vec3;
use std::collections::BTreeMap;

/// An obstacle's box with what drawing it needs.
#[derive(Clone)]
pub struct SceneBox {
    /// Corners: bit 0 of the number is high x, bit 1 high y, bit 2 high z.
    pub corners_in_world: [DVec3; 8],
    /// Middle.
    pub center_in_world: DVec3,
    /// Half the size of the box along the axes of the world around it.
    pub half_bounds_m: DVec3,
    /// Half its size along its own axes.
    pub half_extents_m: Vec3,
    /// Unit vectors of the box's own x and y axes.
    pub axes_in_world: [DVec3; 2],
    /// Outward unit normals of its upright faces; they rise where the box was cut to the slopes of a roof.
    pub sides_in_world: [DVec3; 4],
    /// Outward unit normal of its upper face.
    pub top_in_world: DVec3,
    /// Kind.
    pub kind: ObstacleKind,
    /// CARLA label id.
    pub label: u8,
    /// Instance id.
    pub instance: u32,
    /// Seed shared by all boxes of one thing.
    pub seed: u32,
    /// Seed shared by all boxes of a town.
    pub town: u32,
    /// Middle and half size of the whole crown or building that the box belongs to; of the box itself for other kinds.
    pub whole: [Vec3; 2],
    /// Form of the building that it belongs to.
    pub form: BuildingForm,
    /// What the part of a thing is.
    pub thing: ThingForm,
    /// Sides, in the order of the faces, that stand at a pavement or paved ground: shops are there alone.
    pub is_at_street: [bool; 4],
    /// Place in a pitched roof; none for most boxes.
    pub roof: Option<Box<RoofStep>>,
    /// Sides, in the order of the faces, on which the flat roof of a building goes on over another box, or ends at a wall.
    pub roof_goes_on: [bool; 4],
    /// Slanted walls that its sides are parts of, in the order of the faces; none for most boxes.
    pub slants: Option<Box<[Option<SlantedWall>; 4]>>,
}

/// A box's six faces: outward axis (0 x, 1 y, 2 z), its sign, and the corner numbers around it.
pub const BOX_FACES: [(usize, f64, [usize; 4]); 6] = [
    (0, -1.0, [0, 2, 6, 4]),
    (0, 1.0, [1, 3, 7, 5]),
    (1, -1.0, [0, 1, 5, 4]),
    (1, 1.0, [2, 3, 7, 6]),
    (2, -1.0, [0, 1, 3, 2]),
    (2, 1.0, [4, 5, 7, 6]),
];

impl SceneBox {
    /// The slanted wall that an upright face is a part of.
    pub fn slanted(&self, face: usize) -> Option<SlantedWall> {
        self.slants.as_deref()?.get(face).copied().flatten()
    }

    /// Outward unit normal of face `face`.
    #[inline]
    pub fn normal_in_world(&self, face: usize) -> DVec3 {
        match face {
            0..4 => self.sides_in_world[face],
            4 => -DVec3::Z,
            _ => self.top_in_world,
        }
    }
}

/// Neighbouring ground polygons with shared points and a bounding box.
pub struct Cluster {
    /// Middle of the box around it.
    pub center_in_world: DVec3,
    /// Half the size of that box.
    pub half_bounds_m: DVec3,
    /// Points that the polygons share.
    pub points_in_world: Vec<DVec3>,
    /// Polygons.
    pub polygons: Vec<ClusterPolygon>,
    /// Corners of all polygons, point numbers within the cluster.
    pub corners: Vec<u16>,
}

/// A ground polygon.
#[derive(Clone, Copy)]
pub struct ClusterPolygon {
    /// First corner in the cluster's list.
    pub first: u32,
    /// Corners.
    pub count: u32,
    /// Label.
    pub label: SemanticLabel,
    /// Unit normal.
    pub normal_in_world: DVec3,
    /// A point of its plane.
    pub middle_in_world: DVec3,
    /// The kerb beside it.
    pub kerb: KerbLine,
}

impl ClusterPolygon {
    /// Corners in the cluster's list.
    #[inline]
    pub fn range(&self) -> core::ops::Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }

    /// The point of its plane above or below a point.
    #[inline]
    pub fn on_plane(&self, point: DVec3) -> DVec3 {
        let off = (point - self.middle_in_world).dot(self.normal_in_world);
        point - self.normal_in_world * off
    }
}

/// The boxes of a town that are finite.
pub fn boxes_of(town: &Town, look_seed: u32) -> Vec<SceneBox> {
    town.obstacles.iter().filter_map(|obstacle| scene_box(obstacle, look_seed)).collect()
}

fn scene_box(obstacle: &Obstacle, look_seed: u32) -> Option<SceneBox> {
    let shape = &obstacle.shape;
    let half = shape.half_extents_m;
    if !shape.center_in_world.is_finite() || !half.is_finite() || !shape.yaw_rad.is_finite() || half.min_element() < 0.0
    {
        return None;
    }
    let (sin, cos) = real::sin_cos(shape.yaw_rad);
    let (low, high) = shape.bounds_in_world();
    let axes_in_world = [DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0)];
    Some(SceneBox {
        corners_in_world: shape.corners_in_world(),
        center_in_world: shape.center_in_world,
        half_bounds_m: 0.5 * (high - low),
        half_extents_m: half.as_vec3a(),
        axes_in_world,
        sides_in_world: [-axes_in_world[0], axes_in_world[0], -axes_in_world[1], axes_in_world[1]],
        top_in_world: DVec3::Z,
        kind: obstacle.kind,
        label: obstacle.kind.label().id(),
        instance: obstacle.object_id.saturating_add(2),
        seed: hash(obstacle.object_id, look_seed),
        town: look_seed,
        whole: [shape.center_in_world.as_vec3a(), half.as_vec3a()],
        form: BuildingForm::Block,
        thing: ThingForm::Plain,
        is_at_street: [false; 4],
        roof: None,
        roof_goes_on: [false; 4],
        slants: None,
    })
}

/// Tells the boxes of each crown and building how large the whole is: light falls on a crown as on one round thing, and a building
/// has one facade.
pub fn join_wholes(boxes: &mut [SceneBox]) {
    let has_whole = |b: &SceneBox| matches!(b.kind, ObstacleKind::TreeCrown | ObstacleKind::Building);
    let mut bounds: BTreeMap<u32, (DVec3, DVec3)> = BTreeMap::new();
    for b in boxes.iter().filter(|b| has_whole(b)) {
        let (low, high) = bounds.entry(b.instance).or_insert((DVec3::INFINITY, DVec3::NEG_INFINITY));
        *low = low.min(b.center_in_world - b.half_bounds_m);
        *high = high.max(b.center_in_world + b.half_bounds_m);
    }
    for b in boxes.iter_mut().filter(|b| has_whole(b)) {
        if let Some((low, high)) = bounds.get(&b.instance) {
            b.whole = [(0.5 * (*low + *high)).as_vec3a(), (0.5 * (*high - *low)).as_vec3a()];
        }
    }
}
