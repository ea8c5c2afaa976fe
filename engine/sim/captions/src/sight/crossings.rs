//! Marked crossings of a town, where people cross its streets.

use cosfly_domain::{WalkableKind, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::polygons;

/// Feet that are farther above or below a crossing are not on it, metres.
const LEVEL_M: f64 = 1.5;

/// Ground of a marked crossing.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossing {
    /// Number among the crossings of its town, from 0.
    pub number: u32,
    /// Corners in order.
    pub outline_in_world: Vec<DVec3>,
}

impl Crossing {
    /// All crossings among the walkable ground of a town.
    pub(super) fn all(walkable: &[WalkablePolygon]) -> Vec<Self> {
        let outlines = walkable.iter().filter(|it| it.kind == WalkableKind::Crossing).map(|it| &it.outline_in_world);
        (0..).zip(outlines).map(|(number, outline)| Self { number, outline_in_world: outline.clone() }).collect()
    }

    /// Whether feet at a point stand on it.
    pub(crate) fn holds(&self, point: DVec3) -> bool {
        let outline = &self.outline_in_world;
        let plan: Vec<DVec2> = outline.iter().map(|corner| corner.truncate()).collect();
        let height_m = outline.iter().map(|corner| corner.z).sum::<f64>() / outline.len().max(1) as f64;
        (point.z - height_m).abs() <= LEVEL_M && polygons::contains(&plan, point.truncate())
    }

    /// Whether a box around it, widened by `reach_m`, contains a point.
    fn is_around(&self, point: DVec3, reach_m: f64) -> bool {
        let low = self.outline_in_world.iter().copied().fold(DVec3::INFINITY, DVec3::min) - reach_m;
        let high = self.outline_in_world.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max) + reach_m;
        point.cmpge(low).all() && point.cmple(high).all()
    }

    /// Those of some crossings that come within about `reach_m` of any of the points.
    pub(super) fn near<'a>(all: &'a [Self], points: &[DVec3], reach_m: f64) -> Vec<&'a Self> {
        all.iter().filter(|it| points.iter().any(|point| it.is_around(*point, reach_m))).collect()
    }
}
