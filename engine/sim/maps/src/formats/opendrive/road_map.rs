//! [`RoadMap`]: a road network that answers questions about lanes.

use super::document::with_source;
use super::network::RoadNetwork;
use super::parse_road;
use cosfly_frames::DVec3;
use cosfly_town::MapError;
use cosfly_town::world::WorldFromMap;

/// A parsed road network in the world frame; answers questions about lanes.
#[derive(Clone, Debug, PartialEq)]
pub struct RoadMap {
    /// The network, in the file's frame.
    pub network: RoadNetwork,
    /// From the file's frame to the world.
    pub world: WorldFromMap,
}

/// The middle of a lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LanePoint {
    /// World frame, metres.
    pub position_in_world: DVec3,
    /// Yaw in the world frame of the direction in which s grows, radians: the road's, turned by `drift`.
    pub yaw_rad: f64,
    /// Sideways movement of the lane's middle for each metre of the road (to the left).
    pub drift: f64,
    /// Width of the lane, metres.
    pub width_m: f64,
}

impl RoadMap {
    /// Reads the network only; the second value holds warnings.
    pub fn read(bytes: &[u8]) -> Result<(Self, Vec<String>), MapError> {
        with_source(bytes, |source, _| {
            let network = parse_road::network(source)?;
            let world = WorldFromMap::around(network.plan_points());
            Ok(Self { network, world })
        })
    }

    /// The middle of lane `lane_id` of road `road_id` at `s_m`; `None` when there is no such road or lane.
    pub fn lane_point(&self, road_id: &str, lane_id: i32, s_m: f64) -> Option<LanePoint> {
        let road = self.network.roads.iter().find(|road| road.id == road_id)?;
        let (position_in_map, heading_rad, drift, width_m) = road.lane_middle(lane_id, s_m)?;
        let position_in_world = self.world.point(position_in_map);
        Some(LanePoint { position_in_world, yaw_rad: self.world.yaw_rad(heading_rad), drift, width_m })
    }
}
