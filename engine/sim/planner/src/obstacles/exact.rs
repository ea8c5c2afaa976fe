//! Surroundings answered by the unsimplified map.

use super::{Surroundings, ground::GroundGrid};
use crate::visibility::visibility;
use cosfly_frames::{DVec3, TargetTrack};
use cosfly_geometry::SpatialQuery;

/// The exact map around a track.
pub struct ExactObstacles<'a> {
    /// The target that is looked at.
    pub track: &'a TargetTrack,
    /// All unsimplified boxes.
    pub query: &'a dyn SpatialQuery,
    /// Ground heights.
    pub ground: &'a GroundGrid,
}

impl Surroundings for ExactObstacles<'_> {
    fn visibility(&self, frame: usize, position: DVec3) -> f64 {
        visibility(self.query, position, &self.track.states[frame], self.track.height_m)
    }

    fn nearest(&self, _frame: usize, position: DVec3, within_m: f64) -> Option<(f64, DVec3)> {
        self.query.nearest(position, within_m).map(|near| (near.distance_m, near.away_in_world))
    }

    fn ground_z_m(&self, x_m: f64, y_m: f64) -> f64 {
        self.ground.z_m(x_m, y_m)
    }
}
