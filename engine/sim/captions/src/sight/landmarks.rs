//! Things of a town that a text may name: trees, street lamps, traffic lights and signs, parked cars, buildings, crossings.

use super::crossings::Crossing;
use cosfly_domain::{Obstacle, ObstacleKind, OrientedBox, Town, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3, real};
use cosfly_geometry::{BoxBvh, SpatialQuery};

/// Kind of a landmark. Things of other kinds have no name that everybody would give them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the names say it")]
pub enum LandmarkKind {
    TrafficLight,
    Lamp,
    TrafficSign,
    Tree,
    Car,
    Building,
}

impl LandmarkKind {
    /// All kinds; texts prefer the first.
    pub const ALL: [Self; 6] =
        [Self::TrafficLight, Self::Lamp, Self::TrafficSign, Self::Tree, Self::Car, Self::Building];

    /// The landmark that an obstacle is.
    pub(crate) fn of(kind: ObstacleKind) -> Option<Self> {
        match kind {
            ObstacleKind::TrafficLight => Some(Self::TrafficLight),
            ObstacleKind::Lamp => Some(Self::Lamp),
            ObstacleKind::TrafficSign => Some(Self::TrafficSign),
            ObstacleKind::TreeTrunk => Some(Self::Tree),
            ObstacleKind::Car => Some(Self::Car),
            ObstacleKind::Building => Some(Self::Building),
            _ => None,
        }
    }
}

/// The boxes of a town, which of them are landmarks, and its crossings.
pub struct Landmarks {
    boxes: BoxBvh,
    /// Object and kind of every box. A crown belongs to its tree, whose place is that of the trunk.
    parts: Vec<(u32, ObstacleKind)>,
    /// Pairs of an object and one of its boxes, in order.
    objects: Vec<(u32, u32)>,
    crossings: Vec<Crossing>,
}

impl Default for Landmarks {
    fn default() -> Self {
        Self::among(&[], &[])
    }
}

impl std::fmt::Debug for Landmarks {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "Landmarks of {} boxes", self.parts.len())
    }
}

impl Landmarks {
    /// The landmarks of a town.
    pub fn of(town: &Town) -> Self {
        Self::among(&town.obstacles, &town.walkable)
    }

    /// The landmarks among obstacles and walkable ground.
    pub fn among(obstacles: &[Obstacle], walkable: &[WalkablePolygon]) -> Self {
        let parts = obstacles.iter().map(|it| (it.object_id, it.kind)).collect();
        let mut objects: Vec<(u32, u32)> =
            obstacles.iter().zip(0..).map(|(it, number)| (it.object_id, number)).collect();
        objects.sort_unstable();
        let boxes = BoxBvh::build(obstacles.iter().map(|it| it.shape).collect());
        Self { boxes, parts, objects, crossings: Crossing::all(walkable) }
    }

    /// Landmarks whose box comes within `reach_m` of a point along x, y or z: kind, object and box, in the order of the town.
    pub(crate) fn around(&self, point: DVec3, reach_m: f64) -> Vec<(LandmarkKind, u32, &OrientedBox)> {
        let mut found = vec![];
        let reach = DVec3::splat(reach_m);
        self.boxes.within(point - reach, point + reach, &mut |number| found.push(number));
        found.sort_unstable();
        let landmark = |number: u32| {
            let (object, kind) = self.parts[number as usize];
            LandmarkKind::of(kind).map(|kind| (kind, object, &self.boxes.boxes()[number as usize]))
        };
        found.into_iter().filter_map(landmark).collect()
    }

    /// Crossings within about `reach_m` of any of the points.
    pub fn crossings_near(&self, points: &[DVec3], reach_m: f64) -> Vec<&Crossing> {
        Crossing::near(&self.crossings, points, reach_m)
    }

    /// The first box on the way from one point to another: its kind, its object and the point that is hit.
    pub(super) fn first_between(&self, from: DVec3, to: DVec3) -> Option<(Option<LandmarkKind>, u32, DVec3)> {
        let hit = self.boxes.closest_hit(from, to - from, 1.0)?;
        let (object, kind) = self.parts[hit.primitive as usize];
        Some((LandmarkKind::of(kind), object, from + hit.t * (to - from)))
    }

    /// Kind of the first box of an object; `None` where there is no such object.
    pub fn kind_of(&self, object: u32) -> Option<ObstacleKind> {
        let first = self.objects.get(self.objects.partition_point(|(it, _)| *it < object))?;
        (first.0 == object).then(|| self.parts[first.1 as usize].1)
    }

    /// Boxes of an object.
    pub(super) fn boxes_of(&self, object: u32) -> impl Iterator<Item = &OrientedBox> {
        let first = self.objects.partition_point(|(it, _)| *it < object);
        let of_object = self.objects[first..].iter().take_while(move |(it, _)| *it == object);
        of_object.map(|(_, number)| &self.boxes.boxes()[*number as usize])
    }
}

/// The way along the ground from a point to the nearest point of a box's footprint, metres.
pub(crate) fn way_to(shape: &OrientedBox, point: DVec3) -> DVec2 {
    let (sin, cos) = real::sin_cos(shape.yaw_rad);
    let from_center = (point - shape.center_in_world).truncate();
    let own = DVec2::new(cos * from_center.x + sin * from_center.y, cos * from_center.y - sin * from_center.x);
    let half = shape.half_extents_m.truncate();
    let to = own.clamp(-half, half) - own;
    DVec2::new(cos * to.x - sin * to.y, sin * to.x + cos * to.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_lead_to_the_footprint_of_a_turned_box() {
        let shape = OrientedBox {
            center_in_world: DVec3::new(10.0, 0.0, 5.0),
            half_extents_m: DVec3::new(3.0, 1.0, 5.0),
            yaw_rad: std::f64::consts::FRAC_PI_2,
        };
        assert!((way_to(&shape, DVec3::ZERO) - DVec2::new(9.0, 0.0)).length() < 1e-12);
        assert!((way_to(&shape, DVec3::new(10.0, 5.0, 0.0)) - DVec2::new(0.0, -2.0)).length() < 1e-12);
        assert_eq!(way_to(&shape, DVec3::new(10.5, 1.0, 0.0)), DVec2::ZERO);
    }
}
