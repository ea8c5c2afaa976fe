//! [`AreaConfig`]: areas of a town where walks begin and lead to more or less often, and areas that nobody enters.

use crate::PedestrianConfigRule;
use crate::polygon::{Cut, Polygon};
use cosfly_domain::WalkableKind;
use cosfly_frames::{DVec2, DVec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Farthest corner from the origin of the world, metres, and most corners of an area.
const FARTHEST_M: f64 = 100_000.0;
const MOST_CORNERS: usize = 1000;

/// An area of the town. Where areas overlap, the last one in the list decides; ground outside all of them has weight 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AreaConfig {
    /// Corners of the outline in the world, in order: x, y, metres.
    #[schemars(length(min = 3, max = 1000))]
    pub polygon_m: Vec<[f64; 2]>,
    /// How often walks begin and have goals on a square metre of the area. 0: never, but people pass through. Default 1.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub weight: f64,
    /// Whether nobody sets foot in the area, whatever other areas say. Default false.
    #[serde(default)]
    pub closed: bool,
}

fn one() -> f64 {
    1.0
}

impl AreaConfig {
    /// Checks what callers without a schema may get wrong.
    pub(crate) fn check(areas: &[Self]) -> Result<(), PedestrianConfigRule> {
        for (number, area) in areas.iter().enumerate() {
            let refused = |message| Err(PedestrianConfigRule { path: vec!["areas"], message });
            let corners = area.polygon_m.len();
            if !(3..=MOST_CORNERS).contains(&corners) {
                return refused(format!("area {number} has {corners} corners; it must have 3 to {MOST_CORNERS}"));
            }
            let is_far = |place: &f64| !(-FARTHEST_M..=FARTHEST_M).contains(place);
            if let Some(place) = area.polygon_m.iter().flatten().find(|place| is_far(place)) {
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

    fn outline(&self) -> Option<Polygon> {
        let corners = self.polygon_m.iter().map(|[x, y]| DVec3::new(*x, *y, 0.0)).collect();
        Polygon::new(WalkableKind::Plaza, corners)
    }
}

/// Areas that nobody enters.
#[derive(Clone, Debug, Default)]
pub(crate) struct Closed(Vec<Polygon>);

impl Closed {
    pub fn new(areas: &[AreaConfig]) -> Self {
        Self(areas.iter().filter(|area| area.closed).filter_map(AreaConfig::outline).collect())
    }

    pub fn contains(&self, point: DVec2) -> bool {
        let mut cut = Cut::default();
        self.0.iter().any(|area| area.height_at(point, &mut cut).is_some())
    }

    /// Whether a part of the straight step lies in one of the areas.
    pub fn meets(&self, from: DVec2, to: DVec2) -> bool {
        if self.0.is_empty() {
            return false;
        }
        let length = (to - from).length();
        let direction = if length > 0.0 { (to - from) / length } else { DVec2::X };
        let mut cut = Cut::default();
        self.0.iter().any(|area| {
            area.cut_by_line(from, direction, &mut cut);
            cut.intervals.iter().any(|inside| inside.to >= 0.0 && inside.from <= length)
        })
    }

    /// Ends of the edges of all outlines, in plan.
    pub fn edges(&self) -> impl Iterator<Item = (DVec2, DVec2)> {
        self.0.iter().flat_map(Polygon::edges).map(|(from, to)| (from.truncate(), to.truncate()))
    }
}

/// Weights of the ground for starts and goals.
#[derive(Clone, Debug, Default)]
pub(crate) struct Weights {
    areas: Vec<(Polygon, f64)>,
    /// Largest weight of any ground.
    pub largest: f64,
}

impl Weights {
    pub fn new(areas: &[AreaConfig]) -> Self {
        let weighted = |area: &AreaConfig| area.outline().map(|outline| (outline, area.weight));
        let areas: Vec<_> = areas.iter().filter_map(weighted).collect();
        let largest = areas.iter().map(|area| area.1).fold(1.0, f64::max);
        Self { areas, largest }
    }

    /// Whether all ground has one weight.
    pub fn are_one(&self) -> bool {
        self.areas.is_empty()
    }

    /// Weight of the ground at a point.
    pub fn at(&self, point: DVec2) -> f64 {
        let mut cut = Cut::default();
        let last = self.areas.iter().rev().find(|(outline, _)| outline.height_at(point, &mut cut).is_some());
        last.map_or(1.0, |(_, weight)| *weight)
    }
}
