//! `patrol`: a timed loop over waypoints; the drone dwells at each and turns to where it goes next.

use core::f64::consts::{PI, TAU};
use cosfly_plugin::{Metadata, Objective, Plan, Point, Random, Site, distance, libm, params, town};

params! {
    /// The round.
    pub struct Params {
        /// Waypoints, x y z in metres, visited in order and back to the first; a loop is drawn when left out (an empty list).
        waypoints: Vec<[f64; 3]> = vec![];
        /// How many waypoints a drawn loop has.
        corners: u32 = 4, [3, 12];
        /// Distance of drawn waypoints from the middle of the loop, metres.
        radius_m: f64 = 35.0, [5.0, 500.0];
        /// Height of drawn waypoints above the ground, metres.
        height_m: f64 = 25.0, [5.0, 150.0];
        /// How often the loop is flown.
        rounds: u32 = 1, [1, 20];
        /// How long the drone stays at each waypoint, seconds; longer where it has far to turn.
        dwell_s: f64 = 4.0, [1.0, 120.0];
        /// Largest speed between waypoints, m/s.
        speed_mps: f64 = 6.0, [0.5, 15.0];
        /// How far ahead of the drone the camera looks, metres.
        lead_m: f64 = 15.0, [3.0, 60.0];
    }
}

/// Largest acceleration between waypoints, m/s^2.
const ACCELERATION: f64 = 1.5;
/// How much it matters to be on the way between waypoints.
const PULL: f64 = 0.05;
/// Draws of a loop before giving up.
const MAX_DRAWS: usize = 500;

/// See the crate.
pub struct Patrol(Params);

impl Objective for Patrol {
    type Params = Params;

    fn describe() -> Metadata {
        Metadata { name: "patrol", version: "0.1.0", summary: "A timed loop over waypoints with a stay at each." }
    }

    fn new(params: Params) -> Result<Self, String> {
        let given = &params.waypoints;
        if given.len() == 1 || (0..given.len()).any(|k| flat_distance(given[k], given[(k + 1) % given.len()]) < 2.0) {
            return Err("waypoints that follow each other must be 2 m apart, seen from above".to_owned());
        }
        Ok(Self(params))
    }

    fn produce(&self, site: &Site) -> Result<Plan, String> {
        let corners = if self.0.waypoints.is_empty() { self.drawn(site)? } else { self.0.waypoints.clone() };
        let stops: Vec<Point> =
            (0..self.0.rounds as usize * corners.len()).map(|k| corners[k % corners.len()]).collect();
        let stops: Vec<Point> = stops.into_iter().chain([corners[0]]).collect();
        let mut round = Round { plan: Plan::default(), site, lead: self.0.lead_m };
        let heading = |k: usize| libm::atan2(stops[k + 1][1] - stops[k][1], stops[k + 1][0] - stops[k][0]);
        for k in 0..stops.len() {
            let arriving = if k == 0 { heading(0) } else { heading(k - 1) };
            let leaving = if k + 1 < stops.len() { heading(k) } else { arriving };
            round.stay(stops[k], arriving, leaving, self.0.dwell_s);
            if let Some(next) = stops.get(k + 1) {
                round.fly(stops[k], *next, leaving, self.0.speed_mps.min(0.8 * site.max_speed));
            }
        }
        if round.plan.len() > site.max_steps {
            let (takes, most) = (round.plan.len() as f64 * site.dt, site.max_steps as f64 * site.dt);
            return Err(format!("the round takes {takes} s; at most {most} s are flown"));
        }
        round.plan.note("stops", stops.len());
        Ok(round.plan)
    }
}

struct Round<'a> {
    plan: Plan,
    site: &'a Site,
    lead: f64,
}

impl Round<'_> {
    fn push(&mut self, place: Point, heading: f64, pull: f64) {
        let watched = [place[0] + self.lead * libm::cos(heading), place[1] + self.lead * libm::sin(heading)];
        let ground = town::ground(&[watched])[0];
        let below = place[2] - 0.7 * self.lead;
        let z = if ground.is_finite() { below.max(ground) } else { below };
        self.plan.push([watched[0], watched[1], z], place, pull);
    }

    /// Turns on the spot from heading to heading; the stop counts as met in the middle of it.
    fn stay(&mut self, place: Point, from: f64, to: f64, dwell_s: f64) {
        let turn = wrapped(to - from);
        let fastest = 0.35 * self.site.max_speed / self.lead;
        let steps = (dwell_s.max(turn.abs() / fastest) / self.site.dt).ceil() as usize;
        for step in 0..steps {
            let share = eased(step as f64 / steps as f64);
            self.push(place, from + share * turn, if step == steps / 2 { 1.0 } else { 0.5 });
        }
    }

    /// Straight from stop to stop, beginning and ending at rest.
    fn fly(&mut self, from: Point, to: Point, heading: f64, speed: f64) {
        let way = distance(from, to);
        let time = (2.0 * way / speed).max((TAU * way / ACCELERATION).sqrt());
        let steps = (time / self.site.dt).ceil() as usize;
        for step in 0..steps {
            let share = eased(step as f64 / steps as f64);
            let place: Vec<f64> = (0..3).map(|axis| from[axis] + share * (to[axis] - from[axis])).collect();
            self.push([place[0], place[1], place[2]], heading, PULL);
        }
    }
}

impl Patrol {
    fn drawn(&self, site: &Site) -> Result<Vec<Point>, String> {
        let mut random = Random::new(site.seed);
        let [low_x, low_y, high_x, high_y] = site.bounds;
        for _ in 0..MAX_DRAWS {
            let (x, y) = (random.uniform(low_x, high_x), random.uniform(low_y, high_y));
            let start = random.uniform(0.0, TAU);
            let corners: Vec<[f64; 2]> = (0..self.0.corners)
                .map(|k| {
                    let angle = start + TAU * (f64::from(k) + random.uniform(-0.2, 0.2)) / f64::from(self.0.corners);
                    let radius = self.0.radius_m * random.uniform(0.8, 1.1);
                    [x + radius * libm::cos(angle), y + radius * libm::sin(angle)]
                })
                .collect();
            let up = |(corner, ground): (&[f64; 2], f64)| {
                [corner[0], corner[1], self.0.height_m + if ground.is_finite() { ground } else { 0.0 }]
            };
            let stops: Vec<Point> = corners.iter().zip(town::ground(&corners)).map(up).collect();
            let keep = site.clearance + 1.0;
            if town::distances(&stops, keep).iter().all(|distance| *distance >= keep) {
                return Ok(stops);
            }
        }
        Err(format!(
            "no loop of {} free waypoints in {MAX_DRAWS} draws: another `height_m` or a smaller `radius_m` helps",
            self.0.corners
        ))
    }
}

/// From 0 to 1 with rest at both ends.
fn eased(time: f64) -> f64 {
    time - libm::sin(TAU * time) / TAU
}

fn wrapped(angle: f64) -> f64 {
    let turns = libm::floor((angle + PI) / TAU);
    angle - TAU * turns
}

fn flat_distance(a: Point, b: Point) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}

cosfly_plugin::objective!(Patrol);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stop_is_marked_once_and_nothing_moves_too_fast() {
        let site = Site { dt: 0.5, max_steps: 4000, max_speed: 12.0, clearance: 1.5, ..Site::default() };
        let waypoints = vec![[0.0, 0.0, 20.0], [40.0, 0.0, 25.0], [40.0, 30.0, 20.0]];
        let patrol = Patrol::new(Params { waypoints: waypoints.clone(), ..Params::default() }).unwrap();
        let plan = patrol.produce(&site).unwrap();
        let met: Vec<Point> = plan.marks().into_iter().map(|step| plan.places()[step]).collect();
        assert_eq!(met, [waypoints[0], waypoints[1], waypoints[2], waypoints[0]]);
        for points in [plan.places(), plan.watched()] {
            assert!(points.windows(2).all(|pair| distance(pair[0], pair[1]) < 12.0 * site.dt));
        }
    }
}
