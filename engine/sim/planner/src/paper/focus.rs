//! Surroundings that get ready for queries near a set of waypoints.

use cosfly_frames::DVec3;
use cosfly_surroundings::Surroundings;
use cosfly_surroundings::local::LocalObstacles;

/// Surroundings that may get ready for queries near a set of waypoints; brute force and trees have nothing to do.
pub trait FocusedSurroundings {
    /// The surroundings to be asked.
    fn answers(&self) -> &(dyn Surroundings + Sync);

    /// Says that the next queries will be near these waypoints, one per frame (world frame, metres).
    fn focus_on(&mut self, waypoints: &[DVec3]) {
        let _ = waypoints;
    }
}

impl FocusedSurroundings for LocalObstacles<'_> {
    fn answers(&self) -> &(dyn Surroundings + Sync) {
        self
    }

    fn focus_on(&mut self, waypoints: &[DVec3]) {
        LocalObstacles::focus_on(self, waypoints);
    }
}
