//! A cost term: its interface, what it reads, and its weight.

use crate::config::view::ViewConfig;
use crate::equations::NormalEquations;
use crate::walk::Walk;
use cosfly_frames::{DVec3, TargetTrack};
use cosfly_surroundings::Surroundings;

/// Everything that a term may read beside the waypoints.
pub struct TermContext<'a> {
    /// The target that is followed.
    pub track: &'a TargetTrack,
    /// Wanted position of the drone.
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

    /// Number of neighbours on each side that the cost of a frame reads; 0 for its own waypoint alone.
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
    /// Weight of the term, at least 0.
    pub weight: f64,
}
