//! Perturbed twins of expert flights: parameters, displacements, and the twin itself.

pub mod config;
mod displacement;
mod twin;

pub use config::{OffsetRange, PerturbConfig};
pub use twin::perturb;

#[cfg(test)]
mod tests;
