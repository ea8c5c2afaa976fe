//! [`FlownQuadrotor`]: a quadrotor in closed loop: it follows velocities, or thrust and rates, or speeds of rotors, in wind.

use super::control::{ControlGains, Controller, Setpoint, ThrustAndRates};
use super::dynamics::{Quadrotor, TICK_S};
use super::flipped;
use super::parameters::{GRAVITY_MPS2, QuadrotorParameters};
use crate::point_mass::{Motion, MotionLimits, PointMass, VelocityCommand};
use crate::sensing::Sensing;
use crate::wind::Air;
use cosfly_frames::{DQuat, DVec3};

/// Distance by which the point that is followed gets ahead of the drone at most, metres.
const LEASH_M: f64 = 2.0;

/// Input of the control loop: a velocity, thrust and rates, or speeds of rotors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ControlInput {
    /// To fly as a point mass would that follows a velocity, nose along a yaw (world frame, radians).
    Velocity(VelocityCommand, f64),
    /// Collective thrust and rates of turning (the body's right-handed axes).
    ThrustAndRates(ThrustAndRates),
    /// Speeds of the rotors, rev/min.
    Rotors([f64; 4]),
}

/// How well a drone could do what it was asked for, since its beginning.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TrackingError {
    /// Ticks.
    pub ticks: u64,
    /// Ticks in which a rotor was asked for more or less thrust than it has.
    pub saturated_ticks: u64,
    /// Ticks with a setpoint, sum and largest of the distances from it, metres.
    pub followed_ticks: u64,
    /// See `followed_ticks`.
    pub error_sum_m: f64,
    /// See `followed_ticks`.
    pub largest_error_m: f64,
}

/// A quadrotor in closed loop. Velocities move a point mass within its limits, and the controller tracks that point.
#[derive(Clone, Debug)]
pub struct FlownQuadrotor {
    quadrotor: Quadrotor,
    controller: Controller,
    point: PointMass,
    air: Air,
    time_s: f64,
    error: TrackingError,
    sensing: Option<Sensing>,
    acceleration_in_world: DVec3,
    /// Mean acceleration of the last tick, inertial frame, m/s^2.
    tick_acceleration_mps2: DVec3,
}

impl FlownQuadrotor {
    /// A quadrotor in level attitude with a motion and a yaw (world frame), rotors at the speed of hover.
    pub fn new(
        parameters: QuadrotorParameters,
        motion: Motion,
        yaw_rad: f64,
        limits: MotionLimits,
        air: Air,
        sensing: Option<Sensing>,
    ) -> Self {
        let controller = Controller::new(&parameters, ControlGains::default());
        let mut quadrotor = Quadrotor::hovering(flipped(motion.position_in_world), parameters);
        quadrotor.state.velocity_mps = flipped(motion.velocity_in_world);
        quadrotor.state.attitude = DQuat::from_rotation_z(-yaw_rad);
        let point = PointMass { motion, limits };
        Self {
            quadrotor,
            controller,
            point,
            air,
            time_s: 0.0,
            error: TrackingError::default(),
            sensing,
            acceleration_in_world: DVec3::ZERO,
            tick_acceleration_mps2: DVec3::ZERO,
        }
    }

    /// Flies for `time_s` seconds.
    pub fn step(&mut self, input: &ControlInput, time_s: f64) {
        let before = self.point.motion;
        let from = self.motion();
        if let ControlInput::Velocity(command, _) = input {
            self.point.step(command, time_s);
        }
        let acceleration = (self.point.motion.velocity_in_world - before.velocity_in_world) / time_s;
        // The parabola that begins where the point was and ends where it is, so that velocities are those of the places.
        let first_velocity = before.velocity_in_world + 0.5 * time_s * acceleration;
        self.time_s += time_s;
        let ticks = (self.time_s / TICK_S).round() as u64 - self.error.ticks;
        for tick in 0..ticks {
            let since_s = tick as f64 * TICK_S;
            let place = before.position_in_world + since_s * (first_velocity + 0.5 * since_s * acceleration);
            let setpoint = |yaw_rad: f64| Setpoint {
                position_m: flipped(place),
                velocity_mps: flipped(first_velocity + since_s * acceleration),
                acceleration_mps2: flipped(acceleration),
                yaw_rad: -yaw_rad,
            };
            self.tick(input, &setpoint);
        }
        self.acceleration_in_world = (self.velocity_in_world() - from.velocity_in_world) / time_s;
        let Motion { position_in_world, velocity_in_world, .. } = self.motion();
        let motion = &mut self.point.motion;
        match input {
            // A point that the drone cannot follow waits for it.
            ControlInput::Velocity(..) => {
                let ahead = (motion.position_in_world - position_in_world).clamp_length_max(LEASH_M);
                motion.position_in_world = position_in_world + ahead;
            }
            _ => *motion = Motion { position_in_world, velocity_in_world, ..Motion::default() },
        }
    }

    fn tick(&mut self, input: &ControlInput, setpoint: &dyn Fn(f64) -> Setpoint) {
        let state = &self.quadrotor.state;
        let mut driven = |wanted: &ThrustAndRates| {
            self.error.saturated_ticks += u64::from(self.controller.saturates(state, wanted));
            self.controller.rotors_rpm(state, wanted)
        };
        let rotors = match input {
            ControlInput::Velocity(_, yaw_rad) => {
                let setpoint = setpoint(*yaw_rad);
                let rotors = driven(&self.controller.track(state, &setpoint));
                let error_m = state.position_m.distance(setpoint.position_m);
                self.error.followed_ticks += 1;
                self.error.error_sum_m += error_m;
                self.error.largest_error_m = self.error.largest_error_m.max(error_m);
                rotors
            }
            ControlInput::ThrustAndRates(wanted) => driven(wanted),
            ControlInput::Rotors(rotors) => {
                let (low, high) = self.quadrotor.parameters.speed_rpm;
                self.error.saturated_ticks += u64::from(rotors.iter().any(|rpm| !(low..=high).contains(rpm)));
                *rotors
            }
        };
        let (wind_mps, before_mps) = (flipped(self.air.next_in_world()), self.quadrotor.state.velocity_mps);
        self.quadrotor.step(rotors, wind_mps, TICK_S);
        self.tick_acceleration_mps2 = (self.quadrotor.state.velocity_mps - before_mps) / TICK_S;
        self.error.ticks += 1;
        if let Some(sensing) = &mut self.sensing {
            sensing.tick(self.error.ticks, &self.quadrotor.state);
        }
    }

    /// Position, velocity, and the mean acceleration of the last step.
    pub fn motion(&self) -> Motion {
        Motion {
            position_in_world: flipped(self.quadrotor.state.position_m),
            velocity_in_world: self.velocity_in_world(),
            acceleration_in_world: self.acceleration_in_world,
        }
    }

    /// Mean acceleration of the last tick, m/s^2.
    pub fn tick_acceleration_in_world(&self) -> DVec3 {
        flipped(self.tick_acceleration_mps2)
    }

    fn velocity_in_world(&self) -> DVec3 {
        flipped(self.quadrotor.state.velocity_mps)
    }

    /// The quadrotor.
    pub fn quadrotor(&self) -> &Quadrotor {
        &self.quadrotor
    }

    /// How well it could do what it was asked for.
    pub fn tracking_error(&self) -> &TrackingError {
        &self.error
    }

    /// Samples of its sensors.
    pub fn sensing(&self) -> Option<&Sensing> {
        self.sensing.as_ref()
    }

    /// Thrust that carries a multiple of its weight, N.
    pub fn thrust_n(&self, weights: f64) -> f64 {
        weights * self.quadrotor.parameters.mass_kg * GRAVITY_MPS2
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::models::quadrotor;
    use crate::wind::Turbulence;
    use cosfly_frames::Seed;

    fn drone(parameters: QuadrotorParameters, air: Air) -> FlownQuadrotor {
        let motion = Motion { position_in_world: DVec3::new(3.0, 4.0, 20.0), ..Motion::default() };
        FlownQuadrotor::new(parameters, motion, 0.5, MotionLimits::default(), air, None)
    }

    #[test]
    fn velocities_are_followed_as_a_point_mass_would_also_in_gusts() {
        let gusty = || Air::new(DVec3::new(3.0, 0.0, 0.0), Some(Turbulence::near_ground(20.0, 3.0)), Seed([7; 32]));
        for (parameters, air, within_m) in [
            (quadrotor("crazyflie").unwrap(), Air::still(), 0.3),
            (quadrotor("pelican").unwrap(), Air::still(), 0.3),
            (quadrotor("pelican").unwrap(), gusty(), 0.6),
        ] {
            let mut flown = drone(parameters, air);
            let mut point = flown.point;
            for step in 0..100 {
                let velocity_in_world = if step < 50 { DVec3::new(2.0, -1.0, 0.5) } else { DVec3::new(0.0, 2.0, 0.0) };
                let command = VelocityCommand { velocity_in_world, ..VelocityCommand::default() };
                flown.step(&ControlInput::Velocity(command, 0.5), 0.1);
                point.step(&command, 0.1);
            }
            let away_m = flown.motion().position_in_world.distance(point.motion.position_in_world);
            let error = flown.tracking_error();
            assert_eq!((error.ticks, error.followed_ticks), (10_000, 10_000));
            assert!(away_m < within_m && error.largest_error_m < within_m, "{away_m} {error:?}");
        }
    }

    #[test]
    fn split_steps_fly_as_whole_ones_under_thrust_and_rates() {
        let parameters = quadrotor("pelican").unwrap();
        let (mut whole, mut split) = (drone(parameters.clone(), Air::still()), drone(parameters, Air::still()));
        let wanted = ThrustAndRates { thrust_n: whole.thrust_n(1.1), rates_rad_s: DVec3::new(0.1, 0.2, 0.0) };
        for _ in 0..10 {
            whole.step(&ControlInput::ThrustAndRates(wanted), 0.1);
            [0.057, 0.043].iter().for_each(|time_s| split.step(&ControlInput::ThrustAndRates(wanted), *time_s));
        }
        assert_eq!(whole.quadrotor.state, split.quadrotor.state);
        assert!(whole.motion().position_in_world.z > 20.1);
    }

    #[test]
    fn more_than_the_rotors_have_is_counted() {
        let mut flown = drone(quadrotor("crazyflie").unwrap(), Air::still());
        let wanted = ThrustAndRates { thrust_n: flown.thrust_n(5.0), rates_rad_s: DVec3::ZERO };
        flown.step(&ControlInput::ThrustAndRates(wanted), 0.1);
        assert_eq!(flown.tracking_error().saturated_ticks, 100);
        flown.step(&ControlInput::Rotors([f64::NAN; 4]), 0.1);
        assert_eq!(flown.tracking_error().saturated_ticks, 200);
        assert!(flown.motion().position_in_world.is_finite());
    }
}
