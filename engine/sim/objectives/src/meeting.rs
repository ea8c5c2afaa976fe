//! A cost term of objectives: the drone is drawn to a place at each frame, more or less strongly.

use cosfly_frames::DVec3;
use cosfly_planner::equations::NormalEquations;
use cosfly_planner::{CostTerm, TermContext};

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
        let places = self.places.iter().take(frames).enumerate();
        places.map(move |(i, (place, share))| (before + i, *place, *share))
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

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::{TargetState, TargetTrack};
    use cosfly_geometry::BoxBvh;
    use cosfly_planner::Walk;
    use cosfly_planner::config::view::ViewConfig;
    use cosfly_surroundings::exact::ExactObstacles;
    use cosfly_surroundings::ground::GroundGrid;

    #[test]
    fn places_are_those_of_the_last_frames_and_the_slope_is_that_of_the_cost() {
        let state = TargetState { feet_in_world: DVec3::ZERO, heading_rad: 0.0, speed_mps: 0.0 };
        let track = TargetTrack { dt_s: 0.5, height_m: 1.7, radius_m: 0.3, states: vec![state; 4] };
        let (exact, grid) = (BoxBvh::build(vec![]), GroundGrid::sample(&track, &|_, _| 0.0, 10.0));
        let surroundings = ExactObstacles::still(&track, &exact, &grid);
        let (view, walk) = (ViewConfig::default(), Walk::of(&track));
        let context = TermContext { track: &track, view: &view, walk: &walk, surroundings: &surroundings };
        let term = Meeting::new("place", vec![(DVec3::X, 1.0), (DVec3::Y, 0.5)]);
        let waypoints = [DVec3::Z, DVec3::Z, DVec3::new(3.0, 1.0, 0.0), DVec3::new(0.0, 3.0, 4.0)];
        let cost = |waypoints: &[DVec3]| {
            let mut per_frame = vec![f64::NAN; waypoints.len()];
            term.cost(waypoints, &context, &mut per_frame);
            per_frame
        };
        assert_eq!(cost(&waypoints), [0.0, 0.0, 5.0, 10.0]);
        let mut gradient = [DVec3::ZERO; 4];
        assert!(term.add_gradient(&waypoints, &context, 2.0, &mut gradient));
        for frame in 0..4 {
            for axis in 0..3 {
                let (mut low, mut high) = (waypoints, waypoints);
                low[frame][axis] -= 1e-4;
                high[frame][axis] += 1e-4;
                let slope = (cost(&high).iter().sum::<f64>() - cost(&low).iter().sum::<f64>()) / 1e-4;
                assert!((gradient[frame][axis] - slope).abs() < 1e-6, "{frame} {axis}");
            }
        }
        assert_eq!(cost(&waypoints[..1]), [1.0 + 1.0], "more places than frames do no harm");
    }
}
