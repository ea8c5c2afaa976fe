//! The cost terms: one file each, one sorted list, one law that all obey.
//!
//! Adding a term: one file here with a struct that implements [`CostTerm`], its `pub mod` line, and its line in
//! the list `cost_terms!` below (name in recipes, meaning, weights). Terms from elsewhere (plugins) are handed to
//! [`crate::plan_with_terms`] and are the same thing to the solver.

pub mod altitude;
pub mod jerk;
pub mod length;
pub mod pitch;
pub mod place;
pub mod safety;
pub mod smoothness;
pub mod term;
pub mod tracking;
pub mod viewpoint;
pub mod visibility;

use crate::weights::{Preset, cost_terms};

pub use term::{CostTerm, TermContext, WeightedTerm};

// The terms of the paper, in the order of its equation, with their weights in the presets: `rear`, `short` and
// `agile` have those of `cosfly` unless the line says otherwise.
cost_terms! {
    /// Distance from the best observation distance (lambda 1); cosfly 0.05, paper 1.
    tracking: tracking::Tracking, cosfly 0.05, paper 1.0;
    /// Acceleration (lambda 2); cosfly 300, agile and paper 0.5.
    smoothness: smoothness::Smoothness, cosfly 300.0, paper 0.5, agile 0.5;
    /// Jerk (lambda 3); cosfly 300, agile and paper 0.3.
    jerk: jerk::Jerk, cosfly 300.0, paper 0.3, agile 0.3;
    /// Nearness of obstacles (lambda 4); 2 in all presets.
    safety: safety::Safety, cosfly 2.0, paper 2.0;
    /// Hidden body points (lambda 5); cosfly 60, paper 3.
    visibility: visibility::Visibility, cosfly 60.0, paper 3.0;
    /// Not being behind the walker (lambda 6); cosfly 0.3, paper 1.
    viewpoint: viewpoint::Viewpoint, cosfly 0.3, paper 1.0, rear 30.0;
    /// Pitch away from the target pitch (lambda 7); cosfly 0.1, paper 0.5.
    pitch: pitch::Pitch, cosfly 0.1, paper 0.5;
    /// Altitude out of its band, and its oscillation (lambda 8); 1 in all presets.
    altitude: altitude::Altitude, cosfly 1.0, paper 1.0;
    /// Length of the flight (lambda 9); 0.1 in all presets.
    length: length::Length, cosfly 0.1, paper 0.1;
}

#[cfg(test)]
mod law;
