//! Land by its use: grass and bare ground as surfaces, trees of woods, whose places are assumed.

use super::elements::Elements;
use super::frame::Frame;
use super::paths::{Paths, add_ground};
use super::rings::{Area, Problems, areas};
use super::roads::{LINE_MARGIN_M, Road, RoadIndex};
use super::tags::Tags;
use super::things::Things;
use cosfly_domain::{Obstacle, OrientedBox, SemanticLabel};
use cosfly_frames::{DVec2, Seed};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::polygons::PolygonIndex;
use std::collections::BTreeMap;

/// Heights of grass and of bare ground, metres: below water, which often lies within them.
const GRASS_HEIGHT_M: f64 = -0.03;
const BARE_HEIGHT_M: f64 = -0.015;
/// Distance between the trees of woods, metres; each stands up to a third of it aside.
const TREE_SPACING_M: f64 = 8.0;
/// Trees of woods stand within this distance of ground for people, metres: farther ones no flight comes near.
const NEAR_M: f64 = 80.0;
/// Distance between the bushes of scrub, metres, and the size of one.
const BUSH_SPACING_M: f64 = 4.0;
const BUSH_M: f64 = 2.4;
const BUSH_HEIGHT_M: f64 = 1.5;
/// Distance of plants from paths, streets and houses, metres.
const CLEAR_M: f64 = 3.0;
/// Most plants of one kind, and most places and sides of outlines that are looked at for them.
const MOST_PLANTS: usize = 100_000;
const MOST_WORK: usize = 1_000_000_000;

/// Whether an area is a wood.
fn is_wood(tags: &Tags) -> bool {
    (tags.is("natural", &["wood"]) || tags.is("landuse", &["forest", "orchard"])) && tags.is_on_the_ground()
}

/// Whether an area is full of bushes.
fn is_scrub(tags: &Tags) -> bool {
    tags.is("natural", &["scrub", "shrubbery"]) && tags.is_on_the_ground()
}

fn is_grass(tags: &Tags) -> bool {
    let is_lawn = tags
        .is("landuse", &["grass", "meadow", "village_green", "recreation_ground", "cemetery", "flowerbed"])
        || tags.is("leisure", &["park", "garden", "golf_course"])
        || tags.is("natural", &["grassland", "heath", "scrub", "shrubbery"])
        || tags.is("leisure", &["pitch"]) && tags.is("surface", &["grass"]);
    (is_lawn || is_wood(tags)) && tags.is_on_the_ground() && !tags.has("building")
}

fn is_bare(tags: &Tags) -> bool {
    let is_earth = tags.is("landuse", &["brownfield", "construction", "quarry", "landfill", "railway", "farmyard"])
        || tags.is("natural", &["sand", "beach", "shingle", "bare_rock", "scree", "mud"])
        || tags.is("leisure", &["playground"])
        || tags.is("leisure", &["pitch", "track"]) && !tags.is("surface", &["grass"]);
    is_earth && tags.is_on_the_ground() && !tags.has("building")
}

/// Adds the surfaces of land.
pub fn add_surfaces(elements: &Elements, frame: &Frame, meshes: &mut MeshBuilder, problems: &mut Problems) {
    for area in areas(elements, frame, is_grass, problems) {
        add_ground(meshes, SemanticLabel::Terrain, (&area, GRASS_HEIGHT_M), frame, problems);
    }
    for area in areas(elements, frame, is_bare, problems) {
        add_ground(meshes, SemanticLabel::Ground, (&area, BARE_HEIGHT_M), frame, problems);
    }
}

/// Adds trees to woods and bushes to scrub near ground for people, clear of paths, streets and houses. Gives notes about
/// them.
pub fn add_plants(
    elements: &Elements,
    frame: &Frame,
    things: &mut Things<'_>,
    (roads, paths, houses): (&[Road<'_>], &Paths, &[Obstacle]),
) -> Vec<String> {
    // What is wrong with the areas is told of with their surfaces.
    let woods = areas(elements, frame, is_wood, &mut Problems::default());
    let scrub = areas(elements, frame, is_scrub, &mut Problems::default());
    if woods.is_empty() && scrub.is_empty() {
        return Vec::new();
    }
    let around = Around::new(roads, paths, houses.iter().chain(&things.obstacles));
    let trees = Planted::of(&woods, TREE_SPACING_M, frame, &around);
    let bushes = Planted::of(&scrub, BUSH_SPACING_M, frame, &around);
    for (number, at) in &trees.places {
        things.add_assumed_tree(*number, *at);
    }
    for at in bushes.places.values() {
        things.add_assumed_bush(*at, [BUSH_M, BUSH_HEIGHT_M]);
    }
    [trees.note("trees of woods", "woods"), bushes.note("bushes of scrub", "scrub")].into_iter().flatten().collect()
}

/// Plants of one kind: the number of each place, and the place.
struct Planted {
    spacing_m: f64,
    places: BTreeMap<u64, DVec2>,
    /// Places and sides of outlines looked at.
    work: usize,
}

impl Planted {
    fn of(areas: &[Area<'_>], spacing_m: f64, frame: &Frame, around: &Around) -> Self {
        let mut planted = Self { spacing_m, places: BTreeMap::new(), work: 0 };
        areas.iter().for_each(|area| planted.add(area, frame, around));
        planted
    }

    fn note(&self, plants: &str, land: &str) -> Option<String> {
        let (count, spacing_m) = (self.places.len(), self.spacing_m);
        let limit = if self.is_full() { ", no more than these" } else { "" };
        let line = format!(
            "{count} {plants} are invented ({spacing_m} m apart, within {NEAR_M} m of ground for people{limit}): \
             the file states the {land}"
        );
        (count > 0).then_some(line)
    }

    fn is_full(&self) -> bool {
        self.places.len() >= MOST_PLANTS || self.work >= MOST_WORK
    }

    /// Adds the plants of an area. Their places are the same in every area, so that areas that overlap share them.
    fn add(&mut self, area: &Area<'_>, frame: &Frame, around: &Around) {
        let ring = frame.clipped_ring(&area.outer, LINE_MARGIN_M);
        let sides = ring.len() + area.holes.iter().map(Vec::len).sum::<usize>();
        let spacing_m = self.spacing_m;
        let cell = |corner: DVec2| (corner / spacing_m).floor();
        let low = ring.iter().copied().map(cell).fold(DVec2::INFINITY, DVec2::min);
        let high = ring.iter().copied().map(cell).fold(DVec2::NEG_INFINITY, DVec2::max);
        if ring.len() < 3 {
            return;
        }
        for row in low.y as i64..=high.y as i64 {
            for column in low.x as i64..=high.x as i64 {
                if self.is_full() {
                    return;
                }
                self.work += 1;
                let corner = spacing_m * DVec2::new(column as f64, row as f64);
                if !around.is_near_people(corner) {
                    continue;
                }
                self.work += sides;
                let number = (column as u64 & 0xffff_ffff) << 32 | row as u64 & 0xffff_ffff;
                let mut stream = Seed([0; 32]).child("wood", number).stream("place");
                let mut aside_m = || spacing_m * stream.uniform(0.17, 0.83);
                let at = corner + DVec2::new(aside_m(), aside_m());
                if area.contains(at) && frame.holds(at, LINE_MARGIN_M) && around.has_room(at) {
                    self.places.insert(number, at);
                }
            }
        }
    }
}

/// Where plants may stand.
struct Around {
    roads: RoadIndex,
    walkable: PolygonIndex,
    /// Walkable ground as flat boxes, for distances.
    ground: BoxBvh,
    solid: BoxBvh,
}

impl Around {
    fn new<'a>(roads: &[Road<'_>], paths: &Paths, solid: impl Iterator<Item = &'a Obstacle>) -> Self {
        let outlines: Vec<Vec<DVec2>> = paths.walkable.iter().map(|area| area.plan()).collect();
        let flat = |outline: &Vec<DVec2>| {
            let low = outline.iter().copied().fold(DVec2::INFINITY, DVec2::min);
            let high = outline.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
            OrientedBox::from_corners(low.extend(0.0), high.extend(0.1))
        };
        let ground = BoxBvh::build(outlines.iter().map(flat).collect());
        let solid = BoxBvh::build(solid.map(|one| one.shape).collect());
        Self { roads: RoadIndex::new(roads), walkable: PolygonIndex::new(outlines), ground, solid }
    }

    fn is_near_people(&self, at: DVec2) -> bool {
        self.ground.nearest(at.extend(0.0), NEAR_M).is_some()
    }

    /// Whether paths, streets and houses are far enough away.
    fn has_room(&self, at: DVec2) -> bool {
        let point = at.extend(1.0);
        let sides = [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y];
        let beside = sides.map(|side| [0.5, 1.0].map(|share| at + share * CLEAR_M * side));
        let mut near = beside.iter().flatten().chain([&at]);
        self.solid.nearest(point, CLEAR_M).is_none()
            && near.all(|at| !self.roads.is_road(*at, |_| true) && self.walkable.at(*at).next().is_none())
    }
}

#[cfg(test)]
mod tests {
    use crate::osm::tests::{RING, osm, read, way};
    use cosfly_domain::{ObstacleKind, SemanticLabel};

    #[test]
    fn woods_have_trees_beside_their_paths_and_land_is_seen_by_its_use() {
        let nodes = [(1, -12, -12), (2, 12, -12), (3, 12, 12), (4, -12, 12), (5, -15, 0), (6, 15, 0)];
        let area = |tags: &[(&str, &str)]| way(10, &RING, tags);
        let path = way(11, &[5, 6], &[("highway", "path")]);
        let (town, _) = read(osm(&nodes, &(area(&[("natural", "wood")]) + &path)).as_bytes()).unwrap();
        let trunks: Vec<_> = town.obstacles.iter().filter(|one| one.kind == ObstacleKind::TreeTrunk).collect();
        // 266 m square, of which 160 m are near the path: a tree for each 64 m2, but not on the path.
        assert!((580..720).contains(&trunks.len()), "{}", trunks.len());
        assert!(trunks.iter().all(|one| one.synthetic && one.shape.center_in_world.y.abs() > 1.5));
        assert!(town.synthetic.notes.iter().any(|note| note.contains("trees of woods are invented")));
        let (town, _) = read(osm(&nodes, &(area(&[("natural", "scrub")]) + &path)).as_bytes()).unwrap();
        let bushes = town.obstacles.iter().filter(|one| one.kind == ObstacleKind::Bush);
        // One for each 16 m2 of the same ground.
        assert!((2300..2900).contains(&bushes.clone().count()), "{}", bushes.count());
        assert!(bushes.clone().all(|one| one.synthetic && one.shape.center_in_world.y.abs() > 1.5));
        for (tags, label) in [
            (&[("leisure", "park")][..], SemanticLabel::Terrain),
            (&[("natural", "beach")], SemanticLabel::Ground),
            (&[("leisure", "pitch")], SemanticLabel::Ground),
            (&[("leisure", "pitch"), ("surface", "grass")], SemanticLabel::Terrain),
            (&[("landuse", "basin")], SemanticLabel::Water),
        ] {
            let (town, _) = read(osm(&nodes, &(area(tags) + &path)).as_bytes()).unwrap();
            let is_there = town.surfaces.iter().any(|mesh| mesh.label == label && !mesh.synthetic);
            assert!(is_there && town.obstacles.is_empty(), "{tags:?}");
        }
    }
}
