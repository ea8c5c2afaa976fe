//! [`Action`]: what a policy asks of the drone until its next action.

use cosfly_drone::{VelocityCommand, ViewRates};
use cosfly_frames::{DVec3, real};
use serde::{Deserialize, Serialize};

/// Axes of the velocity of an action.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VelocityAxes {
    /// x ahead of the camera on the level, y right, z up.
    #[default]
    Heading,
    /// The world's.
    World,
}

/// Input that moves the drone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Drive {
    /// Velocity and acceleration of the action.
    #[default]
    Velocity,
    /// Collective thrust and rates of turning of a quadrotor.
    ThrustAndRates {
        /// Thrust, in multiples of the weight.
        weights: f64,
        /// Roll (positive: right side down), pitch (nose up) and yaw (to the right), radians/s.
        rates_rad_s: DVec3,
    },
    /// Speeds of the rotors of a quadrotor, rev/min, in the order of its parameters.
    Rotors([f64; 4]),
}

/// Action of a policy, in force until the next one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Action {
    /// Input that moves the drone.
    #[serde(skip_serializing_if = "is_default")]
    pub drive: Drive,
    /// Axes of velocity and acceleration.
    #[serde(skip_serializing_if = "is_default")]
    pub axes: VelocityAxes,
    /// Wanted velocity, m/s.
    #[serde(skip_serializing_if = "is_zero")]
    pub velocity_mps: DVec3,
    /// Acceleration with which the wanted velocity changes, m/s^2; zero where it stays.
    #[serde(skip_serializing_if = "is_zero")]
    pub acceleration_mps2: DVec3,
    /// Turns of the camera.
    pub view: ViewRates,
}

impl Action {
    /// Names of the five numbers of [`Self::of_numbers`], each with its unit.
    pub const NAMES: [&'static str; 5] =
        ["velocity_ahead_mps", "velocity_right_mps", "velocity_up_mps", "pitch_rate_deg_s", "yaw_rate_deg_s"];

    /// Action of five numbers: velocity ahead, right and up, m/s; pitch rate (positive: up) and yaw rate
    /// (positive: to the right), degrees/s: the order of poses.
    pub fn of_numbers([ahead, right, up, pitch_deg_s, yaw_deg_s]: [f64; 5]) -> Self {
        Self {
            velocity_mps: DVec3::new(ahead, right, up),
            view: ViewRates { yaw_rad_s: yaw_deg_s.to_radians(), pitch_rad_s: pitch_deg_s.to_radians() },
            ..Self::default()
        }
    }

    /// Action of six numbers: thrust in multiples of the weight; roll, pitch and yaw rate of the body, degrees/s, positive: right side
    /// down, nose up, to the right; pitch and yaw rate of the camera, degrees/s.
    pub fn of_thrust_and_rates([weights, roll, pitch, yaw, view_pitch, view_yaw]: [f64; 6]) -> Self {
        let rates_rad_s = DVec3::new(roll, pitch, yaw) * 1.0_f64.to_radians();
        Self {
            drive: Drive::ThrustAndRates { weights, rates_rad_s },
            ..Self::of_numbers([0.0, 0.0, 0.0, view_pitch, view_yaw])
        }
    }

    /// Action of six numbers: speeds of the rotors, rev/min; pitch and yaw rate of the camera, degrees/s.
    pub fn of_rotors([a, b, c, d, view_pitch, view_yaw]: [f64; 6]) -> Self {
        Self { drive: Drive::Rotors([a, b, c, d]), ..Self::of_numbers([0.0, 0.0, 0.0, view_pitch, view_yaw]) }
    }

    /// All numbers of the action, in the units of its fields.
    pub fn all_numbers(&self) -> Vec<f64> {
        let drive = match self.drive {
            Drive::Velocity => vec![],
            Drive::ThrustAndRates { weights, rates_rad_s } => {
                vec![weights, rates_rad_s.x, rates_rad_s.y, rates_rad_s.z]
            }
            Drive::Rotors(rotors_rpm) => rotors_rpm.to_vec(),
        };
        let [velocity, acceleration] = [self.velocity_mps, self.acceleration_mps2].map(|it| it.to_array());
        [&drive[..], &velocity, &acceleration, &[self.view.yaw_rad_s, self.view.pitch_rad_s]].concat()
    }

    /// The numbers of an action of a drone with this yaw, in the form of its drive.
    pub fn row(&self, yaw_rad: f64) -> Vec<f64> {
        let view = [self.view.pitch_rad_s, self.view.yaw_rad_s].map(f64::to_degrees);
        match self.drive {
            Drive::Velocity => self.numbers(yaw_rad).to_vec(),
            Drive::ThrustAndRates { weights, rates_rad_s } => {
                let rates = rates_rad_s.to_array().map(f64::to_degrees);
                [&[weights][..], &rates, &view].concat()
            }
            Drive::Rotors(rotors_rpm) => [&rotors_rpm[..], &view].concat(),
        }
    }

    /// The five numbers of an action of a drone with this yaw.
    pub fn numbers(&self, yaw_rad: f64) -> [f64; 5] {
        let velocity = match self.axes {
            VelocityAxes::Heading => self.velocity_mps,
            VelocityAxes::World => heading_from_world(yaw_rad)(self.velocity_mps),
        };
        let view = [self.view.pitch_rad_s, self.view.yaw_rad_s].map(f64::to_degrees);
        [velocity.x, velocity.y, velocity.z, view[0], view[1]]
    }

    /// The command for a drone with this yaw.
    pub fn command(&self, yaw_rad: f64) -> VelocityCommand {
        let mut vectors = [self.velocity_mps, self.acceleration_mps2];
        if self.axes == VelocityAxes::Heading {
            vectors = vectors.map(world_from_heading(yaw_rad));
        }
        let [velocity_in_world, acceleration_in_world] = vectors;
        VelocityCommand { velocity_in_world, acceleration_in_world }
    }
}

/// Whether a vector is zero to the bit: -0 is kept.
fn is_zero(vector: &DVec3) -> bool {
    vector.to_array().iter().all(|number| number.to_bits() == 0)
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Turns vectors from the axes of a heading into the world's.
pub fn world_from_heading(yaw_rad: f64) -> impl Fn(DVec3) -> DVec3 {
    let (sin, cos) = real::sin_cos(yaw_rad);
    move |vector| DVec3::new(cos * vector.x - sin * vector.y, sin * vector.x + cos * vector.y, vector.z)
}

/// Turns vectors from the world's axes into those of a heading.
pub fn heading_from_world(yaw_rad: f64) -> impl Fn(DVec3) -> DVec3 {
    world_from_heading(-yaw_rad)
}
