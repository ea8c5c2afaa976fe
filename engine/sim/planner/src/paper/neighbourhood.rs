//! Cost of a change of one waypoint: the terms of the frames around it alone.

use super::window::Window;
use crate::gradient::total_cost;
use crate::problem::Problem;
use crate::terms::term::WeightedTerm;
use cosfly_frames::DVec3;
use cosfly_surroundings::Surroundings;

/// Frames on each side: twice the reach of the built-in terms, so that every frame which reads the middle one reads
/// nothing beyond the edge.
const REACH: usize = 4;

/// The frames around one waypoint.
pub struct Neighbourhood<'a> {
    window: Window<'a>,
    terms: &'a [WeightedTerm],
}

impl<'a> Neighbourhood<'a> {
    /// Cuts out the frames around `frame`.
    pub fn around(
        problem: &'a Problem<'a>,
        surroundings: &'a dyn Surroundings,
        frame: usize,
        waypoints: &[DVec3],
    ) -> Self {
        let window = Window::cut(problem, surroundings, waypoints, frame..frame + 1, REACH);
        Self { window, terms: &problem.terms[..problem.built_in.min(problem.terms.len())] }
    }

    /// Cost of the built-in terms here with the middle waypoint at `position`; only differences between positions mean
    /// anything.
    pub fn cost_with(&mut self, position: DVec3) -> f64 {
        let middle = self.window.inner.start;
        self.window.waypoints[middle] = position;
        total_cost(self.terms, &self.window.waypoints, &self.window.context())
    }
}

#[cfg(test)]
mod tests {
    use super::super::differences::context;
    use super::super::fixtures::with_street;
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
