//! [`Place`]: the surroundings of a flight, ready for queries.

use cosfly_frames::DVec3;
use cosfly_geometry::{BoxBvh, OrientedBox, SpatialQuery};
use cosfly_town::{GroundIndex, Town};

/// The surroundings of a flight, ready for queries; shared by all episodes of a town.
pub struct Place {
    /// All unsimplified boxes.
    pub exact: BoxBvh,
    /// Boxes for planning.
    pub planning_boxes: Vec<OrientedBox>,
    ground: GroundIndex,
    lowest_m: f64,
}

impl Place {
    /// The surroundings in a town.
    pub fn new(town: &Town) -> Self {
        Self {
            exact: BoxBvh::build(town.obstacles.iter().map(|obstacle| obstacle.shape).collect()),
            planning_boxes: town.planning_boxes.clone(),
            ground: GroundIndex::new(town),
            lowest_m: town.min_in_world.z.min(0.0),
        }
    }

    /// Boxes on flat ground at height 0.
    pub fn on_flat_ground(boxes: Vec<OrientedBox>) -> Self {
        let ground = GroundIndex::of_surfaces(&[], |_| true);
        Self { exact: BoxBvh::build(boxes.clone()), planning_boxes: boxes, ground, lowest_m: 0.0 }
    }

    /// Height of the ground, metres; the town's lowest point (at most 0) where there is none.
    pub fn ground_m(&self, x: f64, y: f64) -> f64 {
        self.ground.ground_height_m(x, y).unwrap_or(self.lowest_m)
    }

    /// Whether a sphere that moves from one point to another touches a box or the ground at its end.
    pub fn collides(&self, from_in_world: DVec3, to_in_world: DVec3, radius_m: f64) -> bool {
        let above_m = to_in_world.z - self.ground_m(to_in_world.x, to_in_world.y);
        above_m < radius_m || self.exact.segment_clearance(from_in_world, to_in_world, radius_m) < radius_m
    }
}
