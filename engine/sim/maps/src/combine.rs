//! Several map files in one town: streets from one, houses or plants from another.

use crate::bounds::PlanRectangle;
use crate::recognise;
use cosfly_domain::{MapOrigin, Obstacle, ObstacleKind, Town};
use cosfly_frames::{DVec2, DVec3, real};
use cosfly_geodata::reference::GeoReference;
use cosfly_town::{FormatOptions, GroundIndex, MapError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
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
    pub options: FormatOptions,
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
    /// Heights stay those of the file.
    File,
}

fn buildings() -> Vec<Part> {
    vec![Part::Buildings]
}

fn yes() -> bool {
    true
}

/// Things of a further file whose nearest one is farther from the town are those of another place, metres.
const ANOTHER_PLACE_M: f64 = 2_000.0;
/// No thing of a further file may be farther from the town, metres.
const FARTHEST_M: f64 = 10_000.0;
/// A further file none of whose things is nearer is a warning, metres.
const BESIDE_M: f64 = 100.0;

/// Adds the file with these bytes to a town, as far as it lies in some bounds; warnings are returned.
///
/// # Errors
/// Files that their reader refuses; files whose places cannot be told from their projections, or are kilometres away.
pub(crate) fn add_source(
    town: &mut Town,
    further: &FurtherSource,
    bytes: &[u8],
    bounds: Option<&PlanRectangle>,
) -> Result<Vec<String>, MapError> {
    let (other, mut warnings) = recognise(bytes)?.read(bytes, &further.options)?;
    let place = Placement::of(town, &other, further)?;
    let mut taken = taken(other, further, &place).ok_or_else(|| far(further, &place))?;
    if let Some(bounds) = bounds {
        bounds.cut(&mut taken);
    }
    warnings.extend(place.check_distance(town, &taken, further)?);
    let takes = |part: Part| further.take.contains(&part);
    if further.replace {
        town.obstacles.retain(|obstacle| !takes(part_of(obstacle.kind)));
        if takes(Part::Ground) {
            town.walkable.clear();
            town.surfaces.clear();
            town.lanes.clear();
        }
    }
    let first_id = town.obstacles.iter().map(|obstacle| obstacle.object_id).max().map_or(0, |id| id + 1);
    taken.obstacles.iter_mut().for_each(|thing| thing.object_id = thing.object_id.saturating_add(first_id));
    town.walkable.append(&mut taken.walkable);
    town.surfaces.append(&mut taken.surfaces);
    town.lanes.append(&mut taken.lanes);
    if further.heights == Heights::Ground {
        stand_on_ground(&mut taken.obstacles, town);
    }
    town.obstacles.append(&mut taken.obstacles);
    town.synthetic.notes.extend(taken.synthetic.notes.into_iter().map(|note| format!("{}: {note}", further.source)));
    Ok(warnings)
}

/// The parts of another town that are taken, at their places in this one; none where a projection knows no place.
fn taken(mut other: Town, further: &FurtherSource, place: &Placement) -> Option<Town> {
    let takes = |part: Part| further.take.contains(&part);
    let things = other.obstacles.into_iter().filter(|obstacle| takes(part_of(obstacle.kind)));
    other.obstacles = things.map(|obstacle| place.obstacle(obstacle)).collect::<Option<_>>()?;
    if !takes(Part::Ground) {
        (other.walkable, other.surfaces, other.lanes) = (vec![], vec![], vec![]);
    }
    let walkable = other.walkable.iter_mut().map(|polygon| &mut polygon.outline_in_world);
    let surfaces = other.surfaces.iter_mut().map(|mesh| &mut mesh.vertices_in_world);
    let lanes = other.lanes.iter_mut().map(|lane| &mut lane.middle_in_world);
    walkable.chain(surfaces).chain(lanes).try_for_each(|points| place.points(points))?;
    Some(other)
}

fn far(further: &FurtherSource, place: &Placement) -> MapError {
    let message = format!("`{}` lies too far from the first map for its projection", further.source);
    place.advised(MapError::new(message))
}

/// Places in plan of all that the file of a town has; invented land reaches farther.
fn places(town: &Town) -> impl Iterator<Item = DVec2> + '_ {
    let things = town.obstacles.iter().map(|one| one.shape.center_in_world);
    let walkable = town.walkable.iter().flat_map(|polygon| polygon.outline_in_world.iter().copied());
    let surfaces = town.surfaces.iter().filter(|mesh| !mesh.synthetic);
    let surfaces = surfaces.flat_map(|mesh| mesh.vertices_in_world.iter().copied());
    things.chain(walkable).chain(surfaces).map(DVec3::truncate)
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
                    _ => {
                        let message = format!(
                            "the place of `{}` in the town is not known from the projections of the files",
                            further.source
                        );
                        return Err(advised(MapError::new(message), &from, &to));
                    }
                }
            }
        };
        Ok(Self { from, to, between })
    }

    /// The error with the ways out for things at a wrong place.
    fn advised(&self, error: MapError) -> MapError {
        match self.between {
            Between::Given { .. } => error.hint(
                "check `shift_m`, the place of this file's origin in the coordinates of the first file, and `turn_deg`",
            ),
            _ => advised(error, &self.from, &self.to),
        }
    }

    /// Says so where nothing of the taken things is beside the town.
    ///
    /// # Errors
    /// Things that are kilometres away from it.
    fn check_distance(&self, town: &Town, taken: &Town, further: &FurtherSource) -> Result<Option<String>, MapError> {
        let Some(own) = PlanRectangle::around(places(town)) else { return Ok(None) };
        let mut distances = places(taken).map(|at| own.distance_m(at));
        let Some(first_m) = distances.next() else {
            return Ok(Some(
                "the file has none of the parts that `take` names, or none of them within the bounds".into(),
            ));
        };
        let (nearest_m, farthest_m) = distances.fold((first_m, first_m), |(low, high), it| (low.min(it), high.max(it)));
        let (file, name) = (&further.source, &town.name);
        if nearest_m > ANOTHER_PLACE_M {
            let message = format!("`{file}` is {:.1} km away from the town `{name}`", 1e-3 * nearest_m);
            return Err(self.advised(MapError::new(message)));
        }
        if farthest_m > FARTHEST_M {
            let bounds = own.grown(ANOTHER_PLACE_M).written();
            let message = format!("things of `{file}` are {:.1} km away from the town `{name}`", 1e-3 * farthest_m);
            return Err(MapError::new(message).hint(format!("`{bounds}` of the stage keeps the town and what is near")));
        }
        Ok((nearest_m > BESIDE_M)
            .then(|| format!("nothing of the file is in the town: the nearest is {nearest_m:.0} m away")))
    }

    /// A point of the other town's world in this one's.
    fn point(&self, point: DVec3) -> Option<DVec3> {
        // A shift is between the coordinates that the files themselves have.
        let [from_m, to_m] = [&self.from, &self.to].map(|origin| match self.between {
            Between::Given { .. } => origin.offset_m - origin.added_by_file_m,
            _ => origin.offset_m,
        });
        let shifted = point + from_m;
        let in_map = DVec3::new(shifted.x, -shifted.y, shifted.z);
        let in_map = match &self.between {
            Between::Nothing => in_map,
            Between::Projections(own, first) => first.project(own.unproject(in_map.truncate())?).extend(in_map.z),
            Between::Given { turn_rad, shift_m } => {
                let (sin, cos) = real::sin_cos(*turn_rad);
                DVec3::new(cos * in_map.x - sin * in_map.y, sin * in_map.x + cos * in_map.y, in_map.z) + *shift_m
            }
        };
        Some(DVec3::new(in_map.x, -in_map.y, in_map.z) - to_m)
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

/// The error with the projections of both files and what can be done about them.
fn advised(error: MapError, from: &MapOrigin, to: &MapOrigin) -> MapError {
    let words = |text: &Option<String>| match text.as_deref().map(str::trim) {
        None => "none".to_owned(),
        Some(text) if GeoReference::parse(text).is_some() => format!("`{text}`"),
        Some(text) => format!("`{text}`, of which {}", GeoReference::why_unknown(text)),
    };
    error
        .hint(format!("projection of the first file: {}; of this file: {}", words(&to.geo_reference), words(&from.geo_reference)))
        .hint(
            "check that both files are of the same place, or give `shift_m = [x, y, z]`, the place of this file's origin in the \
             coordinates of the first file, and `turn_deg` where it is turned",
        )
        .hint(
            "cosfly compares UTM, transverse Mercator, Lambert's conic and the grids of several countries (PROJ texts, EPSG \
             codes, well-known text with a code)",
        )
}
