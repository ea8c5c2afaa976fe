//! Perturbed twins of expert flights: parameters, kinds, displacements, and the twin itself.

pub mod config;
mod displacement;
mod flyable;
pub mod kind;
mod motion;
mod search;
mod twin;

pub use config::{FlyableConfig, OffsetRange, PerturbConfig};
pub use kind::{Kind, Mixture};
pub use twin::perturb;

#[cfg(test)]
mod tests;
