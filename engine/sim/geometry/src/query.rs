//! The query interface: rays, nearest obstacle, swept segments. All points in the world frame, metres.

use cosfly_frames::DVec3;

/// First hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Parameter along the ray, in lengths of its direction vector; 0 when the ray starts inside a solid.
    pub t: f64,
    /// Index of the primitive that was hit, in the order given when the structure was built.
    pub primitive: u32,
}

/// Obstacle closest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Distance to the surface, metres; negative inside a solid (depth to the closest face).
    pub distance_m: f64,
    /// Unit vector in which the distance grows fastest (away from the obstacle, also from inside).
    pub away_in_world: DVec3,
    /// Index of the primitive.
    pub primitive: u32,
}

/// Rays, distances and swept spheres against a set of primitives. One test compares every implementation with brute
/// force.
///
/// Points that are not finite get safe answers: nothing is hit or near, but segments are blocked and have no clearance.
/// Among equal primitives the one with the smallest index is returned.
pub trait SpatialQuery: Send + Sync {
    /// Number of primitives.
    fn len(&self) -> usize;

    /// Whether there are no primitives.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// First hit of the ray `origin + t * direction` with `0 <= t <= max_t`.
    fn closest_hit(&self, origin_in_world: DVec3, direction_in_world: DVec3, max_t: f64) -> Option<Hit>;

    /// Whether a primitive lies between two points (both ends included).
    fn blocked(&self, from_in_world: DVec3, to_in_world: DVec3) -> bool;

    /// Primitive with the smallest signed distance, if that is below `within_m`.
    fn nearest(&self, point_in_world: DVec3, within_m: f64) -> Option<Nearest>;

    /// Smallest distance between the segment and any primitive, metres, capped at `within_m`; 0 or less when they
    /// touch. A sphere of radius r swept along the segment is free exactly when this exceeds r.
    fn segment_clearance(&self, from_in_world: DVec3, to_in_world: DVec3, within_m: f64) -> f64;

    /// [`Self::blocked`] from one point to many.
    fn blocked_batch(&self, from_in_world: DVec3, to_in_world: &[DVec3], blocked: &mut [bool]) {
        for (to, out) in to_in_world.iter().zip(blocked) {
            *out = self.blocked(from_in_world, *to);
        }
    }

    /// Calls `visit` with every primitive whose bounds meet the axis-aligned box (`min`, `max`).
    fn within(&self, min_in_world: DVec3, max_in_world: DVec3, visit: &mut dyn FnMut(u32));
}
