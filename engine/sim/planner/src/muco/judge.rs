//! The judge: measures flights against the unsimplified map, makes them hold their limits, and learns where the planning
//! boxes were too optimistic.

use super::corridor::CorridorInput;
use super::smoother::{Objective, smooth};
use super::start_sector;
use crate::certificate::{Kinematics, Measured, certify, publishable};
use crate::config::muco::MucoConfig;
use crate::problem::Problem;
use cosfly_frames::DVec3;
use cosfly_surroundings::Surroundings;
use cosfly_surroundings::exact::ExactMap;
use cosfly_surroundings::local::LocalObstacles;
use cosfly_surroundings::solid::HalfSpace;

/// Distance kept beyond the limit while smoothing, metres.
pub const KEEP_OUT_EXTRA_M: f64 = 0.1;
/// Slack of the lowest altitude, metres.
const FLOOR_SLACK_M: f64 = 0.01;
/// Times that planes from the unsimplified map are added when it is nearer than the planning boxes say.
const MAX_LESSONS: usize = 4;

/// Measures flights of one problem, and learns from them.
pub struct Judge<'a> {
    problem: &'a Problem<'a>,
    exact: ExactMap<'a>,
    ground: &'a dyn Fn(f64, f64) -> f64,
    config: &'a MucoConfig,
    /// The first waypoints, where they are given.
    pub head: &'a [DVec3],
    learned: Vec<Vec<HalfSpace>>,
    /// Steps and iterations so far.
    pub iterations: u32,
}

impl<'a> Judge<'a> {
    /// For flights of a problem that begin with the waypoints `head`.
    pub fn new(
        problem: &'a Problem<'a>,
        exact: ExactMap<'a>,
        ground: &'a dyn Fn(f64, f64) -> f64,
        config: &'a MucoConfig,
        head: &'a [DVec3],
    ) -> Self {
        let learned = vec![Vec::new(); problem.track.len()];
        Self { problem, exact, ground, config, head, learned, iterations: 0 }
    }

    /// The flight near `wished` (from the nearby `start`) that holds the limits, or nearly, and its measurements.
    pub fn make_flyable(
        &mut self,
        obstacles: &LocalObstacles<'_>,
        wished: &[DVec3],
        start: &[DVec3],
        objective: Objective,
    ) -> (Vec<DVec3>, Measured) {
        let limits = self.config.stated_limits();
        let is_chosen = self.head.is_empty() && !start.is_empty();
        let sides = if is_chosen { start_sector::sides(self.problem, &self.config.view, start[0]) } else { vec![] };
        let mut from = start.to_vec();
        let mut lessons = 0;
        loop {
            let input = CorridorInput {
                track: self.problem.track,
                obstacles,
                keep_out_m: limits.clearance_m + KEEP_OUT_EXTRA_M,
                min_altitude_m: self.config.view.min_altitude_m,
                wished,
                learned: &self.learned,
                head: self.head,
                start: &sides,
                min_radius_m: self.config.view.min_radius_m,
                turn_rad: [limits.yaw_rate_deg_s, limits.pitch_rate_deg_s]
                    .map(|rate| rate.to_radians() * self.problem.track.dt_s),
            };
            let smoothed = smooth(&input, &from, &limits, objective);
            self.iterations += smoothed.iterations;
            let waypoints = smoothed.waypoints;
            let measured = self.measure(&waypoints);
            let close = measured.certificate.min_clearance_m < limits.clearance_m;
            if !close || lessons == MAX_LESSONS || !self.learn(&waypoints) {
                return (waypoints, measured);
            }
            lessons += 1;
            from = waypoints;
        }
    }

    /// Everything about a flight, in f64 against the unsimplified map.
    pub fn measure(&self, waypoints: &[DVec3]) -> Measured {
        certify(self.problem.track, waypoints, self.head.len(), self.exact, self.ground, self.config)
    }

    /// Whether a flight has no need of smoothing: it is smooth enough, high enough and clear of the
    /// planning boxes.
    pub fn needs_nothing(&self, obstacles: &LocalObstacles<'_>, waypoints: &[DVec3]) -> bool {
        let limits = self.config.stated_limits();
        let kinematics = Kinematics::of(self.problem.track, waypoints, self.head.len());
        let keep_m = limits.clearance_m;
        let clear = |(i, w): (usize, &[DVec3])| obstacles.segment_clearance_m(i, w[0], w[1], keep_m) >= keep_m;
        let above_floor = |(i, w): (usize, &DVec3)| w.z >= self.floor_m(obstacles, i, *w) - FLOOR_SLACK_M;
        let high = waypoints.iter().enumerate().all(above_floor);
        high && kinematics.violations(&limits).is_empty() && waypoints.windows(2).enumerate().all(clear)
    }

    /// Raises waypoints to the lowest altitude, or to that of the waypoint of `safe` if that is lower.
    pub fn raise(&self, obstacles: &LocalObstacles<'_>, waypoints: &mut [DVec3], safe: &[DVec3]) {
        for (i, waypoint) in waypoints.iter_mut().enumerate().skip(self.head.len()) {
            let lowest = safe[i].z.min(self.floor_m(obstacles, i, *waypoint));
            waypoint.z = waypoint.z.max(lowest);
        }
    }

    /// Height of the lowest altitude under a waypoint.
    fn floor_m(&self, obstacles: &LocalObstacles<'_>, frame: usize, waypoint: DVec3) -> f64 {
        let feet_z = self.problem.track.states[frame].feet_in_world.z;
        obstacles.ground_z_m(waypoint.x, waypoint.y).max(feet_z) + self.config.view.min_altitude_m
    }

    /// Adds planes for segments that the exact map finds too close; false when there is nothing to add.
    fn learn(&mut self, waypoints: &[DVec3]) -> bool {
        let keep = self.config.limits.clearance_m;
        let mut found = false;
        for i in 0..waypoints.len() {
            let last = (i + 1).min(waypoints.len() - 1);
            let (from, to) = (waypoints[i], waypoints[last]);
            if self.exact.segment_clearance(i, from, to, keep) >= keep {
                continue;
            }
            for share in [0.0, 0.25, 0.5, 0.75, 1.0] {
                let point = from.lerp(to, share);
                if let Some((distance, normal)) = self.exact.nearest(i, point, keep + 0.5) {
                    let on_box = point - distance * normal;
                    let plane = HalfSpace { normal, offset_m: normal.dot(on_box) + keep + KEEP_OUT_EXTRA_M };
                    self.learned[i].push(plane);
                    self.learned[last].push(plane);
                    found = true;
                }
            }
        }
        found
    }

    /// Whether a flight may be published, see [`publishable`].
    pub fn publishable(&self, measured: &Measured) -> bool {
        publishable(self.config, &measured.certificate)
    }
}
