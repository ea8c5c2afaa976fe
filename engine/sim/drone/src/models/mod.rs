//! Models of drones, one file each.
//!
//! To add one, write its file and add two lines here: its `mod` and its entry in [`MODELS`].

mod crazyflie;
mod model;
mod pelican;
mod point_mass;

pub use model::DroneModel;

use crate::quadrotor::QuadrotorParameters;

/// All models; the first one is the default.
#[rustfmt::skip] // an entry per line
pub const MODELS: &[DroneModel] = &[
    point_mass::MODEL,
    crazyflie::MODEL,
    pelican::MODEL,
];

/// Parameters of the quadrotor of a name; none where there is no such quadrotor.
pub fn quadrotor(name: &str) -> Option<QuadrotorParameters> {
    model(name).ok()?.parameters.map(|parameters| parameters())
}

/// The model of a name.
///
/// # Errors
/// The names that there are, in words.
pub fn model(name: &str) -> Result<DroneModel, String> {
    let names = || MODELS.iter().map(|model| model.name).collect::<Vec<_>>().join(", ");
    MODELS.iter().find(|model| model.name == name).copied().ok_or_else(|| format!("allowed are {}", names()))
}
