//! People and vehicles on their tracks, by the clock of a flight.

use crate::looks::walk_seed;
use crate::shooting::Shooting;
use cosfly_diagnose::Result;
use cosfly_domain::{Body, BodyKind, BodyPlan, Followed, OrientedBox, Outfit};
use cosfly_figures::{BodyFigure, BodyShape, outfit_of};
use cosfly_frames::{DVec3, Seed, TargetState, TargetTrack};
use cosfly_optics::target_state_at;
use cosfly_pedestrians::PedestrianPath;

/// Distance between the axes of a target and somebody who walks on their own below which one would walk through the other, metres.
const APART_M: f64 = 0.6;

/// A person or vehicle on a track that has at least one state.
pub struct BodyOnTrack {
    track: TargetTrack,
    /// Time of the track's first state, seconds from the flight's first frame.
    first_s: f64,
    /// Whether the body is absent before and after its track; otherwise it stands at the ends.
    comes_and_goes: bool,
    walked_m: Vec<f64>,
    plan: BodyPlan,
    body: BodyShape,
}

impl BodyOnTrack {
    /// The body on `walk`; `followed` where it is not a grown person on foot.
    pub fn on(walk: &PedestrianPath, followed: Option<&Followed>) -> Result<Self> {
        let track = walk.track.clone();
        let plan = match followed {
            None => plan_of(&track, BodyKind::Pedestrian, walk_seed(&track)?),
            Some(followed) => followed.plan.clone(),
        };
        let (walked_m, body) = (walked_m(&track.states), BodyShape::of(plan.kind, plan.size_m));
        Ok(Self { walked_m, plan, track, first_s: 0.0, comes_and_goes: false, body })
    }

    /// The target of a flight; `followed` where it is not a grown person on a walk of its own.
    pub fn target(track: &TargetTrack, followed: Option<&Followed>) -> Self {
        let plan = followed.map_or_else(|| plan_of(track, BodyKind::Pedestrian, Seed([0; 32])), |it| it.plan.clone());
        Self::of(&Body { plan, first_frame: 0, states: track.states.clone() }, track.dt_s)
    }

    /// A body of traffic whose frames are `dt_s` apart.
    pub fn of(body: &Body, dt_s: f64) -> Self {
        let (height_m, radius_m) = (body.plan.size_m.z, body.plan.radius_m());
        let track = TargetTrack { dt_s, height_m, radius_m, states: body.states.clone() };
        let first_s = f64::from(body.first_frame) * dt_s;
        let (plan, shape) = (body.plan.clone(), BodyShape::of(body.plan.kind, body.plan.size_m));
        Self { walked_m: walked_m(&track.states), track, first_s, comes_and_goes: true, plan, body: shape }
    }

    /// The body by a clock that begins some seconds later.
    pub fn since(self, begins_s: f64) -> Self {
        Self { first_s: self.first_s - begins_s, ..self }
    }

    /// Properties of the body that do not change.
    pub fn plan(&self) -> &BodyPlan {
        &self.plan
    }

    /// Dresses the person for the weather of a flight.
    pub fn dress_for(&mut self, shooting: &Shooting) {
        self.body = shooting.dressed(self.body, &self.plan.looks);
    }

    /// Body height and radius seen from above, metres.
    pub fn size_m(&self) -> (f64, f64) {
        (self.track.height_m, self.track.radius_m)
    }

    /// Clothes of the person or rider, paint of another vehicle.
    pub fn outfit(&self) -> Outfit {
        outfit_of(self.body, &self.plan.looks)
    }

    /// State at a time, seconds from the flight's first frame; `None` where the body is absent. At the end of a walk the
    /// body stands still.
    pub fn state(&self, time_s: f64) -> Option<TargetState> {
        let (states, step) = (&self.track.states, self.step(time_s)?);
        let state = target_state_at(states, step);
        let is_over = time_s - self.first_s > (states.len() - 1) as f64 * self.track.dt_s;
        Some(TargetState { speed_mps: if is_over { 0.0 } else { state.speed_mps }, ..state })
    }

    /// Box around the body at a time, seconds from the flight's first frame; `None` where the body is absent.
    pub fn box_at(&self, time_s: f64) -> Option<OrientedBox> {
        self.state(time_s).map(|state| self.plan.box_at(&state))
    }

    /// State and looks at a time, seconds from the flight's first frame; `None` where the body is absent.
    pub fn figure(&self, time_s: f64) -> Option<BodyFigure> {
        let step = self.step(time_s)?;
        let first = step as usize;
        let last = (first + 1).min(self.track.len() - 1);
        let walked_m = self.walked_m[first] + (self.walked_m[last] - self.walked_m[first]) * (step - first as f64);
        Some(BodyFigure { body: self.body, ..BodyFigure::of(&self.plan, self.state(time_s)?, walked_m) })
    }

    /// True where the body walks through a target with a body.
    pub fn meets(&self, target: &TargetTrack) -> bool {
        let near = |(frame, state): (usize, &TargetState)| {
            let own = self.state(frame as f64 * target.dt_s);
            own.is_some_and(|own| (own.feet_in_world - state.feet_in_world).length() < APART_M)
        };
        target.radius_m > 0.0 && target.states.iter().enumerate().any(near)
    }

    /// States in the frames of a flight; `None` where the body is absent.
    pub fn states(&self, flight: &TargetTrack) -> Vec<Option<TargetState>> {
        (0..flight.len()).map(|frame| self.state(frame as f64 * flight.dt_s)).collect()
    }

    /// Place in the track at a time, frames; `None` where the body is absent. A body that comes and goes stays for half a frame
    /// beyond its first and last state, so that pictures with an exposure or a rolling shutter show it whole.
    fn step(&self, time_s: f64) -> Option<f64> {
        let last = (self.track.len() - 1) as f64;
        let step = (time_s - self.first_s) / self.track.dt_s;
        let is_there = !self.comes_and_goes || (step > -0.5 && step < last + 0.5);
        is_there.then(|| step.clamp(0.0, last))
    }
}

/// Somebody of a kind on a walk of their own; `None` for a grown person on foot.
///
/// # Errors
/// Those of [`walk_seed`].
pub fn followed_on(track: &TargetTrack, kind: BodyKind) -> Result<Option<Followed>> {
    let plan = plan_of(track, kind, walk_seed(track)?);
    Ok((kind != BodyKind::Pedestrian).then_some(Followed { traffic: String::new(), number: 0, plan }))
}

fn plan_of(track: &TargetTrack, kind: BodyKind, looks: Seed) -> BodyPlan {
    let outline_m = kind.row().walking.as_ref().and_then(|it| it.outline_m);
    let [length_m, width_m] = outline_m.unwrap_or([2.0 * track.radius_m; 2]);
    let size_m = DVec3::new(length_m, width_m, track.height_m);
    BodyPlan { source: String::new(), kind, size_m, looks, group: None }
}

/// Whether two bodies touch in a frame, one beside the other and at the same height.
pub fn touch(
    (plan, states): (&BodyPlan, &[Option<TargetState>]),
    (other, others): (&BodyPlan, &[Option<TargetState>]),
) -> bool {
    let reach_m = plan.radius_m() + other.radius_m();
    let overlap = |pair: (&Option<TargetState>, &Option<TargetState>)| {
        let (Some(one), Some(two)) = pair else { return false };
        let away = two.feet_in_world - one.feet_in_world;
        let is_level = away.z < plan.size_m.z && -away.z < other.size_m.z;
        is_level
            && away.truncate().length_squared() < reach_m * reach_m
            && cosfly_world::gap_m(plan, one, other, two) < 0.0
    };
    states.iter().zip(others).any(overlap)
}

/// Distance walked up to each frame, metres.
pub fn walked_m(states: &[TargetState]) -> Vec<f64> {
    let mut sum_m = 0.0;
    let step_m = |frame: usize| match frame {
        0 => 0.0,
        _ => (states[frame].feet_in_world - states[frame - 1].feet_in_world).length(),
    };
    (0..states.len())
        .map(|frame| {
            sum_m += step_m(frame);
            sum_m
        })
        .collect()
}
