//! The cost terms: one file each, one sorted list, one law that all obey.
//!
//! Adding a term: one file here with a struct that implements [`CostTerm`], a `pub mod` line, and a line in
//! [`built_in_terms`] with its weight. Terms from elsewhere (plugins) are handed to
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
use crate::obstacles::Surroundings;
use crate::walk::Walk;
use crate::weights::Weights;
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
}

/// A term and its weight in a flight's cost.
pub struct WeightedTerm {
    /// The term.
    pub term: Box<dyn CostTerm>,
    /// Its weight, at least 0.
    pub weight: f64,
}

/// The nine terms of the paper, in the order of its equation.
pub fn built_in_terms(weights: &Weights) -> Vec<WeightedTerm> {
    fn weighted(term: impl CostTerm + 'static, weight: f64) -> WeightedTerm {
        WeightedTerm { term: Box::new(term), weight }
    }
    vec![
        weighted(tracking::Tracking, weights.tracking),
        weighted(smoothness::Smoothness, weights.smoothness),
        weighted(jerk::Jerk, weights.jerk),
        weighted(safety::Safety, weights.safety),
        weighted(visibility::Visibility, weights.visibility),
        weighted(viewpoint::Viewpoint, weights.viewpoint),
        weighted(pitch::Pitch, weights.pitch),
        weighted(altitude::Altitude, weights.altitude),
        weighted(length::Length, weights.length),
    ]
}

#[cfg(test)]
mod law;
