//! Queries of a voxel search, and the engine's own tree that answers them.

use cosfly_frames::DVec3;
use cosfly_geometry::{BoxBvh, SpatialQuery};

/// Visibility and clearance among obstacles that stand still. World frame, metres.
pub trait StaticSight {
    /// Sets for each of the `body` points whether an obstacle hides it from `camera`.
    fn hide(&self, camera: DVec3, body: &[DVec3], hidden: &mut [bool]);

    /// Signed distance to the nearest obstacle, capped at `within_m`.
    fn distance_m(&self, point: DVec3, within_m: f64) -> f64;

    /// Smallest distance of the segment to an obstacle, capped at `within_m`.
    fn segment_clearance_m(&self, from: DVec3, to: DVec3, within_m: f64) -> f64;
}

impl StaticSight for BoxBvh {
    fn hide(&self, camera: DVec3, body: &[DVec3], hidden: &mut [bool]) {
        self.blocked_batch(camera, body, hidden);
    }

    fn distance_m(&self, point: DVec3, within_m: f64) -> f64 {
        self.nearest(point, within_m).map_or(within_m, |near| near.distance_m)
    }

    fn segment_clearance_m(&self, from: DVec3, to: DVec3, within_m: f64) -> f64 {
        self.segment_clearance(from, to, within_m)
    }
}
