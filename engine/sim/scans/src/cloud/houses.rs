//! [`Houses`]: which house a narrow thing is on.

use cosfly_domain::{Obstacle, ObstacleKind, OrientedBox};
use cosfly_geometry::{BoxBvh, SpatialQuery};

/// Largest distance of the middle of a box from a house, and largest half of its narrow side, of things on a wall: balconies, pipes,
/// creepers; metres.
const ON_WALL_M: f64 = 1.0;
const HALF_WIDTH_ON_WALL_M: f64 = 1.25;

/// Boxes of buildings, and the thing that each belongs to.
pub(super) struct Houses {
    boxes: BoxBvh,
    things: Vec<u32>,
}

impl Houses {
    /// The houses among obstacles.
    pub(super) fn of(obstacles: &[Obstacle]) -> Self {
        let houses = || obstacles.iter().filter(|one| one.kind == ObstacleKind::Building);
        let boxes = BoxBvh::build(houses().map(|one| one.shape).collect());
        Self { boxes, things: houses().map(|one| one.object_id).collect() }
    }

    /// The house on whose wall all boxes of a thing are.
    pub(super) fn behind(&self, thing: &[OrientedBox]) -> Option<u32> {
        let house_of = |shape: &OrientedBox| {
            let is_narrow = shape.half_extents_m.truncate().min_element() <= HALF_WIDTH_ON_WALL_M;
            let house = self.boxes.nearest(shape.center_in_world, ON_WALL_M)?;
            is_narrow.then(|| self.things[house.primitive as usize])
        };
        let (first, rest) = thing.split_first()?;
        rest.iter().all(|shape| house_of(shape).is_some()).then(|| house_of(first)).flatten()
    }
}
