//! Several map files in one town: streets from one, houses or plants from another.

use crate::{FormatOptions, GroundIndex, MapError, MapOrigin, Obstacle, ObstacleKind, Town, recognise};
use cosfly_frames::{DVec2, DVec3, real};
use cosfly_geodata::reference::GeoReference;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// A further map file, and what the town takes of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FurtherSource {
    /// The map file, relative to the recipe. Its content tells its format.
    pub source: String,
    /// Things that are taken of the file. Default: buildings.
    #[serde(default = "buildings")]
    pub take: Vec<Part>,
    /// Whether things of these parts that earlier files have are left out. Default true.
    #[serde(default = "yes")]
    pub replace: bool,
    /// Height of the things. Default: they stand on the ground of the town.
    #[serde(default)]
    pub heights: Heights,
    /// Place of the file's origin in the coordinates of the first file: x, y, z, metres. Default: from the projections of both files.
    #[serde(default)]
    pub shift_m: Option<[f64; 3]>,
    /// Turn of the file about its origin, counter-clockwise, degrees; with `shift_m` only.
    #[serde(default)]
    #[schemars(range(min = -360.0, max = 360.0))]
    pub turn_deg: f64,
    /// Options of the file's format.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Value>")]
    pub options: Map<String, Value>,
}

/// Part of a town.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    /// Houses, bridges, walls and fences.
    Buildings,
    /// Trees, bushes and hedges.
    Plants,
    /// Lamps, signs, poles, parked cars and all other things.
    Furniture,
    /// Roads, pavements, other ground, and where people walk.
    Ground,
}

/// Heights of things of a further file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Heights {
    /// The lowest point of each thing stands on the ground of the town, where there is ground.
    #[default]
    Ground,
    /// As in the file.
    File,
}

fn buildings() -> Vec<Part> {
    vec![Part::Buildings]
}

fn yes() -> bool {
    true
}

/// Adds the file with these bytes to a town; warnings of its reader are returned.
///
/// # Errors
/// Files that their reader refuses; files whose places cannot be told from their projections.
pub fn add_source(town: &mut Town, further: &FurtherSource, bytes: &[u8]) -> Result<Vec<String>, MapError> {
    let options = FormatOptions::from(further.options.clone());
    let (other, warnings) = recognise(bytes)?.read(bytes, &options)?;
    let place = Placement::of(town, &other, further)?;
    let takes = |part: Part| further.take.contains(&part);
    if further.replace {
        town.obstacles.retain(|obstacle| !takes(part_of(obstacle.kind)));
    }
    let first_id = town.obstacles.iter().map(|obstacle| obstacle.object_id).max().map_or(0, |id| id + 1);
    let taken = other.obstacles.into_iter().filter(|obstacle| takes(part_of(obstacle.kind)));
    let mut things: Vec<Obstacle> =
        taken.map(|obstacle| place.obstacle(obstacle)).collect::<Option<_>>().ok_or_else(|| far(further))?;
    things.iter_mut().for_each(|thing| thing.object_id = thing.object_id.saturating_add(first_id));
    if takes(Part::Ground) {
        if further.replace {
            town.walkable.clear();
            town.surfaces.clear();
            town.lanes.clear();
        }
        for mut polygon in other.walkable {
            place.points(&mut polygon.outline_in_world).ok_or_else(|| far(further))?;
            town.walkable.push(polygon);
        }
        for mut mesh in other.surfaces {
            place.points(&mut mesh.vertices_in_world).ok_or_else(|| far(further))?;
            town.surfaces.push(mesh);
        }
        for mut lane in other.lanes {
            place.points(&mut lane.middle_in_world).ok_or_else(|| far(further))?;
            town.lanes.push(lane);
        }
    }
    if further.heights == Heights::Ground {
        stand_on_ground(&mut things, town);
    }
    town.obstacles.append(&mut things);
    town.synthetic.notes.extend(other.synthetic.notes.into_iter().map(|note| format!("{}: {note}", further.source)));
    Ok(warnings)
}

fn far(further: &FurtherSource) -> MapError {
    MapError::new(format!("`{}` lies too far from the first map for its projection", further.source))
        .hint("check that both files are of the same place, or give `shift_m`")
}

/// Moves things up or down, each as a whole.
fn stand_on_ground(things: &mut [Obstacle], town: &Town) {
    let ground = GroundIndex::of_surfaces(&town.surfaces, |_| true);
    // Lowest point of each thing, and the plan position of its box there.
    let mut feet: BTreeMap<u32, (f64, DVec2)> = BTreeMap::new();
    for thing in &*things {
        let low_m = thing.shape.center_in_world.z - thing.shape.half_extents_m.z;
        let here = (low_m, thing.shape.center_in_world.truncate());
        let lowest = feet.entry(thing.object_id).or_insert(here);
        if low_m < lowest.0 {
            *lowest = here;
        }
    }
    for thing in things {
        let (low_m, at) = feet[&thing.object_id];
        if let Some(height_m) = ground.ground_height_m(at.x, at.y) {
            thing.shape.center_in_world.z += height_m - low_m;
        }
    }
}

fn part_of(kind: ObstacleKind) -> Part {
    match kind {
        ObstacleKind::Building | ObstacleKind::Bridge | ObstacleKind::Wall | ObstacleKind::Fence => Part::Buildings,
        ObstacleKind::TreeTrunk | ObstacleKind::TreeCrown | ObstacleKind::Bush => Part::Plants,
        _ => Part::Furniture,
    }
}

/// From the world frame of one town to that of another.
struct Placement {
    from: MapOrigin,
    to: MapOrigin,
    between: Between,
}

/// From the coordinates of one file to those of another.
enum Between {
    /// Both files have the same projection.
    Nothing,
    Projections(GeoReference, GeoReference),
    Given {
        turn_rad: f64,
        shift_m: DVec3,
    },
}

impl Placement {
    fn of(town: &Town, other: &Town, further: &FurtherSource) -> Result<Self, MapError> {
        let (from, to) = (other.origin.clone(), town.origin.clone());
        let between = match (further.shift_m, &from.geo_reference, &to.geo_reference) {
            (Some(shift_m), _, _) => {
                Between::Given { turn_rad: further.turn_deg.to_radians(), shift_m: DVec3::from_array(shift_m) }
            }
            (None, Some(own), Some(first)) if own.trim() == first.trim() => Between::Nothing,
            (None, own, first) => {
                let parsed = |text: &Option<String>| text.as_deref().and_then(GeoReference::parse);
                match (parsed(own), parsed(first)) {
                    (Some(own), Some(first)) => Between::Projections(own, first),
                    _ => return Err(unplaced(further, own.as_deref(), first.as_deref())),
                }
            }
        };
        Ok(Self { from, to, between })
    }

    /// A point of the other town's world in this one's.
    fn point(&self, point: DVec3) -> Option<DVec3> {
        let shifted = point + self.from.offset_m;
        let in_map = DVec3::new(shifted.x, -shifted.y, shifted.z);
        let in_map = match &self.between {
            Between::Nothing => in_map,
            Between::Projections(own, first) => first.project(own.unproject(in_map.truncate())?).extend(in_map.z),
            Between::Given { turn_rad, shift_m } => {
                let (sin, cos) = real::sin_cos(*turn_rad);
                DVec3::new(cos * in_map.x - sin * in_map.y, sin * in_map.x + cos * in_map.y, in_map.z) + *shift_m
            }
        };
        Some(DVec3::new(in_map.x, -in_map.y, in_map.z) - self.to.offset_m)
    }

    fn points(&self, points: &mut [DVec3]) -> Option<()> {
        for point in points {
            *point = self.point(*point)?;
        }
        Some(())
    }

    fn obstacle(&self, mut obstacle: Obstacle) -> Option<Obstacle> {
        let shape = &mut obstacle.shape;
        let (sin, cos) = real::sin_cos(shape.yaw_rad);
        let tip = self.point(shape.center_in_world + DVec3::new(cos, sin, 0.0))?;
        shape.center_in_world = self.point(shape.center_in_world)?;
        let along = tip - shape.center_in_world;
        shape.yaw_rad = real::atan2(along.y, along.x);
        Some(obstacle)
    }
}

fn unplaced(further: &FurtherSource, own: Option<&str>, first: Option<&str>) -> MapError {
    let words = |text: Option<&str>| text.map_or("none".to_owned(), |text| format!("`{}`", text.trim()));
    MapError::new(format!("the place of `{}` in the town is not known from the projections of the files", further.source))
        .hint(format!("projection of the first file: {}; of this file: {}", words(first), words(own)))
        .hint("cosfly compares UTM, transverse Mercator, Lambert's conic and the grids of several countries (PROJ texts, EPSG codes, well-known text with a code); give `shift_m = [x, y, z]`, and `turn_deg` where the file is turned")
}
