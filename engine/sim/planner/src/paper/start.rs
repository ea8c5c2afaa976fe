//! The start (paper, algorithm 2): the best viewpoint behind the walker every few frames, and what lies between.

use super::counts::PaperCounts;
use super::focus::FocusedSurroundings;
use super::following::follow;
use super::hidden_runs::{hidden_runs, ramp, safe_sight};
use crate::config::muco::MucoConfig;
use crate::config::paper::PaperConfig;
use crate::problem::Problem;
use crate::terms::place::PlaceCosts;
use crate::terms::viewpoint;
use core::ops::Range;
use cosfly_frames::{DVec2, DVec3, real};
use cosfly_surroundings::Surroundings;

/// Azimuths over the sector, from one edge to the other.
const AZIMUTHS: usize = 9;
/// Heights over the band.
const HEIGHTS: usize = 5;
/// Distances over the ring.
const DISTANCES: usize = 6;
/// Step of the sideways offsets that bridge hidden runs, metres.
const SIDE_STEP_M: f64 = 2.0;

/// The first path: one waypoint per frame.
pub fn initial_path(
    problem: &Problem<'_>,
    surroundings: &mut dyn FocusedSurroundings,
    config: &MucoConfig,
    paper: &PaperConfig,
    counts: &mut PaperCounts,
) -> Vec<DVec3> {
    let search = ViewpointSearch::new(problem, config, paper);
    let frames = problem.track.len();
    let mut keyframes: Vec<usize> = (0..frames).step_by(paper.keyframe_frames.max(1) as usize).collect();
    if let Some(last) = frames.checked_sub(1).filter(|last| keyframes.last() != Some(last)) {
        keyframes.push(last);
    }
    let (mut facing, mut before) = (DVec2::ZERO, None);
    let mut chosen = Vec::with_capacity(keyframes.len());
    for &frame in &keyframes {
        facing = search.facing(frame, facing);
        let (viewpoint, evaluated) = search.best(surroundings.answers(), frame, facing, before);
        before = Some(viewpoint - problem.track.states[frame].feet_in_world);
        counts.viewpoints_evaluated += evaluated;
        chosen.push(viewpoint);
    }
    counts.keyframes = keyframes.len();
    let mut waypoints = interpolated(frames, &keyframes, &chosen);
    let longest_m = config.limits.speed_mps * problem.track.dt_s;
    counts.followed = follow(problem, search.ring_m, longest_m, &mut waypoints);
    surroundings.focus_on(&waypoints);
    counts.bridged_runs = bridge(problem, surroundings.answers(), paper, config.limits.clearance_m, &mut waypoints);
    waypoints
}

/// A place relative to the target, with the costs that depend on nothing else.
struct Candidate {
    /// Turn away from straight behind, radians.
    turn_rad: f64,
    across_m: f64,
    up_m: f64,
    cost: f64,
}

/// The candidates of the rear hemisphere and how they are judged.
struct ViewpointSearch<'a> {
    problem: &'a Problem<'a>,
    costs: PlaceCosts<'a>,
    search_visibility: f64,
    motion: f64,
    clearance_m: f64,
    ring_m: (f64, f64),
    candidates: Vec<Candidate>,
}

fn spread(index: usize, count: usize, low: f64, high: f64) -> f64 {
    low + (high - low) * index as f64 / (count - 1) as f64
}

impl<'a> ViewpointSearch<'a> {
    fn new(problem: &'a Problem<'a>, config: &MucoConfig, paper: &PaperConfig) -> Self {
        let view = problem.view;
        let costs = PlaceCosts { weights: config.resolved_weights(), view };
        let standard_m = view.distance_m * real::cos(view.pitch_deg.to_radians());
        let ring_m = (paper.min_distance_share * standard_m, paper.max_distance_share * standard_m);
        let sector = paper.rear_sector_deg.to_radians();
        let mut candidates = Vec::new();
        for azimuth in 0..AZIMUTHS {
            for height in 0..HEIGHTS {
                for distance in 0..DISTANCES {
                    let turn_rad = spread(azimuth, AZIMUTHS, -sector, sector);
                    let up_m = spread(height, HEIGHTS, view.min_altitude_m, view.max_altitude_m);
                    let across_m = spread(distance, DISTANCES, ring_m.0, ring_m.1);
                    let cost = costs.sight(DVec3::new(across_m, 0.0, up_m));
                    candidates.push(Candidate { turn_rad, across_m, up_m, cost });
                }
            }
        }
        let (search_visibility, motion, clearance_m) =
            (paper.search_visibility, paper.keyframe_motion, config.limits.clearance_m);
        Self { problem, costs, search_visibility, motion, clearance_m, ring_m, candidates }
    }

    /// The walking direction; while the target stands, the one before, and at the start its heading.
    fn facing(&self, frame: usize, before: DVec2) -> DVec2 {
        let walking = self.problem.walk.direction[frame];
        if walking != DVec2::ZERO {
            return walking;
        }
        let (sin, cos) = real::sin_cos(self.problem.track.states[frame].heading_rad);
        if before == DVec2::ZERO { DVec2::new(cos, sin) } else { before }
    }

    /// The cheapest candidate by the costs of its frame alone, those that are unsafe only if all are; and how many had
    /// to be looked at: candidates come by their costs without obstacles, so the search ends when no better can come.
    /// `before` is the offset from the target that was chosen for the keyframe before.
    fn best(
        &self,
        surroundings: &dyn Surroundings,
        frame: usize,
        facing: DVec2,
        before: Option<DVec3>,
    ) -> (DVec3, u64) {
        let feet = self.problem.track.states[frame].feet_in_world;
        let placed = |candidate| {
            let (cost, place) = self.placed(surroundings, frame, facing, candidate);
            let moved = before.map_or(0.0, |before| (place - feet).distance_squared(before));
            (cost + self.motion * moved, place)
        };
        let mut places: Vec<(f64, DVec3)> = self.candidates.iter().map(placed).collect();
        places.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut best: Option<(bool, f64, DVec3)> = None;
        let mut evaluated = 0;
        for (open_cost, place) in places {
            if best.is_some_and(|(unsafe_, cost, _)| !unsafe_ && cost <= open_cost) {
                break;
            }
            evaluated += 1;
            let nearest = surroundings.nearest(frame, place, self.problem.view.safety_influence_m);
            let unsafe_ = nearest.is_some_and(|(distance, _)| distance < self.clearance_m);
            let hidden = 1.0 - surroundings.visibility(frame, place);
            let close = nearest.map_or(0.0, |(distance_m, _)| self.costs.safety(distance_m));
            let cost = open_cost + close + self.search_visibility * hidden * hidden;
            if best.is_none_or(|(u, c, _)| (unsafe_, cost) < (u, c)) {
                best = Some((unsafe_, cost, place));
            }
        }
        (best.map_or(feet, |(_, _, place)| place), evaluated)
    }

    /// Position of a candidate at a frame, and its cost without obstacles.
    fn placed(
        &self,
        surroundings: &dyn Surroundings,
        frame: usize,
        facing: DVec2,
        candidate: &Candidate,
    ) -> (f64, DVec3) {
        let feet = self.problem.track.states[frame].feet_in_world;
        let (sin, cos) = real::sin_cos(candidate.turn_rad);
        let behind = -facing;
        let toward = DVec2::new(cos * behind.x - sin * behind.y, sin * behind.x + cos * behind.y);
        let place = feet + (candidate.across_m * toward).extend(candidate.up_m);
        let over_ground = place.z - surroundings.ground_z_m(place.x, place.y);
        let lowest = candidate.up_m.min(over_ground);
        let front = viewpoint::front_cost(toward.dot(facing)) * self.problem.walk.directness[frame];
        let altitude = self.costs.altitude(candidate.up_m, lowest);
        (candidate.cost + self.costs.weights.viewpoint * front + altitude, place)
    }
}

/// Straight lines in the world between the keyframes.
fn interpolated(frames: usize, keyframes: &[usize], chosen: &[DVec3]) -> Vec<DVec3> {
    let mut waypoints = vec![DVec3::ZERO; frames];
    for (pair, ends) in keyframes.windows(2).zip(chosen.windows(2)) {
        let stretch = &mut waypoints[pair[0]..pair[1]];
        let frames = stretch.len() as f64;
        stretch.iter_mut().enumerate().for_each(|(k, waypoint)| *waypoint = ends[0].lerp(ends[1], k as f64 / frames));
    }
    if let (Some(last), Some(&end)) = (waypoints.last_mut(), chosen.last()) {
        *last = end;
    }
    waypoints
}

/// Leads long hidden runs aside, as far as the target is seen best, with ramps at both ends; returns how many.
pub fn bridge(
    problem: &Problem<'_>,
    surroundings: &dyn Surroundings,
    paper: &PaperConfig,
    clearance_m: f64,
    waypoints: &mut [DVec3],
) -> usize {
    let mut bridged = 0;
    for run in hidden_runs(surroundings, waypoints, paper.hidden_run_frames as usize) {
        if let Some(offset_m) = best_side_offset_m(problem, surroundings, paper, clearance_m, &run, waypoints) {
            for (frame, share) in ramp(&run, paper.ramp_frames as usize, waypoints.len()) {
                waypoints[frame] += share * offset_m * sideways(problem, frame);
            }
            bridged += 1;
        }
    }
    bridged
}

/// To the walker's right, level.
fn sideways(problem: &Problem<'_>, frame: usize) -> DVec3 {
    let ahead = problem.walk.direction[frame];
    DVec3::new(-ahead.y, ahead.x, 0.0)
}

fn best_side_offset_m(
    problem: &Problem<'_>,
    surroundings: &dyn Surroundings,
    paper: &PaperConfig,
    clearance_m: f64,
    run: &Range<usize>,
    waypoints: &[DVec3],
) -> Option<f64> {
    let seen_at = |offset_m: f64| {
        let moved = |frame: usize| waypoints[frame] + offset_m * sideways(problem, frame);
        safe_sight(surroundings, clearance_m, run.clone(), moved)
    };
    let mut best = (seen_at(0.0), None);
    for step in 1..=(paper.side_offset_m / SIDE_STEP_M) as u32 {
        for offset_m in [f64::from(step) * SIDE_STEP_M, -f64::from(step) * SIDE_STEP_M] {
            let seen = seen_at(offset_m);
            if seen > best.0 {
                best = (seen, Some(offset_m));
            }
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{with_street, with_wall};
    use super::*;

    #[test]
    fn in_the_open_the_start_is_behind_at_the_standard_distance() {
        with_street(|problem, _, config, _| {
            let search = ViewpointSearch::new(problem, config, &PaperConfig::default());
            let (place, evaluated) =
                search.best(&super::super::fixtures::Nothing, 30, search.facing(30, DVec2::ZERO), None);
            let sight = place - problem.track.states[30].feet_in_world;
            assert!(sight.truncate().normalize().dot(problem.walk.direction[30]) < -0.999, "{sight}");
            assert!((sight.length() - 28.0).abs() < 1.5 && (sight.z - 20.0).abs() < 1e-9, "{sight}");
            assert!(evaluated <= 2, "the first that is open and cheapest ends the search: {evaluated}");
        });
    }

    #[test]
    fn a_cheaper_candidate_is_never_left_out() {
        with_street(|problem, obstacles, config, _| {
            let search = ViewpointSearch::new(problem, config, &PaperConfig::default());
            for frame in (0..problem.track.len()).step_by(7) {
                let facing = search.facing(frame, DVec2::X);
                let (place, _) = search.best(obstacles, frame, facing, None);
                let judged = |place: DVec3, open: f64| {
                    let nearest = obstacles.nearest(frame, place, 8.0).map_or(8.0, |found| found.0);
                    let hidden = 1.0 - obstacles.visibility(frame, place);
                    (nearest < 1.5, open + (8.0 - nearest).powi(2) + 60.0 * hidden * hidden)
                };
                let all: Vec<(bool, f64, DVec3)> = search
                    .candidates
                    .iter()
                    .map(|candidate| {
                        let (open, place) = search.placed(obstacles, frame, facing, candidate);
                        let (unsafe_, cost) = judged(place, open);
                        (unsafe_, cost, place)
                    })
                    .collect();
                let found = all.iter().find(|c| c.2 == place).unwrap();
                assert!(all.iter().all(|c| (c.0, c.1 + 1e-9) >= (found.0, found.1)), "frame {frame}");
            }
        });
    }

    #[test]
    fn of_equal_viewpoints_the_one_nearer_to_that_before_is_taken() {
        with_street(|problem, _, config, _| {
            let search = ViewpointSearch::new(problem, config, &PaperConfig::default());
            let nothing = super::super::fixtures::Nothing;
            let facing = search.facing(30, DVec2::ZERO);
            let feet = problem.track.states[30].feet_in_world;
            let (free, _) = search.best(&nothing, 30, facing, None);
            let aside = (free - feet) + 20.0 * facing.perp().extend(0.0);
            let (drawn, _) = search.best(&nothing, 30, facing, Some(aside));
            assert!((drawn - feet).distance(aside) < (free - feet).distance(aside));
        });
    }

    #[test]
    fn keyframes_are_joined_by_straight_lines() {
        let ends = [DVec3::ZERO, DVec3::X * 4.0, DVec3::new(4.0, 2.0, 0.0)];
        let path = interpolated(7, &[0, 4, 6], &ends);
        assert_eq!(path[3], DVec3::X * 3.0);
        assert_eq!(path[5], DVec3::new(4.0, 1.0, 0.0));
        assert_eq!(path[6], ends[2]);
        assert!(interpolated(0, &[], &[]).is_empty());
    }

    #[test]
    fn a_hidden_run_is_led_aside_and_seen_better() {
        with_wall(|problem, obstacles, path| {
            let paper = PaperConfig { side_offset_m: 40.0, ..PaperConfig::default() };
            let seen = |path: &[DVec3]| safe_sight(obstacles, 1.5, 0..path.len(), |frame| path[frame]);
            let before = seen(path);
            assert_eq!(bridge(problem, obstacles, &paper, 1.5, path), 1);
            assert!(seen(path) > before + 5.0, "{before} {}", seen(path));
        });
    }
}
