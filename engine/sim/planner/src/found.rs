//! A valid flight, whoever planned it, before it is published.

use crate::certificate::Measured;
use cosfly_frames::DVec3;

/// A valid flight.
pub struct Found {
    /// One waypoint per frame, world frame, metres.
    pub waypoints: Vec<DVec3>,
    /// Measurements per frame, and the certificate.
    pub measured: Measured,
    /// Total cost after each step of the last attempt.
    pub convergence: Vec<f64>,
}
