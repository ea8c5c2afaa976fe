//! A stretch cut out of a flight, in which terms cost what they cost in the whole of it.

use crate::problem::Problem;
use crate::terms::term::TermContext;
use crate::walk::Walk;
use core::ops::Range;
use cosfly_frames::{DVec3, TargetTrack};
use cosfly_surroundings::Surroundings;

/// Some frames of a flight with a margin on both sides, which ends where the flight does.
pub struct Window<'a> {
    /// The waypoints of the window.
    pub waypoints: Vec<DVec3>,
    /// The frames inside the margins, counted from the window's first.
    pub inner: Range<usize>,
    track: TargetTrack,
    walk: Walk,
    problem: &'a Problem<'a>,
    surroundings: ShiftedSurroundings<'a>,
}

/// Surroundings whose first frame is a later one of others.
struct ShiftedSurroundings<'a> {
    first: usize,
    surroundings: &'a dyn Surroundings,
}

impl Surroundings for ShiftedSurroundings<'_> {
    fn visibility(&self, frame: usize, position: DVec3) -> f64 {
        self.surroundings.visibility(self.first + frame, position)
    }
    fn nearest(&self, frame: usize, position: DVec3, within_m: f64) -> Option<(f64, DVec3)> {
        self.surroundings.nearest(self.first + frame, position, within_m)
    }
    fn shadows(&self, frame: usize, position: DVec3, each: &mut dyn FnMut(f64, DVec3)) {
        self.surroundings.shadows(self.first + frame, position, each);
    }
    fn ground_z_m(&self, x_m: f64, y_m: f64) -> f64 {
        self.surroundings.ground_z_m(x_m, y_m)
    }
}

impl<'a> Window<'a> {
    /// Cuts out `inner` and up to `margin` frames on each side.
    pub fn cut(
        problem: &'a Problem<'a>,
        surroundings: &'a dyn Surroundings,
        waypoints: &[DVec3],
        inner: Range<usize>,
        margin: usize,
    ) -> Self {
        let first = inner.start.saturating_sub(margin);
        let frames = first..inner.end.saturating_add(margin).min(waypoints.len());
        let (track, walk) = (problem.track, problem.walk);
        Self {
            waypoints: waypoints[frames.clone()].to_vec(),
            inner: inner.start - first..inner.end - first,
            track: TargetTrack { states: track.states[frames.clone()].to_vec(), ..*track },
            walk: Walk {
                direction: walk.direction[frames.clone()].to_vec(),
                directness: walk.directness[frames].to_vec(),
            },
            problem,
            surroundings: ShiftedSurroundings { first, surroundings },
        }
    }

    /// The terms' context in the window.
    pub fn context(&self) -> TermContext<'_> {
        TermContext { track: &self.track, view: self.problem.view, walk: &self.walk, surroundings: &self.surroundings }
    }
}
