//! A cost term of objectives: the drone is drawn to a place at each frame, more or less strongly.

use crate::equations::NormalEquations;
use crate::terms::{CostTerm, TermContext};
use cosfly_frames::DVec3;

/// `share |w - place|^2` at each frame, metres squared.
#[derive(Clone, Debug, PartialEq)]
pub struct Meeting {
    name: &'static str,
    /// Per frame: the place in the world frame, metres, and its share.
    places: Vec<(DVec3, f64)>,
}

impl Meeting {
    /// The term called `name`; one place and share per frame.
    pub fn new(name: &'static str, places: Vec<(DVec3, f64)>) -> Self {
        Self { name, places }
    }

    /// The places from `first` to before `end`.
    pub fn part(&self, first: usize, end: usize) -> Self {
        Self { name: self.name, places: self.places.get(first..end).unwrap_or_default().to_vec() }
    }

    /// The place at each frame of a flight of `frames`. A flight that begins with frames before the first (a given start
    /// state) has more frames than there are places: those are at the end.
    fn at(&self, frames: usize) -> impl Iterator<Item = (usize, DVec3, f64)> {
        let before = frames.saturating_sub(self.places.len());
        self.places.iter().enumerate().map(move |(i, (place, share))| (before + i, *place, *share))
    }
}

impl CostTerm for Meeting {
    fn name(&self) -> &str {
        self.name
    }

    fn support(&self) -> usize {
        0
    }

    fn cost(&self, waypoints: &[DVec3], _: &TermContext<'_>, per_frame: &mut [f64]) {
        per_frame.fill(0.0);
        for (frame, place, share) in self.at(waypoints.len()) {
            per_frame[frame] = share * waypoints[frame].distance_squared(place);
        }
    }

    fn add_gradient(&self, waypoints: &[DVec3], _: &TermContext<'_>, weight: f64, gradient: &mut [DVec3]) -> bool {
        for (frame, place, share) in self.at(waypoints.len()) {
            gradient[frame] += 2.0 * weight * share * (waypoints[frame] - place);
        }
        true
    }

    fn add_residuals(
        &self,
        waypoints: &[DVec3],
        _: &TermContext<'_>,
        weight: f64,
        equations: &mut NormalEquations,
    ) -> bool {
        for (frame, place, share) in self.at(waypoints.len()) {
            equations.add_anchor(frame, weight * share, waypoints[frame] - place);
        }
        true
    }
}
