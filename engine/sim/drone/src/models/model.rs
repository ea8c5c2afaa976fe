//! [`DroneModel`]: a model of a drone, by name.

use crate::quadrotor::QuadrotorParameters;

/// Model of a drone.
#[derive(Clone, Copy, Debug)]
pub struct DroneModel {
    /// Name on the command line, in recipes and in cards.
    pub name: &'static str,
    /// Description, half a sentence.
    pub doc: &'static str,
    /// Parameters of a quadrotor; none of a point mass.
    pub parameters: Option<fn() -> QuadrotorParameters>,
}

impl PartialEq for DroneModel {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}
