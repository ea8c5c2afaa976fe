//! Surroundings of a flight: the boxes near its path, the ground, others who move, queried frame by frame.
//!
//! [`Surroundings`] is what cost terms see. [`local::LocalObstacles`] answers from the planning boxes while
//! the solver runs; [`exact::ExactObstacles`] answers from the unsimplified map when the result is judged.

pub mod exact;
pub mod ground;
pub mod local;
pub mod moving;
pub mod solid;
mod targets;
pub mod visibility;

pub use targets::SeveralTargets;

use cosfly_frames::DVec3;

/// Visibility and distance around each frame's waypoint. World frame, metres.
pub trait Surroundings {
    /// Share of the target's body points at `frame` that a camera at `position` sees, 0..=1.
    fn visibility(&self, frame: usize, position: DVec3) -> f64;

    /// Signed distance to the nearest obstacle and the direction away from it, when below `within_m`.
    fn nearest(&self, frame: usize, position: DVec3, within_m: f64) -> Option<(f64, DVec3)>;

    /// For each of some body points near whose lines of sight from `position` a box stands: how far `position` is outside the
    /// deepest shadow (negative inside it), metres, and the direction in which that grows.
    fn shadows(&self, frame: usize, position: DVec3, each: &mut dyn FnMut(f64, DVec3)) {
        let _ = (frame, position, each);
    }

    /// Height of the ground at a place.
    fn ground_z_m(&self, x_m: f64, y_m: f64) -> f64;
}
