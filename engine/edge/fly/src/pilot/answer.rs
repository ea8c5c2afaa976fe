//! [`PolicyAnswer`]: actions that a policy gave in one message.

use crate::wire;
use cosfly_diagnose::plausible;
use cosfly_env::{Action, ActionNumber, Environment, policies};
use cosfly_frames::{DVec3, Pose, action, real};
use rmpv::Value;

/// Largest absolute value of a number of an action.
const LARGEST: f64 = 1e6;

/// The first number that no action may have, with its place in rows of `columns`, as the end of a sentence. The rule of every door
/// for actions: policies of `cosfly fly` and environments.
pub fn wrong_number<N: ActionNumber>(rows: &[N], columns: usize) -> Option<String> {
    // Mostly none is wrong.
    if N::are_within(rows, LARGEST) {
        return None;
    }
    let is_wrong = |number: &N| plausible((*number).into()).is_err() || (*number).into().abs() > LARGEST;
    let place = rows.iter().position(is_wrong)?;
    let (row, column, number) = (place / columns, place % columns, rows[place].into());
    Some(format!("{number} at row {row}, column {column}; it must be a number within {LARGEST}"))
}

/// Kind of the actions of a policy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActionKind {
    /// Rows of five numbers, one per step: velocity ahead, right, up (m/s), pitch rate and yaw rate (degrees/s).
    Velocity,
    /// Rows of six numbers, one per step: collective thrust (multiples of the weight), roll, pitch and yaw rate of a quadrotor,
    /// pitch and yaw rate of the camera (degrees/s).
    ThrustAndRates,
    /// Rows of six numbers, one per step: speeds of a quadrotor's rotors (rev/min), pitch and yaw rate of the camera (degrees/s).
    Rotors,
    /// Rows of six numbers, one per frame of the dataset: dx, dy, dz (m), dpitch, dyaw, droll (degrees) from the pose before,
    /// along the world's axes.
    DeltasInWorld,
    /// Rows as of [`Self::DeltasInWorld`], along the axes of the pose before: ahead, right, up.
    DeltasInBody,
}

impl ActionKind {
    /// Name on the command line and in cards.
    pub fn name(self) -> &'static str {
        match self {
            Self::Velocity => "velocity",
            Self::ThrustAndRates => "thrust-rates",
            Self::Rotors => "rotors",
            Self::DeltasInWorld => "deltas-world",
            Self::DeltasInBody => "deltas-body",
        }
    }

    /// All kinds.
    pub const ALL: [Self; 5] =
        [Self::Velocity, Self::ThrustAndRates, Self::Rotors, Self::DeltasInWorld, Self::DeltasInBody];

    /// Units of its numbers, in words.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Velocity => "m/s, degrees/s",
            Self::ThrustAndRates => "weights, degrees/s",
            Self::Rotors => "rev/min, degrees/s",
            Self::DeltasInWorld | Self::DeltasInBody => "m, degrees",
        }
    }

    /// Whether only quadrotors take such actions.
    pub fn is_of_rotors(self) -> bool {
        matches!(self, Self::ThrustAndRates | Self::Rotors)
    }

    /// Numbers of a row.
    pub fn columns(self) -> usize {
        if self == Self::Velocity { 5 } else { 6 }
    }
}

/// Actions that a policy gave in one message.
pub struct PolicyAnswer {
    kind: ActionKind,
    rows: Vec<f64>,
    /// Step of the observation that was answered.
    step: u32,
    /// Poses at the frames after it, the pose then first; empty for velocities.
    poses: Vec<Pose>,
    plan: Option<policies::FollowedPlan>,
    begins_s: f64,
    frame_s: f64,
}

impl PolicyAnswer {
    /// Reads the answer to the present observation.
    ///
    /// # Errors
    /// Problem of the answer, in words.
    pub fn read(message: &Value, environment: &Environment, kind: ActionKind) -> Result<Self, String> {
        let given = ["actions", "action"].into_iter().find_map(|name| wire::entry(message, name));
        let given = given.ok_or_else(|| format!("the answer is {} without `actions`", wire::kind(message)))?;
        let (rows, shape) = wire::numbers(given).map_err(|what| format!("`actions` is {what}"))?;
        let columns = kind.columns();
        let fits = matches!(shape[..], [width] | [_, width] if width == columns) && !rows.is_empty();
        if !fits {
            let name = kind.name();
            return Err(format!(
                "`actions` has the shape {shape:?}; {name} is ({columns},) or (n, {columns}) with n of at least 1"
            ));
        }
        Self::of_rows(rows, environment, kind)
    }

    /// The answer of rows, one after the other, to the present observation.
    ///
    /// # Errors
    /// The number that no action may have, in words.
    pub fn of_rows(rows: Vec<f64>, environment: &Environment, kind: ActionKind) -> Result<Self, String> {
        if let Some(wrong) = wrong_number(&rows, kind.columns()) {
            return Err(format!("`actions` is {wrong}"));
        }
        let observation = environment.observation();
        let (begins_s, frame_s) = (observation.time_s, environment.episode().target.dt_s);
        let mut answer = Self { kind, rows, step: observation.step, poses: vec![], plan: None, begins_s, frame_s };
        if matches!(kind, ActionKind::DeltasInWorld | ActionKind::DeltasInBody) {
            answer.lay_out(environment.camera());
        }
        Ok(answer)
    }

    /// Chains the increments from a pose on.
    fn lay_out(&mut self, from: Pose) {
        let moved = if self.kind == ActionKind::DeltasInWorld { action::moved_in_world } else { action::moved_in_body };
        self.poses.push(from);
        let (rows, _) = self.rows.as_chunks::<6>();
        for row in rows {
            let next = moved(self.poses.last().unwrap_or(&from), row);
            self.poses.push(next);
        }
        let waypoints: Vec<DVec3> = self.poses.iter().map(|pose| pose.position_in_world).collect();
        self.plan = Some(policies::FollowedPlan::through(&waypoints, self.begins_s, self.frame_s));
    }

    /// The action for the present step; `None` where the answer is used up or another is due after `every` steps.
    pub fn action(&self, environment: &Environment, every: u32) -> Option<Action> {
        let age = environment.observation().step - self.step;
        if age >= every {
            return None;
        }
        let Some(plan) = &self.plan else {
            let row = self.rows.chunks_exact(self.kind.columns()).nth(age as usize)?;
            return match (self.kind, row) {
                (ActionKind::ThrustAndRates, row) => row.try_into().ok().map(Action::of_thrust_and_rates),
                (ActionKind::Rotors, row) => row.try_into().ok().map(Action::of_rotors),
                (_, row) => row.try_into().ok().map(Action::of_numbers),
            };
        };
        let settings = environment.settings();
        let time_s = environment.observation().time_s - self.begins_s + settings.step_s;
        let last = self.poses.len() - 1;
        let place = time_s / self.frame_s;
        if place > last as f64 + 1e-9 {
            return None;
        }
        let (frame, share) = ((place as usize).min(last - 1), place - (place as usize).min(last - 1) as f64);
        let [from, to] = [self.poses[frame], self.poses[frame + 1]];
        let turn = real::wrap_angle_rad(to.yaw_rad - from.yaw_rad);
        let mut action = plan.action(environment, from.position_in_world);
        let gimbal = environment.gimbal();
        action.view.yaw_rad_s = real::wrap_angle_rad(from.yaw_rad + share * turn - gimbal.yaw_rad) / settings.step_s;
        let pitch_rad = from.pitch_rad + share * (to.pitch_rad - from.pitch_rad);
        action.view.pitch_rad_s = (pitch_rad - gimbal.pitch_rad) / settings.step_s;
        Some(action)
    }
}
