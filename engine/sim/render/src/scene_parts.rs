//! Boxes with their faces, and clusters of ground polygons: the parts of a scene.

use crate::roof_steps::RoofStep;
use cosfly_frames::DVec3;
use cosfly_maps::{ObstacleKind, SemanticLabel};
use glam::Vec3A as Vec3;

/// An obstacle's box with what drawing it needs.
pub(crate) struct SceneBox {
    pub corners_in_world: [DVec3; 8],
    pub center_in_world: DVec3,
    pub half_bounds_m: DVec3,
    pub half_extents_m: Vec3,
    /// Unit vectors of the box's own x and y axes.
    pub axes_in_world: [DVec3; 2],
    pub kind: ObstacleKind,
    pub label: u8,
    pub instance: u32,
    /// The same for all boxes of one thing.
    pub seed: u32,
    /// The same for all boxes of a town.
    pub town: u32,
    /// Middle and half size of the whole crown that a crown's box belongs to; of the box itself for other kinds.
    pub whole: [Vec3; 2],
    /// Place in a pitched roof; none for most boxes.
    pub roof: Option<Box<RoofStep>>,
    /// Sides, in the order of the faces, on which the flat roof of a building goes on over another box, or ends at a wall.
    pub roof_goes_on: [bool; 4],
}

/// A box's six faces: outward axis (0 x, 1 y, 2 z), its sign, and the corner numbers around it.
pub(crate) const BOX_FACES: [(usize, f64, [usize; 4]); 6] = [
    (0, -1.0, [0, 2, 6, 4]),
    (0, 1.0, [1, 3, 7, 5]),
    (1, -1.0, [0, 1, 5, 4]),
    (1, 1.0, [2, 3, 7, 6]),
    (2, -1.0, [0, 1, 3, 2]),
    (2, 1.0, [4, 5, 7, 6]),
];

impl SceneBox {
    /// Outward unit normal of face `face`.
    pub fn normal_in_world(&self, face: usize) -> DVec3 {
        let (axis, sign, _) = BOX_FACES[face];
        sign * if axis == 2 { DVec3::Z } else { self.axes_in_world[axis] }
    }
}

/// Neighbouring ground polygons with shared points and a bounding box.
pub(crate) struct Cluster {
    pub center_in_world: DVec3,
    pub half_bounds_m: DVec3,
    pub points_in_world: Vec<DVec3>,
    pub polygons: Vec<ClusterPolygon>,
    /// Corners of all polygons, point numbers within the cluster.
    pub corners: Vec<u16>,
}

/// A ground polygon.
#[derive(Clone, Copy)]
pub(crate) struct ClusterPolygon {
    /// First corner in the cluster's list.
    pub first: u32,
    pub count: u32,
    pub label: SemanticLabel,
    pub normal_in_world: DVec3,
    /// A point of its plane.
    pub middle_in_world: DVec3,
}

impl ClusterPolygon {
    /// Corners in the cluster's list.
    pub fn range(&self) -> core::ops::Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }

    /// The point of its plane above or below a point.
    pub fn on_plane(&self, point: DVec3) -> DVec3 {
        let off = (point - self.middle_in_world).dot(self.normal_in_world);
        point - self.normal_in_world * off
    }
}
