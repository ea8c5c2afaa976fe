//! Drones that fly: the motion that follows from commands, step by step.
//!
//! * [`PointMass`]: follows velocities within limits of speed, acceleration and jerk, as flights of the planner do.
//! * [`Gimbal`]: yaw and pitch of the camera, within limits of rate and angle.
//! * [`models`]: drones by name. [`quadrotor`]: rotors, thrust, drag, gyroscopic torques, and a controller that tracks setpoints.
//! * [`wind`]: a mean and gusts. [`sensors`]: inertial unit, barometer, satellite receiver; [`Sensing`]: their samples in flight.
//! * [`Spline`]: a smooth flight along waypoints of the planner that keeps their limits between the waypoints, too.
//!
//! Steps are deterministic, in f64, and allocate nothing but samples of sensors.

mod gimbal;
pub mod models;
mod point_mass;
pub mod quadrotor;
mod sensing;
pub mod sensors;
mod spline;
pub mod wind;

pub use gimbal::{Gimbal, GimbalLimits, ViewRates};
pub use point_mass::{Motion, MotionLimits, PointMass, VelocityCommand};
pub use sensing::{Sensed, Sensing};
pub use spline::Spline;
