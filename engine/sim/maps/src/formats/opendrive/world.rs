//! From the file's frame (right-handed, y north) to the world frame (CARLA's: y negated, near the origin).

use super::network::RoadNetwork;
use crate::MapOrigin;
use cosfly_frames::{DVec2, DVec3};

/// A network whose centre is farther from the origin than this is moved by whole metres.
const FAR_M: f64 = 10_000.0;

/// The shift between map and world.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WorldFromMap {
    /// See [`MapOrigin`].
    pub offset_m: DVec3,
}

impl WorldFromMap {
    /// Chosen from the reference lines of all roads.
    pub fn of(network: &RoadNetwork) -> Self {
        let mut low = DVec2::INFINITY;
        let mut high = DVec2::NEG_INFINITY;
        for element in network.roads.iter().flat_map(|road| &road.plan) {
            low = low.min(element.start.position_in_map);
            high = high.max(element.start.position_in_map);
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

    /// An angle counter-clockwise from x in the map as a yaw of the world.
    pub fn yaw_rad(&self, heading_in_map_rad: f64) -> f64 {
        cosfly_frames::real::wrap_angle_rad(-heading_in_map_rad)
    }

    /// For [`crate::Town::origin`].
    pub fn origin(&self, geo_reference: Option<String>) -> MapOrigin {
        MapOrigin { offset_m: self.offset_m, geo_reference }
    }
}
