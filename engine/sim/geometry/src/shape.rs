//! Interface of shapes for trees; a new shape is one file that implements it.

use crate::bounds::Bounds;
use cosfly_frames::DVec3;

/// A shape prepared for queries.
pub trait Shape: Copy + Send + Sync {
    /// The shape as callers give it.
    type Given: Copy + Send + Sync;

    /// Precomputes the data of queries; `None` when a number is not finite.
    fn prepare(given: &Self::Given) -> Option<Self>;

    /// Smallest axis-aligned bounds.
    fn bounds(&self) -> Bounds;

    /// Smallest `0 <= t <= max_t` at which `origin + t * direction` is on or in the closed shape.
    fn ray_entry(&self, origin_in_world: DVec3, direction_in_world: DVec3, max_t: f64) -> Option<f64>;

    /// Distance of a point, metres, negative inside a solid, and the unit vector in which it grows fastest.
    fn signed_distance(&self, point_in_world: DVec3) -> (f64, DVec3);

    /// Exact distance of a segment, metres, 0 when they touch; `None` when it is at least `within_m`.
    fn segment_distance(&self, from_in_world: DVec3, to_in_world: DVec3, within_m: f64) -> Option<f64>;
}
