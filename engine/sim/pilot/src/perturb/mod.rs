//! Perturbed twins of expert flights: parameters, mixture of kinds, the kinds, and the twin itself.

pub mod config;
mod flyable;
pub mod kinds;
pub mod mixture;
mod motion;
mod sizes;
mod twin;

pub use config::PerturbConfig;
pub use kinds::KINDS;
pub use mixture::Mixture;
pub use sizes::{FlyableConfig, JumpSizes, OffsetRange};
pub use twin::perturb;

#[cfg(test)]
mod tests;
