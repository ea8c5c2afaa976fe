//! Perturbed twins of expert flights: parameters, mixture of kinds, the kinds, and the twin itself.

pub mod config;
mod flyable;
pub mod kinds;
pub mod mixture;
mod motion;
mod twin;

pub use config::{FlyableConfig, OffsetRange, PerturbConfig};
pub use kinds::KINDS;
pub use mixture::Mixture;
pub use twin::perturb;

#[cfg(test)]
mod tests;
