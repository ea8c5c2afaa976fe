//! What a tree needs to know of the shapes in it; a new shape is one file that answers these.

use crate::bounds::Bounds;
use cosfly_frames::DVec3;

/// A shape made ready for queries.
pub trait Shape: Copy + Send + Sync {
    /// Form in which callers give the shape.
    type Given: Copy + Send + Sync;

    /// Computes once what queries need; `None` when a number is not finite.
    fn prepare(given: &Self::Given) -> Option<Self>;

    /// Smallest axis-aligned bounds.
    fn bounds(&self) -> Bounds;

    /// The smallest `0 <= t <= max_t` at which `origin + t * direction` is on or in the closed shape.
    fn ray_entry(&self, origin_in_world: DVec3, direction_in_world: DVec3, max_t: f64) -> Option<f64>;

    /// Distance of a point, negative inside a solid, and the unit vector in which it grows fastest.
    fn signed_distance(&self, point_in_world: DVec3) -> (f64, DVec3);

    /// Exact distance of a segment, 0 when they touch; `None` when it is at least `within_m`.
    fn segment_distance(&self, from_in_world: DVec3, to_in_world: DVec3, within_m: f64) -> Option<f64>;
}
