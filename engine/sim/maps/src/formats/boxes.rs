//! `boxes`: obstacle boxes and walkable ground as JSON, for towns that other programs made.
//!
//! Frame of the file: right-handed, x east, y north, z up, metres; yaw counter-clockwise from x, degrees.

mod labels;
mod repeats;

use cosfly_domain::{
    Obstacle, ObstacleKind, OrientedBox, SemanticLabel, Synthetic, Town, WalkableKind, WalkablePolygon,
};
use cosfly_frames::{DVec2, DVec3, real};
use cosfly_town::format::MapFormat;
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::polygons::triangulated;
use cosfly_town::text::{decoded, refused_json};
use cosfly_town::world::WorldFromMap;
use cosfly_town::{MapError, terrain};
use labels::{Label, Part, Tally};
use repeats::Repeats;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Format and version of the files that are read.
const FORMAT: &str = "cosfly-boxes/1";
/// Most boxes of one file.
const MOST_BOXES: usize = 200_000;
/// Most walkable polygons of one file.
const MOST_POLYGONS: usize = 20_000;
/// Widest map, metres.
const WIDEST_M: f64 = 20_000.0;

/// The format `boxes`.
#[derive(Clone, Copy, Debug)]
pub struct Boxes;

/// Options of maps of boxes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct BoxesOptions {
    /// Distance that the terrain reaches beyond all boxes and all walkable ground, metres. 1 to 1000, default 60.
    #[schemars(range(min = 1.0, max = 1000.0))]
    pub terrain_margin_m: f64,
}

impl Default for BoxesOptions {
    fn default() -> Self {
        Self { terrain_margin_m: terrain::USUAL_MARGIN_M }
    }
}

impl MapFormat for Boxes {
    type Options = BoxesOptions;

    const NAME: &'static str = "boxes";

    const EXAMPLE: &'static [u8] = br#"{
  "format": "cosfly-boxes/1",
  "boxes": [
    { "kind": "building", "center_m": [20, 14, 5], "size_m": [16, 10, 10], "yaw_deg": 15 },
    { "kind": "tree_trunk", "center_m": [-20, 7, 1.5], "size_m": [0.3, 0.3, 3], "object": 1 },
    { "kind": "tree_crown", "center_m": [-20, 7, 5], "size_m": [4, 4, 4], "object": 1 },
    { "label": "Buildings", "center_m": [-34, -20, 4], "size_m": [9, 6, 8], "yaw_deg": -30, "pitch_deg": 2, "roll_deg": 1 },
    { "label": "Vegetation", "center_m": [30, -20, 4], "size_m": [5, 5, 8] },
    { "label": "Roads", "center_m": [0, 40, 0], "size_m": [60, 7, 0.1] }
  ],
  "walkable": [
    { "kind": "sidewalk", "outline_m": [[-60, 0, 0.15], [60, 0, 0.15], [60, 3, 0.15], [-60, 3, 0.15]] },
    { "kind": "crossing", "outline_m": [[0, -7, 0], [4, -7, 0], [4, 0, 0], [0, 0, 0]] },
    { "kind": "plaza", "outline_m": [[-40, -30, 0], [40, -30, 0], [40, -7, 0], [0, -12, 0], [-40, -7, 0]] }
  ]
}
"#;

    fn recognises(head: &[u8]) -> bool {
        let text = String::from_utf8_lossy(head);
        text.trim_start_matches('\u{feff}').trim_start().starts_with('{') && text.contains("\"cosfly-boxes/")
    }

    fn read(bytes: &[u8], options: &BoxesOptions) -> Result<(Town, Vec<String>), MapError> {
        let text = decoded(bytes)?;
        let document: Document = serde_json::from_str(&text).map_err(|error| refused_json(&error, &text))?;
        document.check()?;
        document.town(options)
    }
}

/// A file as it stands, map frame.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(rename = "format")]
    _format: FormatName,
    #[serde(default)]
    boxes: Vec<SolidBox>,
    walkable: Vec<Ground>,
}

#[derive(Deserialize)]
#[serde(try_from = "String")]
struct FormatName;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SolidBox {
    kind: Option<Kind>,
    /// The server's label, in place of a kind.
    label: Option<Label>,
    center_m: [Coordinate; 3],
    size_m: [Size; 3],
    #[serde(default)]
    yaw_deg: Angle,
    #[serde(default)]
    pitch_deg: Angle,
    #[serde(default)]
    roll_deg: Angle,
    /// Boxes of one thing have the same number; a box without one is a thing of its own.
    object: Option<u32>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Ground {
    #[serde(with = "GroundName")]
    kind: WalkableKind,
    outline_m: Vec<[Coordinate; 3]>,
}

#[derive(Clone, Copy, Deserialize)]
struct Kind(#[serde(with = "KindName")] ObstacleKind);

#[derive(Deserialize)]
#[serde(remote = "ObstacleKind", rename_all = "snake_case")]
enum KindName {
    Building,
    Wall,
    Fence,
    TreeTrunk,
    TreeCrown,
    Bush,
    Pole,
    Lamp,
    TrafficLight,
    TrafficSign,
    GuardRail,
    Bridge,
    Car,
    Static,
    Bench,
    Stall,
}

#[derive(Deserialize)]
#[serde(remote = "WalkableKind", rename_all = "snake_case")]
enum GroundName {
    Sidewalk,
    Crossing,
    Shoulder,
    Plaza,
    Road,
}

/// A coordinate, metres.
#[derive(Clone, Copy, Deserialize)]
#[serde(try_from = "f64")]
struct Coordinate(f64);

/// A length of a box's side, metres.
#[derive(Clone, Copy, Deserialize)]
#[serde(try_from = "f64")]
struct Size(f64);

/// An angle, degrees.
#[derive(Clone, Copy, Default, Deserialize)]
#[serde(try_from = "f64")]
struct Angle(f64);

impl TryFrom<String> for FormatName {
    type Error = String;

    fn try_from(name: String) -> Result<Self, String> {
        let shown: String = name.chars().take(40).collect();
        if name == FORMAT { Ok(Self) } else { Err(format!("`format` is `{shown}`; this cosfly reads `{FORMAT}`")) }
    }
}

impl TryFrom<f64> for Coordinate {
    type Error = String;

    fn try_from(value: f64) -> Result<Self, String> {
        within(value, "a coordinate", [-1e8, 1e8], "m").map(Self)
    }
}

impl TryFrom<f64> for Size {
    type Error = String;

    fn try_from(value: f64) -> Result<Self, String> {
        within(value, "a size", [1e-3, 1e4], "m").map(Self)
    }
}

impl TryFrom<f64> for Angle {
    type Error = String;

    fn try_from(value: f64) -> Result<Self, String> {
        within(value, "an angle", [-3600.0, 3600.0], "degrees").map(Self)
    }
}

fn within(value: f64, name: &str, [low, high]: [f64; 2], unit: &str) -> Result<f64, String> {
    if (low..=high).contains(&value) {
        return Ok(value);
    }
    Err(format!("{name} is `{value}`; it must lie between {low} and {high} {unit}"))
}

fn vector(numbers: &[Coordinate; 3]) -> DVec3 {
    DVec3::from_array(numbers.map(|number| number.0))
}

impl Document {
    fn check(&self) -> Result<(), MapError> {
        for (name, count, most) in
            [("boxes", self.boxes.len(), MOST_BOXES), ("walkable", self.walkable.len(), MOST_POLYGONS)]
        {
            if count > most {
                let error = MapError::new(format!("`{name}` has {count} entries; at most {most} are read"));
                return Err(error.hint("write the part of the town that flights need"));
            }
        }
        if self.walkable.is_empty() {
            let error = MapError::new("the map has no walkable ground: `walkable` is empty");
            return Err(error.hint("add polygons for people to walk on"));
        }
        let (low, high) = self
            .points()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), point| (low.min(point), high.max(point)));
        let across_m = (high - low).max_element();
        if across_m > WIDEST_M {
            let error = MapError::new(format!("the map is {across_m} m across; at most {WIDEST_M} m are read"));
            return Err(
                error.hint("check that all coordinates are metres; write the part of the town that flights need")
            );
        }
        Ok(())
    }

    /// Centres of the boxes and corners of the ground.
    fn points(&self) -> impl Iterator<Item = DVec3> {
        let centers = self.boxes.iter().map(|one| vector(&one.center_m));
        centers.chain(self.walkable.iter().flat_map(|ground| &ground.outline_m).map(vector))
    }

    fn town(&self, options: &BoxesOptions) -> Result<(Town, Vec<String>), MapError> {
        let world = WorldFromMap::around(self.points().map(DVec3::truncate));
        let (obstacles, tally) = self.obstacles(&world)?;
        let mut meshes = MeshBuilder::default();
        let mut walkable = Vec::with_capacity(self.walkable.len());
        for (index, ground) in self.walkable.iter().enumerate() {
            let polygon = ground.polygon(&world);
            let plan = polygon.plan();
            let triangles = triangulated(&plan);
            if triangles.is_empty() {
                let message = format!("the outline of `walkable[{index}]` is no simple polygon of 3 to 100 corners");
                return Err(
                    MapError::new(message).hint("let no two edges of an outline cross; cut long outlines into pieces")
                );
            }
            let vertices: Vec<(DVec3, DVec2)> = polygon.outline_in_world.iter().copied().zip(plan).collect();
            meshes.polygon(label(ground.kind), false, &vertices, &triangles);
            walkable.push(polygon);
        }
        let coarseness = terrain::add_terrain(&mut meshes, &obstacles, options.terrain_margin_m)?;
        let town = Town {
            name: "town".to_owned(),
            origin: world.origin(None),
            obstacles,
            walkable,
            surfaces: meshes.finish(),
            synthetic: Synthetic { notes: tally.notes(), ..Synthetic::default() },
            ..Town::default()
        };
        Ok((town, tally.warnings().into_iter().chain(self.repeats()).chain(coarseness).collect()))
    }

    /// Lines on boxes and polygons that are there again.
    fn repeats(&self) -> impl Iterator<Item = String> {
        let boxes = Repeats::of(self.boxes.iter().map(SolidBox::key)).map(|it| it.warning("boxes"));
        let walkable = Repeats::of(self.walkable.iter().map(Ground::key)).map(|it| it.warning("walkable"));
        [boxes, walkable].into_iter().flatten()
    }

    fn obstacles(&self, world: &WorldFromMap) -> Result<(Vec<Obstacle>, Tally), MapError> {
        let mut ids = BTreeMap::new();
        let mut count = 0;
        let mut next_id = || {
            count += 1;
            count
        };
        let mut tally = Tally::default();
        let mut obstacles = Vec::with_capacity(self.boxes.len());
        for (index, one) in self.boxes.iter().enumerate() {
            let object_id = match one.object {
                Some(object) => *ids.entry(object).or_insert_with(&mut next_id),
                None => next_id(),
            };
            let part = match (one.kind, one.label) {
                (Some(Kind(kind)), None) => Part::Solid(kind),
                (None, Some(label)) => label.part(),
                _ => {
                    let message = format!("`boxes[{index}]` must have either `kind` or `label`");
                    return Err(MapError::new(message).hint("the book's pages on maps describe the format"));
                }
            };
            let shape = OrientedBox {
                center_in_world: world.point(vector(&one.center_m)),
                half_extents_m: one.half_extents_m(),
                yaw_rad: world.yaw_rad(one.yaw_deg.0.to_radians()),
            };
            tally.note(part);
            let boxes = part.boxes(shape, object_id);
            obstacles.extend(boxes.into_iter().map(|(kind, shape)| Obstacle {
                shape,
                kind,
                object_id,
                synthetic: false,
            }));
        }
        Ok((obstacles, tally))
    }
}

impl SolidBox {
    /// Kind, place, size and turn: whatever the object, boxes that share them are in one place.
    fn key(&self) -> ([Option<u8>; 2], [u64; 9]) {
        let ([x, y, z], [length, width, height]) = (self.center_m.map(|it| it.0), self.size_m.map(|it| it.0));
        let numbers = [x, y, z, length, width, height, self.yaw_deg.0, self.pitch_deg.0, self.roll_deg.0];
        ([self.kind.map(|kind| kind.0 as u8), self.label.map(|label| label as u8)], numbers.map(key_of))
    }

    /// Half the size of the box that encloses this one when it is pitched and rolled, along the axes that its yaw turns.
    fn half_extents_m(&self) -> DVec3 {
        let half = 0.5 * DVec3::from_array(self.size_m.map(|side| side.0));
        let [(sin_pitch, cos_pitch), (sin_roll, cos_roll)] =
            [self.pitch_deg, self.roll_deg].map(|angle| real::sin_cos(angle.0.to_radians()));
        // Rows of the pitch times the roll, without their signs.
        DVec3::new(
            half.dot(DVec3::new(cos_pitch, sin_pitch * sin_roll, sin_pitch * cos_roll).abs()),
            half.dot(DVec3::new(0.0, cos_roll, sin_roll).abs()),
            half.dot(DVec3::new(sin_pitch, cos_pitch * sin_roll, cos_pitch * cos_roll).abs()),
        )
    }
}

/// A number as a key; both zeros are one.
fn key_of(number: f64) -> u64 {
    (number + 0.0).to_bits()
}

impl Ground {
    fn key(&self) -> (u8, Vec<u64>) {
        let numbers = self.outline_m.iter().flatten().map(|coordinate| key_of(coordinate.0));
        (self.kind as u8, numbers.collect())
    }

    fn polygon(&self, world: &WorldFromMap) -> WalkablePolygon {
        let outline_in_world = self.outline_m.iter().map(|corner| world.point(vector(corner))).collect();
        WalkablePolygon { kind: self.kind, outline_in_world, synthetic: false }
    }
}

/// The label under which ground is seen.
fn label(kind: WalkableKind) -> SemanticLabel {
    match kind {
        WalkableKind::Sidewalk | WalkableKind::Plaza => SemanticLabel::SideWalks,
        WalkableKind::Crossing | WalkableKind::Shoulder | WalkableKind::Road => SemanticLabel::Roads,
    }
}
