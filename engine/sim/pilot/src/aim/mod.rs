//! Aim of the camera: a pilot who frames, lags and leads instead of a view that never leaves the target.

pub mod config;
mod pilot;
pub mod wander;

pub use config::AimConfig;
pub use pilot::{aimed, reached};

#[cfg(test)]
mod tests;
