//! [`BodyFigure`]: what is drawn of a person or a vehicle at a moment: where it is, how it moves, what draws its looks.

use crate::body_shape::{BodyShape, Posture};
use cosfly_domain::{BodyKind, BodyPlan};
use cosfly_frames::{DVec3, Seed, TargetState, real};

/// Steps of people who take something along are those of people who walk no faster than this, m/s.
const SHORT_STEPS_MPS: f64 = 0.75;

/// Steps of people who run, relative to those of people who walk.
const RUNNING_STEP: f64 = 1.4;

/// Figure of a body at a moment: of a person, or of a vehicle with its rider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyFigure {
    /// Position, heading and speed.
    pub state: TargetState,
    /// Body height, metres; vehicles have that of [`Self::body`].
    pub height_m: f64,
    /// Body radius seen from above, metres; vehicles have the extent of [`Self::body`].
    pub radius_m: f64,
    /// Draws their clothes, skin and build; paint and model of a vehicle.
    pub clothes_seed: Seed,
    /// Phase of the gait, radians; see [`gait_phase_rad`]. Of a bicycle, that of the pedals; other vehicles have none.
    pub gait_phase_rad: f64,
    /// Shape of the body.
    pub body: BodyShape,
}

impl BodyFigure {
    /// The figure of a body that has covered `covered_m` metres since its first state.
    pub fn of(plan: &BodyPlan, state: TargetState, covered_m: f64) -> Self {
        let height_m = plan.size_m.z;
        let stretch = if plan.kind == BodyKind::Runner { RUNNING_STEP } else { 1.0 };
        Self {
            state,
            height_m,
            radius_m: plan.radius_m(),
            clothes_seed: plan.looks,
            gait_phase_rad: gait_phase_rad(covered_m / stretch, height_m),
            body: BodyShape::of(plan.kind, plan.size_m),
        }
    }

    /// The person on foot in the body, beside what the person takes along; `None` for vehicles and wheelchairs.
    pub(crate) fn on_foot(&self) -> Option<Self> {
        let BodyShape::Vehicle { kind, size_m } = self.body else { return Some(*self) };
        let (posture, ahead_m, right_m) = match kind {
            BodyKind::PushChair => (Posture::Pushing, -0.36, 0.0),
            BodyKind::DogWalker => (Posture::Leading, -0.40, -0.12),
            _ => return None,
        };
        let (sin, cos) = real::sin_cos(self.state.heading_rad);
        let away = DVec3::new(cos * ahead_m - sin * right_m, sin * ahead_m + cos * right_m, 0.0);
        let state = TargetState {
            feet_in_world: self.state.feet_in_world + away,
            speed_mps: self.state.speed_mps.min(SHORT_STEPS_MPS),
            ..self.state
        };
        let body = BodyShape::Person { umbrella: false, posture };
        Some(Self { state, height_m: size_m.z, radius_m: 0.14 * size_m.z, body, ..*self })
    }

    /// Whether a vehicle has not moved yet, as parked ones never do: its lamps are off.
    pub fn is_parked(&self) -> bool {
        !self.body.is_person() && self.state.speed_mps == 0.0 && self.gait_phase_rad == 0.0
    }

    /// Whether there is a body to draw.
    pub fn has_body(&self) -> bool {
        let numbers = [self.radius_m, self.state.heading_rad, self.state.speed_mps, self.gait_phase_rad];
        self.height_m > 0.0
            && self.height_m.is_finite()
            && self.body.is_drawable()
            && self.state.feet_in_world.is_finite()
            && numbers.iter().all(|number| number.is_finite())
    }
}

/// Figure of a body in a picture, beside that of the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FigureInPicture {
    /// The figure.
    pub figure: BodyFigure,
    /// Id in instance images: not 0, not the target's, not that of an object.
    pub instance: u32,
}

/// Phase of the gait after `walked_m` metres: one turn every two steps, and two steps are 0.83 body heights.
pub fn gait_phase_rad(walked_m: f64, height_m: f64) -> f64 {
    real::wrap_angle_rad(real::TAU * walked_m / (0.83 * height_m.max(0.1)))
}

/// Phase of a cyclist's pedals after `ridden_m` metres: one turn every 5 m.
pub fn pedal_phase_rad(ridden_m: f64) -> f64 {
    real::wrap_angle_rad(real::TAU * ridden_m / 5.0)
}
