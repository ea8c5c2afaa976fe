//! Parameters of a mesh that pictures show, and its place in the world.

use super::materials::{name_of, plain};
use cosfly_frames::{DVec3, real};
use cosfly_scans::faces_and_plates::FacesAndPlates;
use cosfly_scans::up_axis::UpAxis;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A textured mesh in the place of a town's boxes and ground. Left out, axis, unit and place are those of the map's file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshConfig {
    /// Path of a `.glb`, `.gltf` or `.obj` file, relative to the recipe; mostly the file that the stage `map` reads, too.
    pub source: String,
    /// Files that an OBJ file names: its `.mtl` file and the pictures. No other file is opened.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<String>,
    /// Axis of the file that points up, `y`, `z` or `-y`, as in the options of the map. Default `y`.
    #[serde(default)]
    pub up_axis: UpAxis,
    /// Length of the file's unit, metres, 0.000001 to 1000. Default: 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.000001, max = 1000.0))]
    pub unit_m: Option<f64>,
    /// Turn about the vertical, degrees, counter-clockwise seen from above. Default: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -360, max = 360))]
    pub turn_deg: Option<f64>,
    /// Place of the file's origin in the map's file: to the east, to the north and up, metres. Default: the map's origin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub origin_m: Option<[f64; 3]>,
    /// Exposure of the mesh beside that of people and vehicles, stops: 1 is twice the light, -4 to 4.
    #[serde(default)]
    #[schemars(range(min = -4, max = 4))]
    pub exposure_ev: f64,
    /// Light of the mesh: `scan`, that in its colours (the default); `weather`, sun, sky and shadows of the picture's weather.
    #[serde(default, skip_serializing_if = "MeshLight::is_of_scan")]
    pub light: MeshLight,
    /// Licence of the scan and its owner, such as `CC BY 4.0, Ana Kos, https://example.org/street`: it stands on the dataset's card.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub license: Option<String>,
    /// Whether faces and number plates can be told in the scan: `none`, `removed` or `readable`; it stands on the dataset's card.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub faces_and_plates: Option<FacesAndPlates>,
}

/// Light in which a mesh is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MeshLight {
    /// The scan in its colours, as it was scanned.
    #[default]
    Scan,
    /// Sun, sky and shadows of the picture's weather: its colours are those of an even light, as of modelled cities and of scans whose
    /// light was taken out.
    Weather,
}

impl MeshLight {
    /// Whether it is that of the scan.
    pub fn is_of_scan(&self) -> bool {
        *self == Self::Scan
    }
}

/// Parameters that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeshProblem {
    /// The key.
    pub key: &'static str,
    /// The refused value and the violated rule.
    pub message: String,
    /// Allowed values.
    pub hint: &'static str,
}

/// Where a file's frame lies in the world (left-handed, y to the south).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshPlace {
    up_axis: UpAxis,
    unit_m: f64,
    /// Sine and cosine of the turn.
    turn: [f64; 2],
    /// The file's origin in the map, right-handed, metres.
    origin_in_map: DVec3,
    /// The world's origin in the axes of the world, metres.
    world_origin_m: DVec3,
}

/// Farthest place of an origin, metres.
const FARTHEST_M: f64 = 1e8;

impl MeshConfig {
    /// A file whose numbers are those of the map's file.
    pub fn new(source: impl Into<String>) -> Self {
        Self {
            source: source.into(),
            files: vec![],
            up_axis: UpAxis::Y,
            unit_m: None,
            turn_deg: None,
            origin_m: None,
            exposure_ev: 0.0,
            light: MeshLight::Scan,
            license: None,
            faces_and_plates: None,
        }
    }

    /// Names of `files`: those without folders, and for files of one name (in any case) their paths from the mesh's folder, with `/`.
    pub fn names_of_files(&self) -> Vec<String> {
        let source = plain(&self.source);
        let folder = source.rsplit_once('/').map_or("", |(folder, _)| folder);
        let names: Vec<&str> = self.files.iter().map(|path| name_of(path)).collect();
        let is_alone = |name: &str| names.iter().filter(|other| other.eq_ignore_ascii_case(name)).count() == 1;
        let named = |(path, name): (&String, &&str)| {
            let path = plain(path);
            let inside = path.strip_prefix(folder).and_then(|it| it.strip_prefix('/')).unwrap_or(&path);
            if is_alone(name) { (*name).to_owned() } else { inside.to_owned() }
        };
        self.files.iter().zip(&names).map(named).collect()
    }

    /// The place in a world whose origin lies at `world_origin_m`: what the town's reader takes off its map's points, world axes.
    ///
    /// # Errors
    /// Numbers out of range.
    pub fn place(&self, world_origin_m: DVec3) -> Result<MeshPlace, MeshProblem> {
        let problem = |key, message, hint| Err(MeshProblem { key, message, hint });
        let (unit_m, turn_deg) = (self.unit_m.unwrap_or(1.0), self.turn_deg.unwrap_or(0.0));
        if !(1e-6..=1000.0).contains(&unit_m) {
            return problem("unit_m", format!("the length is `{unit_m}`"), "0.000001 to 1000 metres");
        }
        if !(-360.0..=360.0).contains(&turn_deg) {
            return problem("turn_deg", format!("the turn is `{turn_deg}`"), "-360 to 360 degrees");
        }
        if !(-4.0..=4.0).contains(&self.exposure_ev) {
            return problem("exposure_ev", format!("the exposure is `{}`", self.exposure_ev), "-4 to 4 stops");
        }
        if self.origin_m.iter().flatten().any(|value| !(-FARTHEST_M..=FARTHEST_M).contains(value)) {
            let message = "a number is out of range".to_owned();
            return problem("origin_m", message, "numbers from -100,000,000 to 100,000,000");
        }
        let (sin, cos) = real::sin_cos(turn_deg.to_radians());
        Ok(MeshPlace {
            up_axis: self.up_axis,
            unit_m,
            turn: [sin, cos],
            origin_in_map: DVec3::from_array(self.origin_m.unwrap_or_default()),
            world_origin_m,
        })
    }
}

impl MeshPlace {
    /// A point of the file in the world, metres.
    pub fn in_world(&self, point: DVec3) -> DVec3 {
        let upright = self.up_axis.in_map(point * self.unit_m);
        let [sin, cos] = self.turn;
        let turned = DVec3::new(upright.x * cos - upright.y * sin, upright.x * sin + upright.y * cos, upright.z);
        let in_map = turned + self.origin_in_map;
        DVec3::new(in_map.x, -in_map.y, in_map.z) - self.world_origin_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_stand_where_those_of_the_map_do() {
        let plain = MeshConfig::new("scan.glb");
        let place = plain.place(DVec3::new(10.0, -20.0, 0.0)).expect("a place");
        // 12 east, 25 north, 3 up: 2 ahead of the world's origin and 5 to its left.
        assert_eq!(place.in_world(DVec3::new(12.0, 3.0, -25.0)), DVec3::new(2.0, -5.0, 3.0));
        let moved = MeshConfig {
            up_axis: UpAxis::Z,
            unit_m: Some(2.0),
            turn_deg: Some(90.0),
            origin_m: Some([100.0, 0.0, 1.0]),
            ..plain
        };
        let place = moved.place(DVec3::ZERO).expect("a place");
        assert!(place.in_world(DVec3::new(1.0, 0.0, 3.0)).abs_diff_eq(DVec3::new(100.0, -2.0, 7.0), 1e-9));
    }

    #[test]
    fn files_of_one_name_are_told_by_their_folders() {
        let mut config = MeshConfig::new("../my scan/street.obj");
        config.files = ["../my scan/street.mtl", "../my scan/a/wall.png", "../my scan/WALL.png", "x/./wall.png"]
            .map(str::to_owned)
            .to_vec();
        let names = config.names_of_files();
        assert_eq!(names, ["street.mtl", "a/wall.png", "WALL.png", "x/wall.png"]);
        // The names of names are the same: recipes are keyed by them.
        assert_eq!(MeshConfig { files: names.clone(), ..MeshConfig::new("(content)") }.names_of_files(), names);
    }

    #[test]
    fn places_that_mean_nothing_are_refused_by_key() {
        let plain = || MeshConfig::new("scan.glb");
        for (config, key) in [
            (MeshConfig { unit_m: Some(0.0), ..plain() }, "unit_m"),
            (MeshConfig { turn_deg: Some(f64::NAN), ..plain() }, "turn_deg"),
            (MeshConfig { exposure_ev: 5.0, ..plain() }, "exposure_ev"),
            (MeshConfig { origin_m: Some([0.0, f64::INFINITY, 0.0]), ..plain() }, "origin_m"),
        ] {
            assert_eq!(config.place(DVec3::ZERO).expect_err("refused").key, key);
        }
    }
}
