//! [`Others`]: who moves around the target, at any time of an episode.
//!
//! Between frames a body goes evenly from place to place and turns the shorter way, as in films and for the planner. A body that comes
//! or goes is there for half a frame before its first state and after its last.

use cosfly_domain::{Around, Body, BodyPlan, OrientedBox, Outfit};
use cosfly_figures::BodyShape;
use cosfly_frames::{DVec3, TargetState, real};
use cosfly_optics::target_state_at;
use cosfly_surroundings::moving::{Encounter, hides};
use cosfly_surroundings::visibility::body_points;

/// Who moves around the target.
#[derive(Clone, Debug, Default)]
pub struct Others {
    movers: Vec<Mover>,
}

/// A person or vehicle.
#[derive(Clone, Debug)]
pub struct Mover {
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
    /// Its highest point on all its way, world frame, metres.
    top_m: f64,
}

/// A body at a moment.
#[derive(Clone, Copy, Debug)]
pub struct Present<'a> {
    /// The body.
    pub mover: &'a Mover,
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
        let outfit = |plan: &BodyPlan| Outfit::of(BodyShape::of(plan.kind, plan.size_m), &plan.looks);
        let own = followed.map(|plan| (plan.kind, outfit(plan)));
        let is_look_alike =
            |plan: &BodyPlan| own.as_ref().is_some_and(|(kind, worn)| *kind == plan.kind && outfit(plan).is_like(worn));
        let bodies = around.bodies().filter(|(_, body)| is_sound && !body.states.is_empty());
        Self { movers: bodies.map(|(number, body)| Mover::of(number, body, dt_s, is_look_alike(&body.plan))).collect() }
    }

    /// Whether nobody else is about.
    pub fn is_empty(&self) -> bool {
        self.movers.is_empty()
    }

    /// Everybody who comes near in the course of the episode.
    pub fn movers(&self) -> &[Mover] {
        &self.movers
    }

    /// Everybody who is there at a time, seconds from the beginning of the episode.
    pub fn at(&self, time_s: f64) -> impl Iterator<Item = Present<'_>> {
        self.movers.iter().filter_map(move |mover| mover.at(time_s))
    }

    /// Marks those of the target's body points that a body hides from a camera. A body around the target's own middle hides nothing
    /// of it, as for the planner.
    pub fn hide(&self, time_s: f64, camera: DVec3, target: &TargetState, height_m: f64, hidden: &mut [bool]) {
        if self.movers.is_empty() {
            return;
        }
        let (points, feet) = (body_points(target, height_m), target.feet_in_world);
        let middle = feet + DVec3::Z * (0.5 * height_m);
        let across_m = (camera - feet).truncate().length();
        for mover in &self.movers {
            // Lines of sight are below its top for this share of their way.
            let is_above = camera.z > mover.top_m;
            let share = if is_above { ((mover.top_m - feet.z) / (camera.z - feet.z)).clamp(0.0, 1.0) } else { 1.0 };
            let reach_m = share * across_m + mover.plan.radius_m() + height_m;
            let near = mover.feet_at(time_s).filter(|own| (*own - feet).truncate().length() <= reach_m);
            let Some(present) = near.and_then(|_| mover.at(time_s)) else { continue };
            let shape = mover.plan.box_at(&present.state);
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
        let low_enough = self.movers.iter().filter(|mover| mover.top_m >= lowest_m);
        low_enough.fold(within_m, |smallest, mover| mover.clearance_m([from_s, to_s], [from, to], smallest))
    }

    /// Boxes of those who are there at a time, as somebody supposes them who knows no more: `frames` of them, `dt_s` apart, each at
    /// the velocity of the moment.
    pub fn supposed(&self, time_s: f64, frames: usize, dt_s: f64) -> Vec<Vec<OrientedBox>> {
        let boxes = |present: Present<'_>| {
            let here = present.mover.plan.box_at(&present.state);
            let velocity = present.mover.velocity(time_s);
            let at = |frame: usize| OrientedBox {
                center_in_world: here.center_in_world + velocity * (frame as f64 * dt_s),
                ..here
            };
            (0..frames).map(at).collect()
        };
        self.at(time_s).map(boxes).collect()
    }
}

impl Mover {
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
    pub fn at(&self, time_s: f64) -> Option<Present<'_>> {
        let step = self.step(time_s)?;
        let (first, next, share) = self.around(step);
        let covered_m = self.covered_m[first] + share * (self.covered_m[next] - self.covered_m[first]);
        Some(Present { mover: self, state: target_state_at(&self.states, step), covered_m })
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
