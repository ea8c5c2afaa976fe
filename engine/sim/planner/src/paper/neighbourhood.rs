//! What a change of one waypoint costs: the terms of the frames around it alone.

use crate::gradient::total_cost;
use crate::obstacles::Surroundings;
use crate::problem::Problem;
use crate::terms::{TermContext, WeightedTerm};
use crate::walk::Walk;
use cosfly_frames::{DVec3, TargetTrack};

/// Frames on each side: twice the reach of the built-in terms, so that every frame which reads the middle one reads
/// nothing beyond the edge.
const REACH: usize = 4;

/// The frames around one waypoint, cut out of a flight.
pub struct Neighbourhood<'a> {
    first: usize,
    middle: usize,
    track: TargetTrack,
    walk: Walk,
    waypoints: Vec<DVec3>,
    terms: &'a [WeightedTerm],
    problem: &'a Problem<'a>,
    surroundings: &'a dyn Surroundings,
}

/// Surroundings whose first frame is another one.
struct From<'a> {
    first: usize,
    surroundings: &'a dyn Surroundings,
}

impl Surroundings for From<'_> {
    fn visibility(&self, frame: usize, position: DVec3) -> f64 {
        self.surroundings.visibility(self.first + frame, position)
    }
    fn nearest(&self, frame: usize, position: DVec3, within_m: f64) -> Option<(f64, DVec3)> {
        self.surroundings.nearest(self.first + frame, position, within_m)
    }
    fn ground_z_m(&self, x_m: f64, y_m: f64) -> f64 {
        self.surroundings.ground_z_m(x_m, y_m)
    }
}

impl<'a> Neighbourhood<'a> {
    /// Cuts out the frames around `frame`.
    pub fn around(
        problem: &'a Problem<'a>,
        surroundings: &'a dyn Surroundings,
        frame: usize,
        waypoints: &[DVec3],
    ) -> Self {
        let first = frame.saturating_sub(REACH);
        let frames = first..(frame + REACH + 1).min(waypoints.len());
        let (track, walk) = (problem.track, problem.walk);
        Self {
            first,
            middle: frame - first,
            track: TargetTrack { states: track.states[frames.clone()].to_vec(), ..*track },
            walk: Walk {
                direction: walk.direction[frames.clone()].to_vec(),
                directness: walk.directness[frames.clone()].to_vec(),
            },
            waypoints: waypoints[frames].to_vec(),
            terms: &problem.terms[..problem.built_in.min(problem.terms.len())],
            problem,
            surroundings,
        }
    }

    /// Cost of the built-in terms here with the middle waypoint at `position`; only differences between positions mean
    /// anything.
    pub fn cost_with(&mut self, position: DVec3) -> f64 {
        self.waypoints[self.middle] = position;
        let surroundings = From { first: self.first, surroundings: self.surroundings };
        let context =
            TermContext { track: &self.track, view: self.problem.view, walk: &self.walk, surroundings: &surroundings };
        total_cost(self.terms, &self.waypoints, &context)
    }
}

#[cfg(test)]
mod tests {
    use super::super::differences::context;
    use super::super::pipeline::tests::with_street;
    use super::*;

    #[test]
    fn the_change_is_that_of_the_whole_flight() {
        with_street(|problem, obstacles, _, path| {
            let whole = |path: &[DVec3]| total_cost(problem.terms, path, &context(problem, obstacles));
            for frame in [0, 1, 2, 30, path.len() - 2, path.len() - 1] {
                let mut near = Neighbourhood::around(problem, obstacles, frame, path);
                let mut moved = path.to_vec();
                moved[frame] += DVec3::new(1.5, -2.0, 2.5);
                let change = near.cost_with(moved[frame]) - near.cost_with(path[frame]);
                let expected = whole(&moved) - whole(path);
                assert!((change - expected).abs() < 1e-6 * (1.0 + expected.abs()), "{frame} {change} {expected}");
            }
        });
    }
}
