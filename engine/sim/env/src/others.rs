//! [`Others`]: who moves around the target, at any time of an episode.
//!
//! Between frames a body goes evenly from place to place and turns the shorter way, as in films and for the planner. A body that comes
//! or goes is there for half a frame before its first state and after its last.

use cosfly_domain::{Around, Body, BodyPlan, OrientedBox};
use cosfly_figures::{BodyShape, outfit_of};
use cosfly_frames::{DVec2, DVec3, TargetState, real};
use cosfly_optics::target_state_at;
use cosfly_surroundings::moving::{Encounter, hides};
use cosfly_surroundings::visibility::body_points;

/// Length of a stretch of [`Others::stretches`], seconds.
const STRETCH_S: f64 = 4.0;
/// Slack of distances that leave a body out above those that count: more than errors of rounding and of clearances, metres.
const SLACK_M: f64 = 0.05;

/// Bodies that move around the target.
#[derive(Clone, Debug, Default)]
pub struct Others {
    bodies: Vec<EpisodeBody>,
    /// Numbers of those who are there in each stretch of [`STRETCH_S`]; the first begins before all time, after the last one nobody is there.
    stretches: Vec<Vec<Passing>>,
}

/// A body in a stretch of time: enough to leave it out where it is far away.
#[derive(Clone, Copy, Debug)]
struct Passing {
    /// Middle of a circle around its feet in the whole stretch.
    middle: DVec2,
    /// Radius of that circle and of one around the box of the body, seen from above, metres.
    radius_m: f64,
    /// Highest point on all its way, world frame, metres.
    top_m: f64,
    is_look_alike: bool,
    body: usize,
}

/// A person or vehicle beside the target.
#[derive(Clone, Debug)]
pub struct EpisodeBody {
    /// Number of the body in the traffic of its town.
    pub number: u32,
    /// Kind, size and looks.
    pub plan: BodyPlan,
    /// Whether it is of the target's kind and wears, in words, what the target wears.
    pub is_look_alike: bool,
    dt_s: f64,
    first_s: f64,
    states: Vec<TargetState>,
    /// Distance covered up to each state, metres.
    covered_m: Vec<f64>,
    /// Highest point on all its way, world frame, metres.
    top_m: f64,
}

/// A body at a moment.
#[derive(Clone, Copy, Debug)]
pub struct BodyAtTime<'a> {
    /// The body.
    pub body: &'a EpisodeBody,
    /// Place, heading, speed.
    pub state: TargetState,
    /// Distance covered since its first state, metres.
    pub covered_m: f64,
}

impl Others {
    /// The bodies around a target that is `followed`.
    pub fn new(around: &Around, followed: Option<&BodyPlan>) -> Self {
        let dt_s = around.traffic.dt_s;
        let is_sound = dt_s > 0.0 && dt_s.is_finite();
        let outfit = |plan: &BodyPlan| outfit_of(BodyShape::of(plan.kind, plan.size_m), &plan.looks);
        let own = followed.map(|plan| (plan.kind, outfit(plan)));
        let is_look_alike =
            |plan: &BodyPlan| own.as_ref().is_some_and(|(kind, worn)| *kind == plan.kind && outfit(plan).is_like(worn));
        let bodies = around.bodies().filter(|(_, body)| is_sound && !body.states.is_empty());
        let bodies = bodies.map(|(number, body)| EpisodeBody::of(number, body, dt_s, is_look_alike(&body.plan)));
        let bodies: Vec<_> = bodies.collect();
        let last_s = bodies.iter().map(|body| body.first_s + body.states.len() as f64 * dt_s).fold(0.0, f64::max);
        let passing = |stretch: usize| {
            (0..).zip(&bodies).filter_map(|(number, body)| body.passing(number, stretch as f64 * STRETCH_S)).collect()
        };
        let stretches = (0..=(last_s / STRETCH_S) as usize).map(passing).collect();
        Self { bodies, stretches }
    }

    /// Everybody who may be there at a time, in the order of their numbers.
    fn passing(&self, time_s: f64) -> &[Passing] {
        self.stretches.get((time_s / STRETCH_S) as usize).map_or(&[], Vec::as_slice)
    }

    /// Whether nobody else is about.
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// Everybody who comes near in the course of the episode.
    pub fn bodies(&self) -> &[EpisodeBody] {
        &self.bodies
    }

    /// Everybody who is there at a time, seconds from the beginning of the episode.
    pub fn at(&self, time_s: f64) -> impl Iterator<Item = BodyAtTime<'_>> {
        self.bodies.iter().filter_map(move |body| body.at(time_s))
    }

    /// Everybody who is there at a time and may be taken for the target.
    pub fn look_alikes(&self, time_s: f64) -> impl Iterator<Item = BodyAtTime<'_>> {
        let passing = self.passing(time_s).iter().filter(|passing| passing.is_look_alike);
        passing.filter_map(move |passing| self.bodies[passing.body].at(time_s))
    }

    /// Marks those of the target's body points that a body hides from a camera. A body around the target's own middle hides nothing
    /// of it, as for the planner.
    pub fn hide(&self, time_s: f64, camera: DVec3, target: &TargetState, height_m: f64, hidden: &mut [bool]) {
        if self.bodies.is_empty() {
            return;
        }
        let (points, feet) = (body_points(target, height_m), target.feet_in_world);
        let middle = feet + DVec3::Z * (0.5 * height_m);
        let across_m = (camera - feet).truncate().length();
        for passing in self.passing(time_s) {
            let is_far = |beyond_m: f64| passing.is_beyond(feet, beyond_m + height_m);
            if is_far(across_m) {
                continue;
            }
            // Lines of sight are below its top for this share of their way.
            let is_above = camera.z > passing.top_m;
            let share = if is_above { ((passing.top_m - feet.z) / (camera.z - feet.z)).clamp(0.0, 1.0) } else { 1.0 };
            if is_far(share * across_m) {
                continue;
            }
            let body = &self.bodies[passing.body];
            let reach_m = share * across_m + body.plan.radius_m() + height_m;
            let near = body.feet_at(time_s).filter(|own| (*own - feet).truncate().length() <= reach_m);
            let Some(present) = near.and_then(|_| body.at(time_s)) else { continue };
            let shape = body.plan.box_at(&present.state);
            if contains(&shape, middle) {
                continue;
            }
            for (point, hidden) in points.iter().zip(&mut *hidden) {
                *hidden = *hidden || hides(&shape, *point, camera);
            }
        }
    }

    /// Smallest distance of a drone that flies straight from one place to another between two times, capped at `within_m`: never
    /// above the true one in continuous time, at most 1 cm below it.
    pub fn clearance_m(&self, [from_s, to_s]: [f64; 2], [from, to]: [DVec3; 2], within_m: f64) -> f64 {
        let lowest_m = from.z.min(to.z) - within_m;
        let reach_m = from.distance(to) + within_m;
        let is_near = |passing: &&Passing| passing.top_m >= lowest_m && !passing.is_beyond(from, reach_m);
        let clearance_m = |smallest, body: &EpisodeBody| body.clearance_m([from_s, to_s], [from, to], smallest);
        if (from_s / STRETCH_S) as usize != (to_s / STRETCH_S) as usize {
            let low_enough = self.bodies.iter().filter(|body| body.top_m >= lowest_m);
            return low_enough.fold(within_m, clearance_m);
        }
        let near = self.passing(from_s).iter().filter(is_near);
        near.fold(within_m, |smallest, passing| clearance_m(smallest, &self.bodies[passing.body]))
    }

    /// Boxes of those who are there at a time, as somebody supposes them who knows no more: `frames` of them, `dt_s` apart, each at
    /// the velocity of the moment.
    pub fn supposed(&self, time_s: f64, frames: usize, dt_s: f64) -> Vec<Vec<OrientedBox>> {
        let boxes = |present: BodyAtTime<'_>| {
            let here = present.body.plan.box_at(&present.state);
            let velocity = present.body.velocity(time_s);
            let at = |frame: usize| OrientedBox {
                center_in_world: here.center_in_world + velocity * (frame as f64 * dt_s),
                ..here
            };
            (0..frames).map(at).collect()
        };
        self.at(time_s).map(boxes).collect()
    }
}

impl Passing {
    /// Whether the body is surely farther from a point than a distance, seen from above.
    fn is_beyond(&self, point: DVec3, distance_m: f64) -> bool {
        let reach_m = self.radius_m + distance_m + SLACK_M;
        self.middle.distance_squared(point.truncate()) > reach_m * reach_m
    }
}

impl EpisodeBody {
    fn of(number: u32, body: &Body, dt_s: f64, is_look_alike: bool) -> Self {
        let highest_m = body.states.iter().map(|state| state.feet_in_world.z).fold(f64::NEG_INFINITY, f64::max);
        let step_m = |pair: &[TargetState]| (pair[1].feet_in_world - pair[0].feet_in_world).length();
        let mut covered_m = vec![0.0];
        covered_m.extend(body.states.windows(2).map(step_m).scan(0.0, |sum, step| {
            *sum += step;
            Some(*sum)
        }));
        Self {
            number,
            plan: body.plan.clone(),
            is_look_alike,
            dt_s,
            first_s: f64::from(body.first_frame) * dt_s,
            states: body.states.clone(),
            covered_m,
            top_m: highest_m + body.plan.size_m.z,
        }
    }

    /// The body, number `body` of all, in the stretch that begins at a time; `None` where it is absent.
    fn passing(&self, body: usize, begins_s: f64) -> Option<Passing> {
        let last = self.states.len() - 1;
        let [begins, ends] = [begins_s, begins_s + STRETCH_S].map(|time_s| (time_s - self.first_s) / self.dt_s);
        if ends < -1.0 || begins > last as f64 + 1.0 {
            return None;
        }
        let (first, next) = ((begins.max(0.0) as usize).min(last), (ends.max(0.0).ceil() as usize).min(last));
        let feet = |at: usize| self.states[at].feet_in_world.truncate();
        let (low, high) =
            (first..=next).fold((feet(first), feet(first)), |(low, high), at| (low.min(feet(at)), high.max(feet(at))));
        Some(Passing {
            middle: 0.5 * (low + high),
            radius_m: 0.5 * (low.distance(high) + self.plan.size_m.truncate().length()),
            top_m: self.top_m,
            is_look_alike: self.is_look_alike,
            body,
        })
    }

    /// Place among the states at a time; `None` where the body is absent.
    fn step(&self, time_s: f64) -> Option<f64> {
        let last = (self.states.len() - 1) as f64;
        let step = (time_s - self.first_s) / self.dt_s;
        (step > -0.5 && step < last + 0.5).then(|| step.clamp(0.0, last))
    }

    /// The state before a place among the states, the one after it, and the share of the second.
    fn around(&self, step: f64) -> (usize, usize, f64) {
        let first = step as usize;
        (first, (first + 1).min(self.states.len() - 1), step - first as f64)
    }

    fn feet_at(&self, time_s: f64) -> Option<DVec3> {
        let (first, next, share) = self.around(self.step(time_s)?);
        Some(self.states[first].feet_in_world.lerp(self.states[next].feet_in_world, share))
    }

    /// The body at a time; `None` where it is absent.
    pub fn at(&self, time_s: f64) -> Option<BodyAtTime<'_>> {
        let step = self.step(time_s)?;
        let (first, next, share) = self.around(step);
        let covered_m = self.covered_m[first] + share * (self.covered_m[next] - self.covered_m[first]);
        Some(BodyAtTime { body: self, state: target_state_at(&self.states, step), covered_m })
    }

    /// Velocity at a time, m/s, world frame; zero beyond its ends.
    fn velocity(&self, time_s: f64) -> DVec3 {
        let Some(step) = self.step(time_s) else { return DVec3::ZERO };
        let (first, next, _) = self.around(step);
        (self.states[next].feet_in_world - self.states[first].feet_in_world) / self.dt_s
    }

    fn clearance_m(&self, [from_s, to_s]: [f64; 2], [from, to]: [DVec3; 2], within_m: f64) -> f64 {
        let (mut smallest, mut begin_s) = (within_m, from_s);
        while begin_s < to_s {
            // Up to the next frame, where bodies turn off.
            let frame = ((begin_s - self.first_s) / self.dt_s + 1e-6).floor() + 1.0;
            let end_s = (self.first_s + frame * self.dt_s).min(to_s);
            if let (Some(here), Some(next)) = (self.at(begin_s), self.at(end_s)) {
                let [here, next] = [here, next].map(|present| self.plan.box_at(&present.state));
                let [from, to] = [begin_s, end_s].map(|at_s| from.lerp(to, (at_s - from_s) / (to_s - from_s)));
                smallest = Encounter { here: &here, next: &next, from, to }.clearance_m(smallest);
            }
            begin_s = end_s;
        }
        smallest
    }
}

/// Whether a point lies in a box.
fn contains(shape: &OrientedBox, point: DVec3) -> bool {
    let (sin, cos) = real::sin_cos(shape.yaw_rad);
    let away = point - shape.center_in_world;
    let local = DVec3::new(cos * away.x + sin * away.y, cos * away.y - sin * away.x, away.z);
    (local.abs() - shape.half_extents_m).max_element() <= 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::{BodyKind, Traffic};
    use cosfly_frames::Seed;

    #[test]
    fn who_is_left_out_as_too_far_changes_no_bit() {
        let mut stream = Seed::of_item(1, "others", "left out").stream("t");
        let mut place = |most_m: f64| DVec3::new(stream.uniform(-most_m, most_m), stream.uniform(-most_m, most_m), 0.0);
        let body = |number: u32| {
            let (kind, size_m) = if number.is_multiple_of(5) {
                (BodyKind::Car, DVec3::new(4.5, 1.9, 1.5))
            } else {
                (BodyKind::Pedestrian, DVec3::new(0.5, 0.5, 1.7))
            };
            let (from, step) = (place(30.0), place(1.5));
            let state = |frame: u32| TargetState {
                feet_in_world: from + f64::from(frame) * step,
                heading_rad: 1.0,
                speed_mps: 1.0,
            };
            let plan = BodyPlan { source: String::new(), kind, size_m, looks: Seed([7; 32]), group: None };
            Body { plan, first_frame: 3 * (number % 9), states: (0..1 + number % 30).map(state).collect() }
        };
        let bodies: Vec<Body> = (0..80).map(body).collect();
        let followed = bodies[1].plan.clone();
        let traffic = Traffic { name: String::new(), dt_s: 0.5, frames: 60, bodies, notes: vec![] };
        let others = Others::new(&Around { numbers: (0..80).collect(), traffic }, Some(&followed));
        let everybody = |body| Passing { middle: DVec2::ZERO, radius_m: 1e9, top_m: 1e9, is_look_alike: true, body };
        let all = Others { stretches: vec![(0..80).map(everybody).collect(); 8], ..others.clone() };
        let (mut hiding, mut near) = (0, 0);
        for round in 0..3000 {
            let time_s = 0.01 * f64::from(round);
            let target = TargetState { feet_in_world: place(25.0), heading_rad: 0.0, speed_mps: 0.0 };
            let camera = target.feet_in_world + place(12.0) + DVec3::Z * f64::from(round % 12);
            let points = body_points(&target, 1.7).len();
            let [hidden, all_hidden] = [&others, &all].map(|among| {
                let mut hidden = vec![false; points];
                among.hide(time_s, camera, &target, 1.7, &mut hidden);
                hidden
            });
            assert_eq!(hidden, all_hidden, "at {time_s}");
            let way = camera + 0.5 * DVec3::X;
            let [own, of_all] =
                [&others, &all].map(|among| among.clearance_m([time_s, time_s + 0.1], [camera, way], 1.0));
            assert_eq!(own, of_all, "at {time_s}");
            let alike = all.look_alikes(time_s).filter(|present| present.body.is_look_alike).count();
            assert_eq!(others.look_alikes(time_s).count(), alike);
            (hiding, near) = (hiding + usize::from(hidden.contains(&true)), near + usize::from(own < 1.0));
        }
        assert!(hiding > 50 && near > 5, "{hiding} hidden, {near} near");
    }
}
