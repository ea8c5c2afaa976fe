//! The parts of a file put together.

use super::document::{Attributes, CityObject, Document, documents};
use super::doubts::Doubts;
use super::faces::Face;
use super::ground::{Ground, without_spike};
use super::layers::{BUILDING, Steps, layered, pieces};
use super::plants;
use super::shapes::{Shape, Space};
use super::undersides::undersides;
use super::words::{Part, ground_of_surface, is_indoors, part_of};
use crate::open_ground::add_open_ground;
use cosfly_diagnose::counted;
use cosfly_domain::{Obstacle, ObstacleKind, OrientedBox, Synthetic, Town, WalkableKind};
use cosfly_town::solids::{CoarseThings, SolidBoxes};
use cosfly_town::units::unit_warning;
use cosfly_town::{MapError, terrain};
use std::collections::{BTreeMap, BTreeSet};

/// Most boxes of one file.
const MOST_OBSTACLES: usize = 500_000;
/// Steps of walls, furniture and other things.
const OTHER: Steps = Steps { height_m: 1.0, most_of_foot: 8, most_of_layer: 4 };
/// Side of the squares in which these things are cut, metres.
const PIECE_M: f64 = 8.0;
/// Height of a storey where the file gives their number only, metres.
const STOREY_M: f64 = 3.0;
/// A shape lower than this has no height of its own, metres.
const FLAT_M: f64 = 0.3;
/// Faults of heights and storeys that are not believed, in words.
const NO_HEIGHT: &str = "no height of 0.5 to 1500 m and counts as missing";
const NO_STOREYS: &str = "no number of storeys up to 500 and counts as missing";
/// Most objects from a part up to its building.
const MOST_GENERATIONS: usize = 16;

/// Reads a file into a town without planning boxes and bounds.
pub(super) fn town(bytes: &[u8]) -> Result<(Town, Vec<String>), MapError> {
    let mut documents = documents(bytes)?;
    let space = Space::of(&mut documents)?;
    let mut parts = Parts {
        space,
        ground: Ground::default(),
        obstacles: Vec::new(),
        next_id: 1,
        known: BTreeSet::new(),
        tally: Tally::default(),
    };
    for document in documents {
        parts.add_document(&document)?;
    }
    parts.finish()
}

/// The town while it grows.
struct Parts {
    space: Space,
    ground: Ground,
    obstacles: Vec<Obstacle>,
    next_id: u32,
    /// Names of the objects so far.
    known: BTreeSet<String>,
    tally: Tally,
}

/// Objects left out, or with something assumed: how often, and the first one.
#[derive(Default)]
struct Tally {
    broken_faces: Count,
    without_height: Count,
    without_shape: Count,
    unknown: Count,
    repeated: Count,
    storeys: usize,
    bare_trees: usize,
    absurd_trees: Count,
    stands: usize,
    coarse: CoarseThings,
    doubts: Doubts,
}

#[derive(Default)]
struct Count {
    count: usize,
    first: String,
}

impl Count {
    fn note(&mut self, count: usize, id: &str) {
        if self.count == 0 && count > 0 {
            self.first = id.chars().take(60).collect();
        }
        self.count += count;
    }
}

impl Parts {
    fn add_document(&mut self, document: &Document) -> Result<(), MapError> {
        let finest = finest_parts(document);
        let known = &mut self.known;
        let again: BTreeSet<&String> = document.objects.keys().filter(|id| !known.insert((*id).clone())).collect();
        let mut ids: BTreeMap<&str, u32> = BTreeMap::new();
        for (id, object) in &document.objects {
            let object_id = *ids.entry(root(document, id)).or_insert_with(|| {
                self.next_id += 1;
                self.next_id - 1
            });
            if again.contains(id) {
                self.tally.repeated.note(1, id);
                continue;
            }
            let part = part_of(&object.kind, object.attributes.as_ref());
            if part == Part::Nothing {
                self.tally.unknown.note(1, id);
                continue;
            }
            for geometry in object.geometry.iter().flatten() {
                self.tally.doubts.note(["shapes", "lod", "no number and counts as 0"], geometry.unread_lod(), id);
            }
            let shape = self.space.shape(object, document);
            self.tally.broken_faces.note(shape.broken, id);
            // A building whose parts are finer is their sum.
            if finest.get(id.as_str()).is_some_and(|lod| *lod > shape.lod) {
                continue;
            }
            if shape.bounds().is_none() {
                let has_geometry = object.geometry.as_ref().is_some_and(|list| !list.is_empty());
                self.tally.without_shape.note(usize::from(has_geometry), id);
                continue;
            }
            match part {
                Part::Building => self.add_building(id, object, shape, object_id),
                Part::Solid(kind) => self.add_solid(kind, &shape, object_id),
                Part::Tree => self.add_tree(object, &shape, (id, object_id)),
                Part::Plants => self.add_plants(&shape, object_id)?,
                Part::Ground(label, kind) => {
                    let is_underside = undersides(&shape.faces);
                    let upper = shape.faces.iter().zip(&shape.sources).zip(is_underside).filter(|(_, is)| !is);
                    for ((face, source), _) in upper {
                        let (label, kind) = match surface(object, *source) {
                            Some((name, attributes)) => ground_of_surface(name, attributes, (label, kind)),
                            None => (label, kind),
                        };
                        self.ground.add(face, label, kind)?;
                    }
                }
                Part::Nothing => {}
            }
            if self.obstacles.len() > MOST_OBSTACLES {
                let error = MapError::new(format!("the map has more than {MOST_OBSTACLES} solid boxes"));
                return Err(error.hint("cut the map into smaller pieces"));
            }
        }
        Ok(())
    }

    fn push(&mut self, kind: ObstacleKind, object_id: u32, boxes: impl IntoIterator<Item = OrientedBox>) {
        let one = |shape| Obstacle { shape, kind, object_id, synthetic: false };
        self.obstacles.extend(boxes.into_iter().filter(|shape| shape.half_extents_m.is_finite()).map(one));
    }

    fn push_solid(&mut self, kind: ObstacleKind, object_id: u32, solid: SolidBoxes) {
        self.tally.coarse.add(&solid);
        self.push(kind, object_id, solid.boxes);
    }

    fn add_building(&mut self, id: &str, object: &CityObject, shape: Shape, object_id: u32) {
        let Some((low, high)) = shape.bounds() else { return };
        let name = |source: (usize, usize)| surface(object, source).map(|(name, _)| name);
        let outside =
            shape.faces.into_iter().zip(shape.sources).filter(|(_, source)| !name(*source).is_some_and(is_indoors));
        if high.z - low.z < FLAT_M || shape.lod == 0.0 && high.z - low.z < 1.0 {
            let faces: Vec<Face> = outside.map(|(face, _)| face).collect();
            let Some(height_m) = self.stated_height_m(id, object) else { return self.tally.without_height.note(1, id) };
            let roof: Vec<Face> = faces.iter().map(|face| raised(face, low.z + height_m)).collect();
            return self.push_solid(ObstacleKind::Building, object_id, layered(&faces, &roof, low.z, BUILDING));
        }
        let (mut ground, mut upper, mut walls) = (Vec::new(), Vec::new(), Vec::new());
        let mut says_ground = false;
        let mut rest = Vec::new();
        for (face, source) in outside {
            match name(source) {
                Some("GroundSurface") => {
                    says_ground = true;
                    ground.push(face);
                }
                _ => rest.push(face),
            }
        }
        for face in rest {
            if face.is_wall() {
                walls.push(face);
            } else if !says_ground && face.highest_m() <= low.z + FLAT_M {
                ground.push(face);
            } else {
                upper.push(face);
            }
        }
        let mut solid = layered(&ground, &upper, low.z, BUILDING);
        if solid.boxes.is_empty() {
            // No roof: as high as the walls, over the ground or over the walls alone.
            let plan = if ground.is_empty() { &walls } else { &ground };
            let roof: Vec<Face> = plan.iter().map(|face| raised(face, high.z)).collect();
            solid = layered(plan, &roof, low.z, BUILDING);
        }
        if solid.boxes.is_empty() {
            self.tally.without_shape.note(1, id);
        }
        self.push_solid(ObstacleKind::Building, object_id, solid);
    }

    fn stated_height_m(&mut self, id: &str, object: &CityObject) -> Option<f64> {
        let attributes = object.attributes.as_ref()?;
        if let Some(height_m) = attributes.height().map(|height| self.space.length_m(height)).filter(is_believed) {
            return Some(height_m);
        }
        for (name, value) in attributes.heights() {
            self.tally.doubts.note(["buildings", name, NO_HEIGHT], value, id);
        }
        let height_m = attributes.storeys().map(|storeys| STOREY_M * storeys).filter(is_believed);
        if height_m.is_none() {
            let [(name, value), _] = attributes.other_numbers();
            self.tally.doubts.note(["buildings", name, NO_STOREYS], value, id);
        }
        self.tally.storeys += usize::from(height_m.is_some());
        height_m
    }

    fn add_solid(&mut self, kind: ObstacleKind, shape: &Shape, object_id: u32) {
        let Some((low, high)) = shape.bounds().filter(|(low, high)| high.z - low.z >= FLAT_M) else { return };
        let is_upper = |face: &&Face| !face.is_wall() && face.highest_m() > low.z + FLAT_M;
        let upper: Vec<Face> = shape.faces.iter().filter(is_upper).cloned().collect();
        let roof = || shape.faces.iter().map(|face| raised(face, high.z)).collect();
        let upper: Vec<Face> = if upper.is_empty() { roof() } else { upper };
        for piece in pieces(&upper, PIECE_M) {
            self.push_solid(kind, object_id, layered(&[], &piece, low.z, OTHER));
        }
    }

    fn add_tree(&mut self, object: &CityObject, shape: &Shape, (id, object_id): (&str, u32)) {
        let tree = plants::tree(shape, object.attributes.as_ref(), &self.space, object_id);
        if let Some(tree) = tree {
            self.tally.bare_trees += usize::from(tree.is_assumed);
            self.tally.absurd_trees.note(usize::from(tree.is_absurd), id);
            for (name, value) in tree.unread {
                self.tally.doubts.note(["trees", name, "no number above 0 and counts as missing"], value, id);
            }
            for (kind, shape) in tree.boxes {
                self.push(kind, object_id, [shape]);
            }
        }
    }

    fn add_plants(&mut self, shape: &Shape, object_id: u32) -> Result<(), MapError> {
        let Some((low, _)) = shape.bounds() else { return Ok(()) };
        for face in shape.faces.iter().filter(|face| face.highest_m() <= low.z + plants::GROUND_RISE_M) {
            self.ground.add(&without_spike(face), cosfly_domain::SemanticLabel::Terrain, None)?;
        }
        let stand = plants::stand(&shape.faces, low.z);
        self.tally.stands += usize::from(!stand.is_empty());
        let mut boxes = vec![];
        for solid in stand {
            self.tally.coarse.add(&solid);
            boxes.extend(solid.boxes);
        }
        // Every tree is an object of its own: round crowns are drawn on it. Its trunk, where it has one, comes before its crown.
        let mut under = None;
        for (kind, shape) in plants::grown(boxes, low.z) {
            let own_id = match (kind, under.take()) {
                (ObstacleKind::Bush, _) => object_id,
                (ObstacleKind::TreeCrown, Some(trunk_id)) => trunk_id,
                _ => {
                    self.next_id += 1;
                    self.next_id - 1
                }
            };
            under = (kind == ObstacleKind::TreeTrunk).then_some(own_id);
            self.push(kind, own_id, [shape]);
        }
        Ok(())
    }

    fn finish(mut self) -> Result<(Town, Vec<String>), MapError> {
        let mut notes = Vec::new();
        let Tally { storeys, bare_trees, stands, .. } = self.tally;
        if storeys > 0 {
            notes.push(format!(
                "{} without a height in the file: a storey counts as {STOREY_M} m",
                counted(storeys, "building")
            ));
        }
        if bare_trees > 0 {
            notes.push(format!("{} of an assumed size: the file gives the place only", counted(bare_trees, "tree")));
        }
        if stands > 0 {
            notes.push(format!(
                "{} of plants (`PlantCover`): bushes, and trees where the faces rise to points; trunks and crowns of up to 4 m are \
                 invented; trees whose place is known need `SolitaryVegetationObject`",
                counted(stands, "stand")
            ));
        }
        let coarseness = terrain::add_terrain(&mut self.ground.meshes, &self.obstacles, terrain::USUAL_MARGIN_M)?;
        let surfaces = self.ground.meshes.finish();
        let mut walkable = self.ground.walkable;
        if !walkable.iter().any(|polygon| polygon.kind != WalkableKind::Road) {
            notes.push(add_open_ground(&mut walkable, &self.obstacles, &surfaces));
        }
        let mut warnings = self.tally.warnings();
        warnings.extend(coarseness);
        warnings.extend(unit_warning(self.space.units_m[0], self.space.reference_system.as_deref()));
        if self.space.lacks_transform {
            warnings
                .push("the file has no `transform`, which its version asks for: vertices count as metres".to_owned());
        }
        if walkable.is_empty() {
            let error = MapError::new("the map has neither ground for people to walk on nor buildings to walk around");
            let error = error.hint("use a file with objects of type `Building` or `Road` that have shapes");
            return Err(warnings.into_iter().fold(error, MapError::hint));
        }
        let town = Town {
            name: "town".to_owned(),
            origin: self.space.world.origin(self.space.reference_system.clone()),
            obstacles: self.obstacles,
            walkable,
            surfaces,
            synthetic: Synthetic { notes, ..Synthetic::default() },
            ..Town::default()
        };
        Ok((town, warnings))
    }
}

impl Tally {
    fn warnings(&self) -> Vec<String> {
        let all = [
            (
                &self.broken_faces,
                "faces with fewer than three corners, with corners that the file does not have, or beyond the 500000 of one object are left out",
            ),
            (
                &self.without_height,
                "flat buildings without a believable `measuredHeight` or `storeysAboveGround` are left out",
            ),
            (&self.without_shape, "objects without a usable shape are left out"),
            (&self.unknown, "objects of kinds that are not read are left out"),
            (
                &self.absurd_trees,
                "trees are lower than 0.5 m, higher than 120 m or wider than 40 m: stated sizes are assumed instead, and drawn ones cut to \
                 these limits",
            ),
            (&self.repeated, "objects are in the file again under the same name and are left out"),
        ];
        let counted = all.into_iter().filter(|(count, _)| count.count > 0);
        let lines = counted.map(|(count, text)| format!("{} {text}, the first one of `{}`", count.count, count.first));
        lines.chain(self.doubts.warnings()).chain(self.coarse.warnings()).collect()
    }
}

/// Meaning of a face of an object.
fn surface(object: &CityObject, (geometry, face): (usize, usize)) -> Option<(&str, &Attributes)> {
    let surface = object.geometry.as_ref()?.get(geometry)?.surface_of_face(face)?;
    Some((&surface.kind, &surface.attributes))
}

/// Whether a building can be so high.
fn is_believed(height_m: &f64) -> bool {
    (0.5..=1500.0).contains(height_m)
}

fn raised(face: &Face, height_m: f64) -> Face {
    Face { rings: face.rings.iter().map(|ring| ring.iter().map(|corner| corner.with_z(height_m)).collect()).collect() }
}

/// The finest level of detail among the parts of each building.
fn finest_parts(document: &Document) -> BTreeMap<&str, f64> {
    let mut finest: BTreeMap<&str, f64> = BTreeMap::new();
    let parts = document.objects.values().filter(|object| object.kind == "BuildingPart");
    for (parent, geometry) in parts.flat_map(|part| {
        part.parents.iter().flat_map(|parent| part.geometry.iter().flatten().map(move |it| (parent, it)))
    }) {
        let lod = finest.entry(parent).or_insert(f64::NEG_INFINITY);
        *lod = lod.max(geometry.lod());
    }
    finest
}

/// The object that has no parent, from this one up. Circles end somewhere in them.
fn root<'d>(document: &'d Document, id: &'d str) -> &'d str {
    let mut id = id;
    for _ in 0..MOST_GENERATIONS {
        match document.objects.get(id).and_then(|object| object.parents.first()) {
            Some(parent) if document.objects.contains_key(parent.as_str()) => id = parent,
            _ => break,
        }
    }
    id
}
