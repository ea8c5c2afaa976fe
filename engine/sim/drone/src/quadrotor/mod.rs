//! A quadrotor: rotors that spin up, thrust, drag, gyroscopic torques; and a controller that tracks a setpoint.
//!
//! # Frame
//! Everything here is right-handed, as in flight models: x ahead, y left, z up; the inertial frame is the world's with y negated
//! ([`flipped`] converts vectors both ways). Attitudes turn vectors of the body into the inertial frame.

mod control;
mod dynamics;
mod flown;
mod parameters;
#[cfg(test)]
mod tests;

pub use control::{ControlGains, Controller, Setpoint, ThrustAndRates};
pub use dynamics::{Derivative, Quadrotor, QuadrotorState, TICK_S};
pub use flown::{ControlInput, FlownQuadrotor, TrackingError};
pub use parameters::{Gyroscope, QuadrotorParameters};

use cosfly_frames::DVec3;

/// A vector of the world frame in the right-handed frame, or the other way round.
pub fn flipped(vector: DVec3) -> DVec3 {
    DVec3::new(vector.x, -vector.y, vector.z)
}
