//! [`Craft`]: the drone of an environment, a point mass or a quadrotor.

use crate::action::{Action, Drive};
use crate::episode::Episode;
use crate::settings::{DroneSettings, EnvironmentSettings};
use cosfly_drone::quadrotor::{ControlInput, FlownQuadrotor, ThrustAndRates, TrackingError};
use cosfly_drone::wind::{Air, Turbulence};
use cosfly_drone::{Motion, PointMass, Sensed, Sensing};
use cosfly_frames::{DMat3, DVec3, real};
use cosfly_sensors::{Airframe, Derivatives};

/// Changes in a step, on the mean.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Changes {
    /// m/s^3.
    pub(crate) jerk_in_world: DVec3,
    /// Rate of the yaw, rad/s.
    pub(crate) yaw_rate_rad_s: f64,
}

/// The drone of an environment.
#[derive(Clone)]
pub(crate) enum Craft {
    PointMass(PointMass),
    Quadrotor(Box<FlownQuadrotor>),
}

impl Craft {
    /// The drone at the beginning of an episode.
    pub(crate) fn new(settings: &EnvironmentSettings, episode: &Episode, motion: Motion, yaw_rad: f64) -> Self {
        let Some(parameters) = settings.drone.model.parameters else {
            return Self::PointMass(PointMass { motion, limits: settings.motion });
        };
        let sensing = settings.drone.sensors.then(|| Sensing::new(episode.seed));
        let air = air(settings, episode, motion.position_in_world);
        Self::Quadrotor(Box::new(FlownQuadrotor::new(parameters(), motion, yaw_rad, settings.motion, air, sensing)))
    }

    /// Flies with an action in force.
    pub(crate) fn step(&mut self, action: &Action, yaw_rad: f64, time_s: f64) {
        match self {
            Self::PointMass(point) => point.step(&action.command(yaw_rad), time_s),
            Self::Quadrotor(flown) => {
                let input = match action.drive {
                    Drive::Velocity => ControlInput::Velocity(action.command(yaw_rad), yaw_rad),
                    Drive::ThrustAndRates { weights, rates_rad_s } => {
                        // To the body's right-handed axes: x ahead, y left, z up.
                        let rates_rad_s = DVec3::new(rates_rad_s.x, -rates_rad_s.y, -rates_rad_s.z);
                        ControlInput::ThrustAndRates(ThrustAndRates { thrust_n: flown.thrust_n(weights), rates_rad_s })
                    }
                    Drive::Rotors(rotors_rpm) => ControlInput::Rotors(rotors_rpm),
                };
                flown.step(&input, time_s);
            }
        }
    }

    /// Position, velocity and acceleration.
    pub(crate) fn motion(&self) -> Motion {
        match self {
            Self::PointMass(point) => point.motion,
            Self::Quadrotor(flown) => flown.motion(),
        }
    }

    /// The body after changes, with the nose of a point mass along a yaw.
    pub(crate) fn airframe(&self, changes: &Changes, yaw_rad: f64) -> Airframe {
        let motion = self.motion();
        let Self::Quadrotor(flown) = self else {
            let motion = Derivatives {
                position_in_world: motion.position_in_world,
                velocity_in_world: motion.velocity_in_world,
                acceleration_in_world: motion.acceleration_in_world,
                jerk_in_world: changes.jerk_in_world,
            };
            return Airframe::flying(&motion, yaw_rad, changes.yaw_rate_rad_s);
        };
        let state = &flown.quadrotor().state;
        // From right-handed axes to left-handed ones: y changes its sign; a turn is no vector and changes the other two.
        let flip = DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1.0));
        let rates = state.rates_rad_s;
        Airframe {
            position_in_world: motion.position_in_world,
            velocity_in_world: motion.velocity_in_world,
            acceleration_in_world: flown.tick_acceleration_in_world(),
            world_from_body: flip * DMat3::from_quat(state.attitude) * flip,
            rates_in_body: DVec3::new(-rates.x, rates.y, -rates.z),
            turn_acceleration_in_body: DVec3::ZERO,
        }
    }

    /// How well a quadrotor could do what it was asked for.
    pub(crate) fn tracking_error(&self) -> Option<&TrackingError> {
        match self {
            Self::PointMass(_) => None,
            Self::Quadrotor(flown) => Some(flown.tracking_error()),
        }
    }

    /// Attitude of a quadrotor: x, y, z, w of the rotation from its right-handed axes (x ahead, y left, z up) to those of the world
    /// with y negated.
    pub(crate) fn attitude_xyzw(&self) -> Option<[f64; 4]> {
        match self {
            Self::PointMass(_) => None,
            Self::Quadrotor(flown) => Some(flown.quadrotor().state.attitude.to_array()),
        }
    }

    /// Samples of the sensors of a quadrotor.
    pub(crate) fn sensed(&self) -> &[Sensed] {
        match self {
            Self::Quadrotor(flown) => flown.sensing().map_or(&[], Sensing::sensed),
            Self::PointMass(_) => &[],
        }
    }
}

/// The air of an episode, with the turbulence at the height where it begins.
fn air(settings: &EnvironmentSettings, episode: &Episode, start: DVec3) -> Air {
    let DroneSettings { wind_mps, gusts, .. } = settings.drone;
    let towards_rad = episode.seed.stream("wind").uniform(0.0, real::TAU);
    let (sin, cos) = real::sin_cos(towards_rad);
    let height_m = episode.place.above_ground_m(start);
    let turbulence = gusts.then(|| Turbulence::near_ground(height_m, wind_mps));
    Air::new(wind_mps * DVec3::new(cos, sin, 0.0), turbulence, episode.seed)
}
