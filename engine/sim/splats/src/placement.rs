//! Parameters of splats in a recipe, and their place in the world: up, scale, turn and origin, or two measured points.

use cosfly_frames::{DMat3, DVec2, DVec3, real};
use cosfly_scans::faces_and_plates::FacesAndPlates;
use cosfly_scans::up_axis::UpAxis;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A point that was measured in the splats and in the map.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ControlPoint {
    /// Its place in the file of splats.
    pub file: [f64; 3],
    /// Its place in the map's file: to the east, to the north and up, metres.
    pub map_m: [f64; 3],
}

/// A file of splats over the town of its map. Left out, its numbers are those of the map's file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SplatsConfig {
    /// Path of a `.ply`, `.spz` or `.splat` file, relative to the recipe.
    pub source: String,
    /// Axis of the file that points up: `y`, `-y` or `z`.
    pub up_axis: UpAxis,
    /// Length of the file's unit, metres, 0.0001 to 10,000. Default: 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0001, max = 10_000.0))]
    pub unit_m: Option<f64>,
    /// Turn about the vertical, degrees, counter-clockwise seen from above. Default: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -360, max = 360))]
    pub turn_deg: Option<f64>,
    /// Place of the file's origin in the map: to the east, to the north and up, metres. Default: the map's origin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub origin_m: Option<[f64; 3]>,
    /// Two points that were measured in both files, in the place of `unit_m`, `turn_deg` and `origin_m`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub points: Option<[ControlPoint; 2]>,
    /// Exposure of the splats beside that of people and vehicles, stops: 1 is twice the light, -4 to 4.
    #[serde(default)]
    #[schemars(range(min = -4, max = 4))]
    pub exposure_ev: f64,
    /// Whether small splats become fainter, as in Mip-Splatting: as the splats were trained.
    #[serde(default)]
    pub antialiased: bool,
    /// Licence of the scan and its owner, such as `CC BY 4.0, Ana Kos, https://example.org/street`: it stands on the dataset's card.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub license: Option<String>,
    /// Whether faces and number plates can be told in the scan: `none`, `removed` or `readable`; it stands on the dataset's card.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub faces_and_plates: Option<FacesAndPlates>,
}

/// Parameters that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SplatsProblem {
    /// The key.
    pub key: &'static str,
    /// The refused value and the violated rule.
    pub message: String,
    /// Allowed values.
    pub hint: &'static str,
}

/// Where a file's frame lies in the world (left-handed, y to the south): turned, mirrored, scaled and moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Axes of the file in the world, metres per unit.
    pub(crate) world_from_file: DMat3,
    file_from_world: DMat3,
    origin_in_world: DVec3,
}

/// Farthest place and coordinate.
const FARTHEST: f64 = 1e7;

impl SplatsConfig {
    /// A file whose numbers are those of the map's file.
    pub fn new(source: impl Into<String>, up_axis: UpAxis) -> Self {
        Self {
            source: source.into(),
            up_axis,
            unit_m: None,
            turn_deg: None,
            origin_m: None,
            points: None,
            exposure_ev: 0.0,
            antialiased: false,
            license: None,
            faces_and_plates: None,
        }
    }

    /// The place in a world whose origin lies at `world_origin_m`: what the town's reader takes off its map's points, world axes.
    ///
    /// # Errors
    /// Numbers out of range, measured points beside other keys, or points too near to each other.
    pub fn placement(&self, world_origin_m: DVec3) -> Result<Placement, SplatsProblem> {
        let problem = |key, message, hint| Err(SplatsProblem { key, message, hint });
        let (unit_m, turn_deg) = (self.unit_m.unwrap_or(1.0), self.turn_deg.unwrap_or(0.0));
        if !(0.0001..=10_000.0).contains(&unit_m) {
            return problem("unit_m", format!("the length is `{unit_m}`"), "0.0001 to 10,000 metres");
        }
        if !(-4.0..=4.0).contains(&self.exposure_ev) {
            return problem("exposure_ev", format!("the exposure is `{}`", self.exposure_ev), "-4 to 4 stops");
        }
        if !(-360.0..=360.0).contains(&turn_deg) {
            return problem("turn_deg", format!("the turn is `{turn_deg}`"), "-360 to 360 degrees");
        }
        let places = self.points.iter().flatten().flat_map(|point| [point.file, point.map_m]);
        if places.chain(self.origin_m).flatten().any(|value| !(-FARTHEST..=FARTHEST).contains(&value)) {
            let key = if self.points.is_some() { "points" } else { "origin_m" };
            return problem(key, "a number is out of range".to_owned(), "numbers from -10,000,000 to 10,000,000");
        }
        let Some(points) = self.points else {
            let origin = DVec3::from_array(self.origin_m.unwrap_or_default());
            return Ok(Placement::new(self.up_axis, (unit_m, turn_deg.to_radians()), origin, world_origin_m));
        };
        if self.unit_m.is_some() || self.turn_deg.is_some() || self.origin_m.is_some() {
            let message = "two measured points already say scale, turn and origin".to_owned();
            return problem("points", message, "leave out `unit_m`, `turn_deg` and `origin_m`, or `points`");
        }
        let [a, b] = points.map(|point| (self.up_axis.in_map(point.file.into()), DVec3::from_array(point.map_m)));
        let (of_file, of_map) = (b.0 - a.0, b.1 - a.1);
        let flat = |way: DVec3| DVec2::new(way.x, way.y).length();
        // The turn is that of the points in plan: they must lie beside each other, not above.
        if !(flat(of_file) > 0.1 * of_file.length() && flat(of_map) > 0.1 * of_map.length()) {
            let message = "the two points lie above each other, or are the same".to_owned();
            return problem("points", message, "measure two points far apart on the ground");
        }
        let unit_m = of_map.length() / of_file.length();
        if !(0.0001..=10_000.0).contains(&unit_m) {
            let message = format!("the file's unit would be {unit_m} metres");
            return problem("points", message, "a unit of 0.0001 to 10,000 metres");
        }
        let turn_rad = real::atan2(of_map.y, of_map.x) - real::atan2(of_file.y, of_file.x);
        let unplaced = Placement::new(self.up_axis, (unit_m, turn_rad), DVec3::ZERO, DVec3::ZERO);
        let middle = 0.5 * (DVec3::from_array(points[0].file) + DVec3::from_array(points[1].file));
        let there = unplaced.in_world(middle);
        let origin = 0.5 * (a.1 + b.1) - DVec3::new(there.x, -there.y, there.z);
        Ok(Placement::new(self.up_axis, (unit_m, turn_rad), origin, world_origin_m))
    }
}

impl Placement {
    fn new(up: UpAxis, (unit_m, turn_rad): (f64, f64), origin_in_map: DVec3, world_origin_m: DVec3) -> Self {
        let (sin, cos) = real::sin_cos(turn_rad);
        let in_world = |point: DVec3| DVec3::new(point.x, -point.y, point.z);
        let axis = |of_file: [f64; 3]| {
            let DVec3 { x, y, z } = up.in_map(of_file.into());
            unit_m * in_world(DVec3::new(x * cos - y * sin, x * sin + y * cos, z))
        };
        let world_from_file = DMat3::from_cols(axis([1.0, 0.0, 0.0]), axis([0.0, 1.0, 0.0]), axis([0.0, 0.0, 1.0]));
        let file_from_world = world_from_file.transpose() * (1.0 / (unit_m * unit_m));
        Self { world_from_file, file_from_world, origin_in_world: in_world(origin_in_map) - world_origin_m }
    }

    /// The place of a cloud whose splats count from a point of the file.
    #[must_use]
    pub fn counted_from(self, origin_in_file: [f64; 3]) -> Self {
        Self { origin_in_world: self.in_world(DVec3::from_array(origin_in_file)), ..self }
    }

    /// A point of the file in the world, metres.
    pub fn in_world(&self, point_in_file: DVec3) -> DVec3 {
        self.world_from_file * point_in_file + self.origin_in_world
    }

    /// A point of the world in the file.
    pub fn in_file(&self, point_in_world: DVec3) -> DVec3 {
        self.file_from_world * (point_in_world - self.origin_in_world)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain() -> SplatsConfig {
        SplatsConfig::new("street.ply", UpAxis::Z)
    }

    #[test]
    fn points_of_the_file_stand_where_the_maps_do() {
        let placement = plain().placement(DVec3::new(10.0, -20.0, 0.0)).expect("a place");
        // 12 east, 25 north, 3 up: 2 ahead of the world's origin and 5 to its left.
        assert_eq!(placement.in_world(DVec3::new(12.0, 25.0, 3.0)), DVec3::new(2.0, -5.0, 3.0));
        let down = SplatsConfig { up_axis: UpAxis::MinusY, unit_m: Some(2.0), ..plain() };
        let placement = down.placement(DVec3::ZERO).expect("a place");
        assert_eq!(placement.in_world(DVec3::new(1.0, -4.0, 3.0)), DVec3::new(2.0, -6.0, 8.0));
    }

    #[test]
    fn two_measured_points_say_scale_turn_and_origin() {
        let known = SplatsConfig {
            up_axis: UpAxis::Y,
            unit_m: Some(2.5),
            turn_deg: Some(70.0),
            origin_m: Some([100.0, -30.0, 2.0]),
            ..plain()
        };
        let known = known.placement(DVec3::ZERO).expect("a place");
        let measured = |file: [f64; 3]| {
            let there = known.in_world(DVec3::from_array(file));
            ControlPoint { file, map_m: [there.x, -there.y, there.z] }
        };
        let points = Some([measured([0.0, 1.0, 2.0]), measured([9.0, 0.5, -4.0])]);
        let found = SplatsConfig { up_axis: UpAxis::Y, points, ..plain() }.placement(DVec3::ZERO).expect("a place");
        for point in [DVec3::ZERO, DVec3::new(3.0, -8.0, 11.0)] {
            assert!((found.in_world(point) - known.in_world(point)).length() < 1e-9);
            assert!((found.in_file(found.in_world(point)) - point).length() < 1e-9);
        }
    }

    #[test]
    fn places_that_mean_nothing_are_refused_by_key() {
        let point = |file, map_m| ControlPoint { file, map_m };
        let above = [point([0.0; 3], [0.0; 3]), point([0.0, 0.0, 1.0], [0.0, 0.0, 1.0])];
        for (config, key) in [
            (SplatsConfig { unit_m: Some(0.0), ..plain() }, "unit_m"),
            (SplatsConfig { exposure_ev: f64::NAN, ..plain() }, "exposure_ev"),
            (SplatsConfig { turn_deg: Some(f64::NAN), ..plain() }, "turn_deg"),
            (SplatsConfig { origin_m: Some([0.0, f64::INFINITY, 0.0]), ..plain() }, "origin_m"),
            (SplatsConfig { points: Some(above), ..plain() }, "points"),
            (SplatsConfig { points: Some([above[0]; 2]), ..plain() }, "points"),
            (SplatsConfig { unit_m: Some(1.0), points: Some(above), ..plain() }, "points"),
        ] {
            assert_eq!(config.placement(DVec3::ZERO).expect_err("refused").key, key);
        }
    }
}
