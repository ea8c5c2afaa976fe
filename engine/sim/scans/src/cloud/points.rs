//! [`Cloud`]: measured points as the town's builder takes them, whatever file they come from.

use crate::up_axis::UpAxis;
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::MapError;
use cosfly_town::world::WorldFromMap;
use rayon::prelude::*;

/// Classes of the ASPRS standard that the builder knows.
pub mod class {
    /// Not classified.
    pub const UNCLASSIFIED: u8 = 1;
    /// Bare ground.
    pub const GROUND: u8 = 2;
    /// Low, medium and high plants.
    pub const PLANTS: std::ops::RangeInclusive<u8> = 3..=5;
    /// High plants.
    pub const HIGH_PLANTS: u8 = 5;
    /// Buildings.
    pub const BUILDING: u8 = 6;
    /// Points that are too low to be anything.
    pub const LOW_NOISE: u8 = 7;
    /// Water.
    pub const WATER: u8 = 9;
    /// Surface of a road.
    pub const ROAD: u8 = 11;
    /// Deck of a bridge.
    pub const BRIDGE: u8 = 17;
    /// Points that are too high to be anything.
    pub const HIGH_NOISE: u8 = 18;
}

/// Advice on coordinates in degrees.
pub const PROJECT_FIRST: &str =
    "project the cloud first, for instance with `pdal translate` and `filters.reprojection`";
/// Narrower clouds may be in degrees.
const NARROWEST: f64 = 2.0;
/// Widest cloud, metres.
const WIDEST_M: f64 = 20_000.0;
/// Largest coordinate, metres.
const FARTHEST_M: f64 = 1e8;
/// Largest height of a point, metres.
const HIGHEST_M: f64 = 1e5;

/// Points in the world frame, metres.
#[derive(Clone, Debug, Default)]
pub struct Cloud {
    /// Place of the points' origin in the world, metres.
    origin_in_world: DVec3,
    /// Positions from the origin, axes of the world, metres.
    pub(super) positions: Vec<[f32; 3]>,
    /// Class of each point.
    pub classes: Vec<u8>,
    /// Smallest and largest corner in plan, world, metres.
    pub bounds: [DVec2; 2],
    /// Shift between map and world.
    pub world: WorldFromMap,
    /// The file's projection, in its own words.
    pub geo_reference: Option<String>,
    /// Warnings for the user.
    pub warnings: Vec<String>,
}

/// Takes points one by one, in the file's own axes (right-handed), metres.
#[derive(Debug, Default)]
pub struct CloudBuilder {
    /// `z` where none is told.
    up_axis: Option<UpAxis>,
    origin_in_map: Option<DVec3>,
    positions: Vec<[f32; 3]>,
    classes: Vec<u8>,
    noise: usize,
    absurd: usize,
}

impl CloudBuilder {
    /// No points yet, of a file with this axis up; `z` by default.
    pub fn new(up_axis: Option<UpAxis>) -> Self {
        Self { up_axis, ..Self::default() }
    }

    /// Adds a point; noise and points that are nowhere are counted.
    pub fn push(&mut self, point_in_file: DVec3, class: u8) {
        let point_in_map = self.up_axis.unwrap_or(UpAxis::Z).in_map(point_in_file);
        let farthest = DVec3::new(FARTHEST_M, FARTHEST_M, HIGHEST_M);
        // Each number is compared: the largest of a vector passes over those that are none.
        if !point_in_map.abs().cmple(farthest).all() {
            self.absurd += 1;
            return;
        }
        if matches!(class, class::LOW_NOISE | class::HIGH_NOISE) {
            self.noise += 1;
            return;
        }
        let origin = *self.origin_in_map.get_or_insert_with(|| point_in_map.round());
        self.positions.push((point_in_map - origin).as_vec3().to_array());
        self.classes.push(class);
    }

    /// An empty builder for points that [`Self::join`] adds; none before the first point, from which all others count.
    pub fn sibling(&self) -> Option<Self> {
        self.origin_in_map.map(|origin| Self { origin_in_map: Some(origin), ..Self::new(self.up_axis) })
    }

    /// Adds the points of a sibling.
    pub fn join(&mut self, sibling: Self) {
        self.positions.extend(sibling.positions);
        self.classes.extend(sibling.classes);
        self.noise += sibling.noise;
        self.absurd += sibling.absurd;
    }

    /// The cloud in the world frame.
    ///
    /// # Errors
    /// No points, or points too far apart.
    pub fn finish(mut self, geo_reference: Option<String>, mut warnings: Vec<String>) -> Result<Cloud, MapError> {
        let Some(origin_in_map) = self.origin_in_map else {
            let dropped = self.noise + self.absurd;
            let message = format!("the cloud has no points ({dropped} are noise or have no finite coordinates)");
            return Err(MapError::new(message));
        };
        let none = || [DVec2::INFINITY, DVec2::NEG_INFINITY];
        let wider = |a: [DVec2; 2], b: [DVec2; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        let plan = self.positions.par_iter().map(|[x, y, _]| DVec2::new((*x).into(), (*y).into()));
        let bounds = plan.fold(none, |all, point| wider(all, [point; 2])).reduce(none, wider);
        let [low, high] = bounds.map(|corner| origin_in_map.truncate() + corner);
        let size = high - low;
        if size.max_element() > WIDEST_M {
            let message = format!("the cloud is {:.0} m across; at most {WIDEST_M} m are read", size.max_element());
            return Err(MapError::new(message)
                .hint("cut the cloud into tiles, or give the length of its unit with `options.unit_m`"));
        }
        self.refuse_degrees([low, high])?;
        if self.absurd > 0 {
            warnings.push(format!("{} points without finite coordinates on Earth were left out", self.absurd));
        }
        if self.noise > 0 {
            warnings.push(format!("{} points of the classes for noise (7, 18) were left out", self.noise));
        }
        let world = WorldFromMap::around([low, high]);
        self.positions.par_iter_mut().for_each(|position| position[1] = -position[1]);
        let origin_in_world = world.point(origin_in_map);
        let corners = [low, high].map(|corner| world.point(corner.extend(0.0)).truncate());
        let bounds = [corners[0].min(corners[1]), corners[0].max(corners[1])];
        Ok(Cloud {
            origin_in_world,
            positions: self.positions,
            classes: self.classes,
            bounds,
            world,
            geo_reference,
            warnings,
        })
    }
}

impl CloudBuilder {
    /// # Errors
    /// Coordinates that are degrees beside heights in metres: a cloud much higher than it is wide.
    fn refuse_degrees(&self, [low, high]: [DVec2; 2]) -> Result<(), MapError> {
        let across = (high - low).max_element();
        let far = low.abs().max(high.abs()).max_element();
        let heights = || self.positions.par_iter().map(|[.., z]| *z);
        let up = || heights().reduce(|| f32::NEG_INFINITY, f32::max) - heights().reduce(|| f32::INFINITY, f32::min);
        if across >= NARROWEST || far > 360.0 || f64::from(up()) < 2.0 * across.max(0.5) {
            return Ok(());
        }
        let message =
            format!("the cloud is {across:.5} across and {:.0} high: its coordinates seem to be degrees", up());
        Err(MapError::new(message).hint(PROJECT_FIRST))
    }
}

impl Cloud {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// A point in the world, metres.
    pub fn point(&self, index: usize) -> DVec3 {
        let [x, y, z] = self.positions[index];
        self.origin_in_world + DVec3::new(x.into(), y.into(), z.into())
    }

    /// All points in the world, metres.
    pub fn points(&self) -> impl Iterator<Item = DVec3> {
        (0..self.len()).map(|index| self.point(index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_with_one_coordinate_that_is_no_number_are_left_out() {
        let mut cloud = CloudBuilder::default();
        for (axis, odd) in [(0, f64::NAN), (1, f64::NAN), (2, f64::NAN), (0, 1.1e8), (1, -f64::INFINITY), (2, 2e5)] {
            let mut point = DVec3::new(3.0, 4.0, 5.0);
            point[axis] = odd;
            cloud.push(point, class::UNCLASSIFIED);
        }
        cloud.push(DVec3::new(1e8, -1e8, 1e5), class::UNCLASSIFIED);
        assert_eq!((cloud.absurd, cloud.positions.len()), (6, 1));
    }
}
