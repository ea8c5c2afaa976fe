//! Baselines for models: predictions without pictures.
//!
//! A prediction is an estimate of the current pose and the waypoints after it. The estimate matters for increments (see
//! `Anchor`): a line fitted to a noisy history does not pass through its last pose.

pub mod extrapolate;
pub mod features;
pub mod nearest;
pub mod prediction;
pub mod ridge;
mod solve;

pub use extrapolate::Extrapolation;
pub use nearest::NearestNeighbour;
pub use prediction::{Anchor, InputFrames, WorldPrediction};
pub use ridge::Ridge;
