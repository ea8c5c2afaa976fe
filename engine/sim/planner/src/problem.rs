//! The problem that every part of a solver reads: target, wishes, cost.

use crate::config::view::ViewConfig;
use crate::gradient::total_cost;
use crate::terms::term::{TermContext, WeightedTerm};
use crate::walk::Walk;
use cosfly_frames::{DVec3, TargetTrack};
use cosfly_surroundings::local::LocalObstacles;

/// Target, wishes and cost of one flight.
pub struct Problem<'a> {
    /// The target.
    pub track: &'a TargetTrack,
    /// Wanted position of the drone.
    pub view: &'a ViewConfig,
    /// Walking directions.
    pub walk: &'a Walk,
    /// The cost.
    pub terms: &'a [WeightedTerm],
    /// Number of terms, from the first, that are the paper's.
    pub built_in: usize,
    /// Number that reasons give the track's first frame; below 0 where frames were put before it.
    pub first_frame: i64,
}

/// The number of a frame in reasons, when that of the first one is `first`.
pub(crate) fn frame_number(first: i64, frame: usize) -> i64 {
    first.saturating_add(i64::try_from(frame).unwrap_or(i64::MAX)).max(0)
}

impl<'a> Problem<'a> {
    /// The terms' context with these obstacles.
    pub fn context<'b>(&self, obstacles: &'b LocalObstacles<'b>) -> TermContext<'b>
    where
        'a: 'b,
    {
        TermContext { track: self.track, view: self.view, walk: self.walk, surroundings: obstacles }
    }

    /// Total cost against the planning boxes.
    pub fn cost(&self, obstacles: &LocalObstacles<'_>, waypoints: &[DVec3]) -> f64 {
        total_cost(self.terms, waypoints, &self.context(obstacles))
    }
}
