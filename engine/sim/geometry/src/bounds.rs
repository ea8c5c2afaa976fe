//! Axis-aligned bounds, the nodes of trees.

use cosfly_frames::DVec3;

/// A closed axis-aligned box between two corners, metres. [`Bounds::EMPTY`] contains nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest corner.
    pub min_in_world: DVec3,
    /// Largest corner.
    pub max_in_world: DVec3,
}

impl Bounds {
    /// Empty bounds: the neutral element of [`Bounds::union`].
    pub const EMPTY: Self = Self { min_in_world: DVec3::INFINITY, max_in_world: DVec3::NEG_INFINITY };

    /// Smallest bounds around two others.
    #[inline]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min_in_world: self.min_in_world.min(other.min_in_world),
            max_in_world: self.max_in_world.max(other.max_in_world),
        }
    }

    /// Smallest bounds around these and a point.
    #[inline]
    pub fn with_point(&self, point_in_world: DVec3) -> Self {
        Self {
            min_in_world: self.min_in_world.min(point_in_world),
            max_in_world: self.max_in_world.max(point_in_world),
        }
    }

    /// Bounds enlarged by `margin_m` on every side.
    #[inline]
    pub fn grown(&self, margin_m: f64) -> Self {
        let margin = DVec3::splat(margin_m);
        Self { min_in_world: self.min_in_world - margin, max_in_world: self.max_in_world + margin }
    }

    /// Whether both have a common point (faces included).
    #[inline]
    pub fn meets(&self, other: &Self) -> bool {
        self.min_in_world.cmple(other.max_in_world).all() && other.min_in_world.cmple(self.max_in_world).all()
    }

    /// Whether `other` lies inside (faces included).
    pub fn contains(&self, other: &Self) -> bool {
        self.min_in_world.cmple(other.min_in_world).all() && other.max_in_world.cmple(self.max_in_world).all()
    }

    /// Centre.
    #[inline]
    pub fn center_in_world(&self) -> DVec3 {
        0.5 * (self.min_in_world + self.max_in_world)
    }

    /// Half of the surface area, square metres; 0 when empty.
    #[inline]
    pub fn half_area_m2(&self) -> f64 {
        let size = (self.max_in_world - self.min_in_world).max(DVec3::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }

    /// Squared distance from a point, square metres; 0 inside.
    #[inline]
    pub fn distance_squared_m2(&self, point_in_world: DVec3) -> f64 {
        (self.min_in_world - point_in_world).max(point_in_world - self.max_in_world).max(DVec3::ZERO).length_squared()
    }
}

/// A ray with the inverse of its direction, for slab tests against many [`Bounds`].
#[derive(Clone, Copy, Debug)]
pub struct SlabRay {
    origin_in_world: DVec3,
    /// Inverse of the direction; a huge number where a component is 0, so that 0 * inf never occurs.
    inverse: DVec3,
}

impl SlabRay {
    /// Creates the ray `origin + t * direction`.
    #[inline]
    pub fn new(origin_in_world: DVec3, direction_in_world: DVec3) -> Self {
        let one_over = |d: f64| if d.abs() < 1e-250 { 1e250 } else { 1.0 / d };
        let inverse =
            DVec3::new(one_over(direction_in_world.x), one_over(direction_in_world.y), one_over(direction_in_world.z));
        Self { origin_in_world, inverse }
    }

    /// Smallest `0 <= t <= max_t` inside the bounds enlarged by `margin_m`, rounded down.
    #[inline]
    pub fn entry(&self, bounds: &Bounds, margin_m: f64, max_t: f64) -> Option<f64> {
        let margin = DVec3::splat(margin_m);
        let low = (bounds.min_in_world - margin - self.origin_in_world) * self.inverse;
        let high = (bounds.max_in_world + margin - self.origin_in_world) * self.inverse;
        let enter = low.min(high).max_element().max(0.0) * (1.0 - 1e-14);
        let leave = low.max(high).min_element().min(max_t) * (1.0 + 1e-14);
        (enter <= leave).then_some(enter)
    }
}
