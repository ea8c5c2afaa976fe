//! [`LidarScene`]: what rays meet in a town, with labels and instance ids.

use cosfly_frames::DVec3;
use cosfly_geometry::{SpatialQuery, TriangleBvh};

/// A triangle that rays meet on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LidarTriangle {
    /// Corners, metres.
    pub corners_in_world: [DVec3; 3],
    /// CARLA label id.
    pub label: u8,
    /// Instance id.
    pub instance: u32,
}

/// Surfaces with their owners, ready for rays.
pub struct LidarScene {
    tree: TriangleBvh,
    /// Label and instance id of each triangle.
    owners: Vec<(u8, u32)>,
}

/// First surface that a ray met.
#[derive(Clone, Copy)]
pub(super) struct Echo {
    pub(super) distance_m: f64,
    pub(super) label: u8,
    pub(super) instance: u32,
    /// Cosine of the angle between ray and surface normal.
    pub(super) cosine: f64,
}

impl LidarScene {
    /// The scene of these triangles.
    pub fn new(triangles: &[LidarTriangle]) -> Self {
        let corners: Vec<DVec3> = triangles.iter().flat_map(|triangle| triangle.corners_in_world).collect();
        let numbers: Vec<[u32; 3]> = (0..triangles.len() as u32).map(|it| [3 * it, 3 * it + 1, 3 * it + 2]).collect();
        let owners = triangles.iter().map(|triangle| (triangle.label, triangle.instance)).collect();
        Self { tree: TriangleBvh::build(&corners, &numbers), owners }
    }

    /// The first thing along a unit vector within `range_m`.
    pub(super) fn echo(&self, from: DVec3, ray: DVec3, range_m: f64) -> Option<Echo> {
        let hit = self.tree.closest_hit(from, ray, range_m)?;
        let (label, instance) = self.owners[hit.primitive as usize];
        let normal = self.tree.triangles()[hit.primitive as usize].unit_normal();
        Some(Echo { distance_m: hit.t, label, instance, cosine: normal.dot(ray).abs() })
    }
}
