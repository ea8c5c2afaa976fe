//! The cost terms: one file each, one sorted list, one law that all obey.
//!
//! Adding a term: one file here with a struct that implements [`CostTerm`], its `pub mod` line, and its line in
//! the list `cost_terms!` below (name in recipes, meaning, weights). Terms from elsewhere (plugins) are handed to
//! [`crate::muco::plan_with_terms`] and are the same thing to the solver.

pub mod altitude;
pub mod jerk;
pub mod length;
pub mod pitch;
pub mod safety;
pub mod smoothness;
pub mod tracking;
pub mod viewpoint;
pub mod visibility;

use crate::config::ViewConfig;
use crate::equations::NormalEquations;
use crate::obstacles::Surroundings;
use crate::walk::Walk;
use crate::weights::{Preset, cost_terms};
use cosfly_frames::{DVec3, TargetTrack};

/// What terms may look at beside the waypoints.
pub struct TermContext<'a> {
    /// The target that is followed.
    pub track: &'a TargetTrack,
    /// Where the drone should be.
    pub view: &'a ViewConfig,
    /// Walking directions and their steadiness.
    pub walk: &'a Walk,
    /// Obstacles and ground.
    pub surroundings: &'a dyn Surroundings,
}

/// A named cost of a whole flight, frame by frame. The weight lives outside.
pub trait CostTerm: Send + Sync {
    /// Name in recipes, such as `visibility`.
    fn name(&self) -> &str;

    /// How many neighbours on each side the cost of a frame reads; 0 when only its own waypoint.
    fn support(&self) -> usize;

    /// Told before the first cost on a track, for terms that keep something per track.
    fn begin(&self, context: &TermContext<'_>) {
        let _ = context;
    }

    /// Writes the cost of every frame; `per_frame` is as long as `waypoints` (world frame, metres).
    fn cost(&self, waypoints: &[DVec3], context: &TermContext<'_>, per_frame: &mut [f64]);

    /// Adds `weight` times the gradient of the summed cost, when the term knows it; otherwise returns false
    /// and the solver takes differences of [`Self::cost`].
    fn add_gradient(
        &self,
        waypoints: &[DVec3],
        context: &TermContext<'_>,
        weight: f64,
        gradient: &mut [DVec3],
    ) -> bool {
        let _ = (waypoints, context, weight, gradient);
        false
    }

    /// Adds `weight` times the cost, as squares of residuals linear around `waypoints`, to the Gauss-Newton equations,
    /// when the term knows such a form; otherwise returns false and its gradient (its own or differences) is added.
    fn add_residuals(
        &self,
        waypoints: &[DVec3],
        context: &TermContext<'_>,
        weight: f64,
        equations: &mut NormalEquations,
    ) -> bool {
        let _ = (waypoints, context, weight, equations);
        false
    }
}

/// A term and its weight in a flight's cost.
pub struct WeightedTerm {
    /// The term.
    pub term: Box<dyn CostTerm>,
    /// Its weight, at least 0.
    pub weight: f64,
}

// The terms of the paper, in the order of its equation, with their weights in `cosfly` (and its kin `rear` and `short`) and `paper`.
cost_terms! {
    /// Distance from the best observation distance (lambda 1); cosfly 0.05, paper 1.
    tracking: tracking::Tracking, cosfly 0.05, paper 1.0;
    /// Acceleration (lambda 2); 0.5 in all presets.
    smoothness: smoothness::Smoothness, cosfly 0.5, paper 0.5;
    /// Jerk (lambda 3); 0.3 in all presets.
    jerk: jerk::Jerk, cosfly 0.3, paper 0.3;
    /// Nearness of obstacles (lambda 4); 2 in all presets.
    safety: safety::Safety, cosfly 2.0, paper 2.0;
    /// Hidden body points (lambda 5); cosfly 60, paper 3.
    visibility: visibility::Visibility, cosfly 60.0, paper 3.0;
    /// Not being behind the walker (lambda 6); cosfly 0.3, paper 1.
    viewpoint: viewpoint::Viewpoint, cosfly 0.3, paper 1.0;
    /// Pitch away from the target pitch (lambda 7); cosfly 0.1, paper 0.5.
    pitch: pitch::Pitch, cosfly 0.1, paper 0.5;
    /// Altitude out of its band, and its oscillation (lambda 8); 1 in all presets.
    altitude: altitude::Altitude, cosfly 1.0, paper 1.0;
    /// Length of the flight (lambda 9); 0.1 in all presets.
    length: length::Length, cosfly 0.1, paper 0.1;
}

#[cfg(test)]
mod law;
