//! Labels and ids of a mesh: those of the boxes and the ground that its town has in the same places.

use cosfly_domain::{OrientedBox, SemanticLabel, Town, object_instance};
use cosfly_frames::DVec3;
use cosfly_geometry::{BoxBvh, SpatialQuery, TriangleBvh};
use cosfly_models::mesh::TexturedMesh;
use rayon::prelude::*;

/// A triangle this near to the ground is ground, metres.
const ON_GROUND_M: f64 = 0.05;
/// A level triangle this near to the ground is ground unless it is part of a box that stands higher, metres.
const NEAR_GROUND_M: f64 = 0.3;
/// Triangles farther from all boxes and from the ground belong to nothing, metres.
const FARTHEST_M: f64 = 1.0;
/// Share of the normal of level triangles that points up.
const LEVEL: f64 = 0.8;

/// Label and instance id of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshLook {
    /// CARLA label id.
    pub label: u8,
    /// Instance id, 0 for ground.
    pub instance: u32,
    /// Whether the town has nothing there.
    pub is_unknown: bool,
}

/// Boxes and ground of a town, by place.
struct Places<'a> {
    town: &'a Town,
    boxes: BoxBvh,
    ground: TriangleBvh,
    labels: Vec<SemanticLabel>,
}

/// The look of each triangle of a mesh.
pub(crate) fn looks(mesh: &TexturedMesh, town: &Town) -> Vec<MeshLook> {
    let places = Places::of(town);
    mesh.triangles.par_iter().map(|triangle| places.look(triangle.corners())).collect()
}

impl<'a> Places<'a> {
    fn of(town: &'a Town) -> Self {
        let shapes: Vec<OrientedBox> = town.obstacles.iter().map(|obstacle| obstacle.shape).collect();
        let (mut vertices, mut triangles, mut labels) = (Vec::new(), Vec::new(), Vec::new());
        for surface in &town.surfaces {
            let first = vertices.len() as u32;
            vertices.extend(&surface.vertices_in_world);
            triangles.extend(surface.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
            labels.resize(triangles.len(), surface.label);
        }
        Self { town, boxes: BoxBvh::build(shapes), ground: TriangleBvh::build(&vertices, &triangles), labels }
    }

    fn look(&self, corners: [DVec3; 3]) -> MeshLook {
        let middle = corners.into_iter().sum::<DVec3>() / 3.0;
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
        let on_ground = |label: SemanticLabel| MeshLook { label: label.id(), instance: 0, is_unknown: false };
        if let Some(label) = self.ground_at(middle, ON_GROUND_M) {
            return on_ground(label);
        }
        let thing = self.boxes.nearest(middle, FARTHEST_M);
        let is_level = normal.z.abs() > LEVEL;
        if is_level
            && thing.is_none_or(|near| near.distance_m > 0.0 || self.top_m(near.primitive) < middle.z + NEAR_GROUND_M)
            && let Some(label) = self.ground_at(middle, NEAR_GROUND_M)
        {
            return on_ground(label);
        }
        if let Some(near) = thing {
            let obstacle = &self.town.obstacles[near.primitive as usize];
            let instance = object_instance(obstacle.object_id);
            return MeshLook { label: obstacle.kind.label().id(), instance, is_unknown: false };
        }
        match self.ground_at(middle, FARTHEST_M) {
            Some(label) => on_ground(label),
            None => MeshLook { label: SemanticLabel::Other.id(), instance: 0, is_unknown: true },
        }
    }

    /// Height of the top of a box, metres.
    fn top_m(&self, number: u32) -> f64 {
        let shape = &self.town.obstacles[number as usize].shape;
        shape.center_in_world.z + shape.half_extents_m.z
    }

    /// Label of the ground within a distance: of layers in one place, the triangle whose middle is nearest, so that a mesh that is the
    /// map itself finds its own.
    fn ground_at(&self, middle: DVec3, within_m: f64) -> Option<SemanticLabel> {
        let mut best: Option<(f64, u32)> = None;
        let reach = DVec3::splat(within_m);
        self.ground.within(middle - reach, middle + reach, &mut |number| {
            let triangle = &self.ground.triangles()[number as usize];
            if triangle.closest_point(middle).distance(middle) <= within_m {
                let away = (triangle.corners_in_world.into_iter().sum::<DVec3>() / 3.0).distance_squared(middle);
                let is_better = best.is_none_or(|(least, other)| (away, number) < (least, other));
                best = if is_better { Some((away, number)) } else { best };
            }
        });
        best.map(|(_, number)| self.labels[number as usize])
    }
}
