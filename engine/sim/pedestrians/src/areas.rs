//! [`AreaConfig`]: areas of a town where walks begin and lead to more or less often, and areas that nobody enters.

use crate::PedestrianConfigRule;
use crate::area_picture::{AreaPicture, PlacedPicture, is_light};
use crate::polygon::{Cut, Polygon};
use cosfly_domain::WalkableKind;
use cosfly_frames::{DVec2, DVec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Farthest corner from the origin of the world, metres, and most corners of an area.
const FARTHEST_M: f64 = 100_000.0;
const MOST_CORNERS: usize = 1000;

/// An area of the town: a polygon, or a grey picture with its place. Where areas overlap, the last one in the list decides;
/// ground outside all of them has weight 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AreaConfig {
    /// Corners of the outline in the world, in order: x, y, metres. Not beside `picture`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    pub polygon_m: Vec<[f64; 2]>,
    /// Grey PNG file that is the area, absolute or relative to the recipe: white has the whole `weight`, black none. Default none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub picture: Option<String>,
    /// Place of the picture's upper left corner in the world: x, y, metres. Default none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min_m: Option<[f64; 2]>,
    /// Place of the picture's lower right corner in the world: x, y, metres. Default none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_m: Option<[f64; 2]>,
    /// How often walks begin and have goals on a square metre of the area. 0: never, but people pass through. Default 1.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub weight: f64,
    /// Whether nobody sets foot in the area, whatever other areas say; of a picture, in its light half. Default false.
    #[serde(default)]
    pub closed: bool,
    /// Pixels of the picture, read from its file. Without them the area changes nothing.
    #[serde(skip)]
    pub pixels: Option<Arc<AreaPicture>>,
}

fn one() -> f64 {
    1.0
}

impl Default for AreaConfig {
    fn default() -> Self {
        Self { polygon_m: vec![], picture: None, min_m: None, max_m: None, weight: 1.0, closed: false, pixels: None }
    }
}

impl AreaConfig {
    /// Checks what callers without a schema may get wrong.
    pub(crate) fn check(areas: &[Self]) -> Result<(), PedestrianConfigRule> {
        for (number, area) in areas.iter().enumerate() {
            let refused = |message| Err(PedestrianConfigRule { path: vec!["areas"], message });
            let corners = area.polygon_m.len();
            match (&area.picture, area.min_m, area.max_m) {
                (None, None, None) if (3..=MOST_CORNERS).contains(&corners) => {}
                (None, None, None) => {
                    let rule = format!("it must have 3 to {MOST_CORNERS}, or a `picture`");
                    return refused(format!("area {number} has {corners} corners; {rule}"));
                }
                (Some(_), Some(min), Some(max)) if corners == 0 => {
                    if let Some(axis) = (0..2).find(|axis| max[*axis] <= min[*axis]) {
                        let (name, min, max) = (["x", "y"][axis], min[axis], max[axis]);
                        let message = format!(
                            "`max_m` of area {number} has {name} `{max}`; it must be above `{min}`, that of `min_m`"
                        );
                        return refused(message);
                    }
                }
                _ => {
                    let rule =
                        "it must have `polygon_m`, or `picture` with `min_m` and `max_m`, and no key of the other";
                    return refused(format!("area {number} is neither a polygon nor a picture: {rule}"));
                }
            }
            let is_far = |place: &f64| !(-FARTHEST_M..=FARTHEST_M).contains(place);
            let corners = area.polygon_m.iter().chain(&area.min_m).chain(&area.max_m);
            if let Some(place) = corners.flatten().find(|place| is_far(place)) {
                return refused(format!(
                    "area {number} has a corner at `{place}`; corners must be within `{FARTHEST_M}` m of the origin"
                ));
            }
            if !(0.0..=1000.0).contains(&area.weight) {
                let weight = area.weight;
                return refused(format!("area {number} has the weight `{weight}`; it must be within `0` and `1000`"));
            }
        }
        Ok(())
    }

    fn shape(&self) -> Option<Shape> {
        if let (Some(pixels), Some(min_m), Some(max_m)) = (&self.pixels, self.min_m, self.max_m) {
            return Some(Shape::Picture(PlacedPicture::new(Arc::clone(pixels), min_m, max_m)));
        }
        let corners = self.polygon_m.iter().map(|[x, y]| DVec3::new(*x, *y, 0.0)).collect();
        Polygon::new(WalkableKind::Plaza, corners).map(Shape::Polygon)
    }
}

/// Form of an area.
#[derive(Clone, Debug)]
enum Shape {
    Polygon(Polygon),
    Picture(PlacedPicture),
}

/// Areas that nobody enters.
#[derive(Clone, Debug, Default)]
pub(crate) struct Closed(Vec<Shape>);

impl Closed {
    pub fn new(areas: &[AreaConfig]) -> Self {
        Self(areas.iter().filter(|area| area.closed).filter_map(AreaConfig::shape).collect())
    }

    pub fn contains(&self, point: DVec2) -> bool {
        let mut cut = Cut::default();
        self.0.iter().any(|area| match area {
            Shape::Polygon(outline) => outline.height_at(point, &mut cut).is_some(),
            Shape::Picture(picture) => picture.grey_at(point).is_some_and(is_light),
        })
    }

    /// Whether a part of the straight step lies in one of the areas.
    pub fn meets(&self, from: DVec2, to: DVec2) -> bool {
        if self.0.is_empty() {
            return false;
        }
        let length = (to - from).length();
        let direction = if length > 0.0 { (to - from) / length } else { DVec2::X };
        let mut cut = Cut::default();
        self.0.iter().any(|area| match area {
            Shape::Polygon(outline) => {
                outline.cut_by_line(from, direction, &mut cut);
                cut.intervals.iter().any(|inside| inside.to >= 0.0 && inside.from <= length)
            }
            Shape::Picture(picture) => picture.light_meets(from, to),
        })
    }

    /// Calls `visit` with the ends of the edges of all areas, in plan.
    pub fn visit_edges(&self, visit: &mut dyn FnMut(DVec2, DVec2)) {
        for area in &self.0 {
            match area {
                Shape::Polygon(outline) => outline.edges().for_each(|(from, to)| visit(from.truncate(), to.truncate())),
                Shape::Picture(picture) => picture.visit_light_edges(visit),
            }
        }
    }
}

/// Weights of the ground for starts and goals.
#[derive(Clone, Debug, Default)]
pub(crate) struct Weights {
    areas: Vec<(Shape, f64)>,
    /// Largest weight of any ground.
    pub largest: f64,
}

impl Weights {
    pub fn new(areas: &[AreaConfig]) -> Self {
        // A closed picture says nothing of the ground that it leaves open.
        let says = |area: &&AreaConfig| !(area.closed && area.picture.is_some());
        let weighted = |area: &AreaConfig| area.shape().map(|shape| (shape, area.weight));
        let areas: Vec<_> = areas.iter().filter(says).filter_map(weighted).collect();
        let largest = areas.iter().map(|area| area.1).fold(1.0, f64::max);
        Self { areas, largest }
    }

    /// Whether all ground has one weight.
    pub fn are_one(&self) -> bool {
        self.areas.is_empty()
    }

    /// Weight of the ground at a point.
    pub fn at(&self, point: DVec2) -> f64 {
        self.of_areas_at(point).unwrap_or(1.0)
    }

    fn of_areas_at(&self, point: DVec2) -> Option<f64> {
        let mut cut = Cut::default();
        let in_area = |(shape, weight): &(Shape, f64)| match shape {
            Shape::Polygon(outline) => outline.height_at(point, &mut cut).map(|_| *weight),
            Shape::Picture(picture) => picture.grey_at(point).map(|grey| weight * f64::from(grey) / 255.0),
        };
        self.areas.iter().rev().find_map(in_area)
    }
}

/// Weights of areas at each place of a town, for drawings.
pub struct AreaMap(Closed, Weights);

impl AreaMap {
    /// The map of areas whose pictures have their pixels.
    pub fn new(areas: &[AreaConfig]) -> Self {
        Self(Closed::new(areas), Weights::new(areas))
    }

    /// Weight for starts and goals as a share of the largest one, and whether nobody goes there; `None` outside of all areas.
    pub fn at(&self, point: DVec2) -> Option<(f64, bool)> {
        let Self(closed, weights) = self;
        let share = weights.of_areas_at(point).map(|weight| weight / weights.largest);
        if closed.contains(point) { Some((0.0, true)) } else { Some((share?, false)) }
    }
}
