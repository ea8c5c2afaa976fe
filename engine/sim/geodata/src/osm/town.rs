//! From elements to a town.

use super::elements::Elements;
use super::frame::{Frame, unbelieved_bounds};
use super::options::OsmOptions;
use super::passages::Passages;
use super::rings::{Problems, areas};
use super::tags::Tags;
use super::things::Things;
use super::{bare_streets, buildings, land, lanes, paths, roads, sea, things};
use crate::open_ground::add_open_ground;
use crate::slabs::trapezoids;
use cosfly_domain::{MapOrigin, Obstacle, SemanticLabel, Synthetic, Town, WalkableKind, WalkablePolygon};
use cosfly_frames::DVec2;
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::{MapError, terrain};

/// Height of water and of squares of asphalt, metres.
const WATER_HEIGHT_M: f64 = 0.0;
const PARKING_HEIGHT_M: f64 = 0.02;

/// The town of a file, and warnings.
///
/// # Errors
/// A file of absurd extent or size, or with nothing to stand on and nothing to fly around.
pub fn town(elements: &Elements, options: &OsmOptions) -> Result<(Town, Vec<String>), MapError> {
    let frame = Frame::new(elements)?;
    let mut problems = Problems::default();
    let mut meshes = MeshBuilder::default();
    let mut next_id = 0;
    let roads = roads::read(elements, &frame, &mut problems.doubts)?;
    let mut passages = Passages::read(elements, &frame, &roads, &mut problems.doubts);
    let mut buildings = buildings::read(elements, &frame, options, &mut passages, &mut next_id, &mut problems)?;
    let mut paths = paths::read(elements, &frame, &roads, options, &mut meshes, &mut problems)?;
    let mut things = things::read(elements, &frame, &paths.nodes, options.storey_height_m, &mut next_id)?;
    let around = (roads.as_slice(), &paths, buildings.obstacles.as_slice());
    let plants = land::add_plants(elements, &frame, &mut things, around);
    land::add_surfaces(elements, &frame, &mut meshes, &mut problems);
    add_ground(elements, &frame, &mut meshes, &mut problems);
    roads::add_surfaces(&mut meshes, &roads);
    roads::add_rails(&mut meshes, elements, &frame)?;
    if buildings.obstacles.is_empty() && roads.is_empty() && paths.walkable.is_empty() && things.obstacles.is_empty() {
        return Err(MapError::new("the file has no houses, streets, paths or trees")
            .hint("export an area with its nodes, ways and relations, not one layer of it"));
    }
    let mut notes = notes(&buildings, &things, options);
    let of_things = [std::mem::take(&mut things.upstairs), std::mem::take(&mut things.closed)];
    let doubts_of_things = std::mem::take(&mut things.doubts);
    problems.doubts.add_levels(elements);
    let mut obstacles: Vec<Obstacle> = std::mem::take(&mut buildings.obstacles);
    obstacles.extend(things.obstacles);
    notes.extend(plants);
    notes.append(&mut paths.notes);
    notes.push(one_level(elements));
    notes.push(passages.note());
    let coarseness = terrain::add_terrain(&mut meshes, &obstacles, terrain::USUAL_MARGIN_M)?;
    let surfaces = meshes.finish();
    if paths.walkable.is_empty() {
        notes.push(add_open_ground(&mut paths.walkable, &obstacles, &surfaces));
    }
    if paths.walkable.is_empty() {
        notes.push("the whole ground is for people: the file has neither paths nor streets".to_owned());
        paths.walkable.push(whole_extract(&frame));
    }
    let bare_streets = bare_streets::warning(&roads, &paths.walkable, options);
    let town = Town {
        name: "town".to_owned(),
        origin: MapOrigin { geo_reference: Some(frame.projection.proj_text()), ..MapOrigin::default() },
        obstacles,
        walkable: paths.walkable,
        lanes: lanes::lanes(&roads, options.left_hand_traffic, &mut problems.doubts),
        surfaces,
        synthetic: Synthetic { notes, ..Synthetic::default() },
        ..Town::default()
    };
    let mut warnings = warnings(elements, &problems, &buildings, &of_things);
    warnings.extend(problems.doubts.warnings().chain(doubts_of_things.warnings()));
    warnings.extend(bare_streets);
    warnings.extend(coarseness);
    Ok((town, warnings))
}

/// Adds water, the sea, and asphalt that is no street.
fn add_ground(elements: &Elements, frame: &Frame, meshes: &mut MeshBuilder, problems: &mut Problems) {
    let is_water = |tags: &Tags| {
        let is_pool = tags.is("leisure", &["swimming_pool"]);
        let is_open = tags.is("natural", &["water"]) || tags.is("waterway", &["riverbank", "dock"]) || is_pool;
        (is_open || tags.is("landuse", &["reservoir", "basin"])) && tags.is_on_the_ground() && !tags.has("building")
    };
    let is_parking = |tags: &Tags| {
        let is_open =
            tags.is("amenity", &["parking"]) && !tags.has("building") && tags.get("building:levels").is_none();
        let on_streets = [
            "primary",
            "secondary",
            "tertiary",
            "residential",
            "service",
            "unclassified",
            "living_street",
            "emergency",
        ];
        (is_open || tags.is("area:highway", &on_streets)) && tags.is_on_the_ground()
    };
    for area in areas(elements, frame, is_water, problems) {
        paths::add_ground(meshes, SemanticLabel::Water, (&area, WATER_HEIGHT_M), frame, problems);
    }
    match sea::sea(elements, frame) {
        Some(sea::Sea { rings, led_on }) => {
            problems.coast_ends = led_on;
            let rings: Vec<&[DVec2]> = rings.iter().map(Vec::as_slice).collect();
            let pieces = trapezoids(&rings);
            problems.is_sea_too_crooked = pieces.is_none();
            for piece in pieces.unwrap_or_default() {
                paths::add_trapezoid(meshes, SemanticLabel::Water, &piece, WATER_HEIGHT_M);
            }
        }
        None => problems.is_coast_open = true,
    }
    for area in areas(elements, frame, is_parking, problems) {
        paths::add_ground(meshes, SemanticLabel::Roads, (&area, PARKING_HEIGHT_M), frame, problems);
    }
}

/// The whole extract as open ground.
fn whole_extract(frame: &Frame) -> WalkablePolygon {
    let (low, high) = (frame.low, frame.high);
    let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
    let outline_in_world = corners.map(|corner| corner.extend(0.0)).to_vec();
    WalkablePolygon { kind: WalkableKind::Plaza, outline_in_world, synthetic: true }
}

/// Note on bridges and tunnels, as a sentence.
fn one_level(elements: &Elements) -> String {
    let is_way = |tags: &Tags| tags.has("highway") || tags.has("railway");
    let count = |counts: &dyn Fn(&Tags) -> bool| {
        elements.ways.iter().filter(|way| is_way(&way.tags) && counts(&way.tags)).count()
    };
    let is_bridge = |tags: &Tags| tags.has("bridge") && !tags.is_hidden();
    format!(
        "everything stands on one level: the file has no heights of the ground; {} ways on bridges lie on it, {} in tunnels, \
         below it or on roofs are left out",
        count(&is_bridge),
        count(&|tags| !tags.is_on_the_ground())
    )
}

/// Notes on things that are not from the file, as sentences.
fn notes(buildings: &buildings::Buildings, things: &Things<'_>, options: &OsmOptions) -> Vec<String> {
    let mut notes = Vec::new();
    let mut add = |count: usize, line: String| {
        if count > 0 {
            notes.push(line);
        }
    };
    let (houses, parts) = (buildings.count, buildings.parts);
    let unknown = buildings.of_default_height;
    add(
        unknown,
        format!(
            "the heights of {unknown} of {houses} buildings and {parts} parts are assumed ({} m, garages and sheds at \
             most 3 m): the file states none",
            options.default_building_height_m
        ),
    );
    let guessed = buildings.of_guessed_rise;
    add(
        guessed,
        format!("the rise of {guessed} roofs is assumed (0.35 of the width, 1 to 5 m): the file states their shape"),
    );
    let (trees, rows) = (things.trees_of_assumed_height, things.trees_of_rows);
    add(
        things.trees,
        format!(
            "the heights of {trees} of {} trees (6 to 10 m) and the crowns of those that state none are assumed",
            things.trees
        ),
    );
    add(rows, format!("the places of {rows} trees in rows are assumed (8 m apart): the file states the rows"));
    notes
}

fn warnings(
    elements: &Elements,
    problems: &Problems,
    buildings: &buildings::Buildings,
    [upstairs, closed]: &[super::tally::Tally; 2],
) -> Vec<String> {
    let lacks = |way: &&super::elements::Way| way.nodes.iter().any(|id| elements.node(*id).is_none());
    let mut missing = super::tally::Tally::default();
    elements.ways.iter().filter(lacks).for_each(|way| missing.add(format_args!("way {}", way.id)));
    let hidden =
        (buildings.hidden > 0).then(|| format!("{} buildings lie under the ground and are left out", buildings.hidden));
    let lost = elements.without_place;
    let without_place = (lost > 0).then(|| format!("{lost} nodes have no usable place and are left out"));
    let unbelieved = unbelieved_bounds(elements);
    let strange_bounds = (unbelieved > 0)
        .then(|| format!("{unbelieved} bounds of the file are no area, or hold none of its nodes, and do not count"));
    [
        strange_bounds,
        elements.repeated.line("elements are in the file more than once; of each the highest version counts"),
        elements.of_repeated_tags().line("elements state a key twice; the first value counts"),
        missing.line("ways lack nodes in the file; their whole pieces are kept"),
        without_place,
        problems.incomplete.line("areas lack nodes or ways in the file; their whole rings are kept"),
        problems.empty.line("areas have no extent and are left out"),
        problems.crossed.line("rings cross themselves; they are filled by the even-odd rule"),
        problems.too_long.line("rings have too many corners and are left out"),
        buildings.open.line("buildings do not close and are left out"),
        buildings.far.line("buildings lie far outside the bounds of the file and are left out"),
        hidden,
        (problems.coast_ends > 0).then(|| {
            format!("{} ends of the coastline are led straight on to the edge of the extract", problems.coast_ends)
        }),
        problems.too_crooked.line("areas have too many corners for their ground to be filled, which is left out"),
        problems.is_sea_too_crooked.then(|| "the coastline has too many corners: the sea is left out".to_owned()),
        upstairs.line("things stand on roofs or upper storeys of a height that is not stated and are left out"),
        closed.line("barriers have more gates and paths through them than are opened"),
        problems.is_coast_open.then(|| "the coastline ends within the extract: the sea is left out".to_owned()),
    ]
    .into_iter()
    .flatten()
    .chain(buildings.coarse.warnings())
    .collect()
}
