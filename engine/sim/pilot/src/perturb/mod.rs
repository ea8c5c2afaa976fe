//! Perturbed twins of expert flights: parameters, mixture of kinds, displacements, and the twin itself.

pub mod config;
mod displacement;
mod flyable;
pub mod mixture;
mod motion;
mod search;
mod twin;

pub use config::{FlyableConfig, OffsetRange, PerturbConfig};
pub use mixture::Mixture;
pub use twin::perturb;

#[cfg(test)]
mod tests;
