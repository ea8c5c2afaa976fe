//! Queries of a voxel search, and the engine's own tree that answers them.

use cosfly_frames::DVec3;
use cosfly_geometry::{BoxBvh, SpatialQuery};

/// Visibility and clearance among obstacles that stand still. World frame, metres.
pub trait Sight {
    /// Number of the `body` points that an unoccluded ray from `camera` reaches.
    fn visible_points(&self, camera: DVec3, body: &[DVec3]) -> usize;

    /// Signed distance to the nearest obstacle, capped at `within_m`.
    fn distance_m(&self, point: DVec3, within_m: f64) -> f64;

    /// Smallest distance of the segment to an obstacle, capped at `within_m`.
    fn segment_clearance_m(&self, from: DVec3, to: DVec3, within_m: f64) -> f64;
}

impl Sight for BoxBvh {
    fn visible_points(&self, camera: DVec3, body: &[DVec3]) -> usize {
        let mut blocked = [false; crate::visibility::BODY_POINTS];
        let blocked = &mut blocked[..body.len()];
        self.blocked_batch(camera, body, blocked);
        blocked.iter().filter(|&&hidden| !hidden).count()
    }

    fn distance_m(&self, point: DVec3, within_m: f64) -> f64 {
        self.nearest(point, within_m).map_or(within_m, |near| near.distance_m)
    }

    fn segment_clearance_m(&self, from: DVec3, to: DVec3, within_m: f64) -> f64 {
        self.segment_clearance(from, to, within_m)
    }
}
