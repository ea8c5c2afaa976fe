//! From a map's frame (right-handed, x east, y north, z up) to the world frame (CARLA's: y negated, near the origin).

use cosfly_domain::MapOrigin;
use cosfly_frames::{DVec2, DVec3, real};

/// A map whose centre is farther from its origin than this is moved by whole metres.
const FAR_M: f64 = 10_000.0;

/// Shift between map and world.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WorldFromMap {
    /// See [`MapOrigin`].
    pub offset_m: DVec3,
}

impl WorldFromMap {
    /// Shift for a map of these points, map frame, metres: their middle decides.
    pub fn around(points_in_map: impl IntoIterator<Item = DVec2>) -> Self {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for point in points_in_map {
            low = low.min(point);
            high = high.max(point);
        }
        let center = 0.5 * (low + high);
        if center.is_finite() && center.length() > FAR_M {
            Self { offset_m: DVec3::new(center.x.round(), -center.y.round(), 0.0) }
        } else {
            Self::default()
        }
    }

    /// A point of the map in the world.
    pub fn point(&self, point_in_map: DVec3) -> DVec3 {
        DVec3::new(point_in_map.x, -point_in_map.y, point_in_map.z) - self.offset_m
    }

    /// An angle counter-clockwise from x in the map as a yaw of the world, radians.
    pub fn yaw_rad(&self, heading_in_map_rad: f64) -> f64 {
        real::wrap_angle_rad(-heading_in_map_rad)
    }

    /// The shift for [`cosfly_domain::Town::origin`], with the map's projection text.
    pub fn origin(&self, geo_reference: Option<String>) -> MapOrigin {
        MapOrigin { offset_m: self.offset_m, geo_reference, ..MapOrigin::default() }
    }
}
