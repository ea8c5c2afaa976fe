//! Ground for people: paths, pedestrian areas, crossings, pavements.

use super::carved::Carriageways;
use super::elements::{Elements, Way};
use super::frame::Frame;
use super::options::OsmOptions;
use super::pavements::{self, LONGEST_CROSSING_M, PAVEMENT_M, runs};
use super::rings::{Area, Problems, areas};
use super::roads::{LINE_MARGIN_M, Road, RoadIndex, is_shared_street, lines};
use super::stated::Quantity;
use super::strip::{add_surface, strips, walkable};
use super::tags::Tags;
use crate::slabs::{Trapezoid, trapezoids};
use cosfly_domain::{SemanticLabel, WalkableKind, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::MapError;
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::polygons::twice_area_m2;
use std::collections::{BTreeMap, BTreeSet};

/// Height of pavements and paths, and of crossings, metres.
const PAVEMENT_HEIGHT_M: f64 = 0.12;
const CROSSING_HEIGHT_M: f64 = 0.045;
/// Less ground of its own than this, and a file gets pavements along its streets, square metres.
const ENOUGH_M2: f64 = 300.0;
/// Width of a crossing that is a point of a street, metres, and how far it reaches beyond the carriageway.
const CROSSING_M: f64 = 3.0;
const CROSSING_REACH_M: f64 = 1.5;
/// Stripes of a marked crossing: width of a stripe, metres.
const STRIPE_M: f64 = 0.5;

/// Width of a path.
const WIDTH: Quantity = Quantity::length("paths", &["width"], [1.2, 30.0], "they have the usual width of their kind");

/// The ground for people of an extract.
#[derive(Debug, Default)]
pub struct Paths {
    /// Polygons.
    pub walkable: Vec<WalkablePolygon>,
    /// Nodes that paths and roads go through: barriers are open there.
    pub nodes: BTreeSet<i64>,
    /// In words, what was invented.
    pub notes: Vec<String>,
}

/// A piece of a path.
struct Path<'l> {
    line: &'l [DVec2],
    kind: WalkableKind,
    width_m: f64,
    is_marked: bool,
    /// Whether it begins, and ends, where no other path goes on.
    ends_alone: [bool; 2],
}

/// Kind and usual width in metres of the ground along a way; none where people do not walk.
fn usual(tags: &Tags) -> Option<(WalkableKind, f64)> {
    if tags.is("foot", &["no"]) || !tags.is_on_the_ground() {
        return None;
    }
    let for_people = tags.is("foot", &["yes", "designated", "permissive"]);
    let is_crossing = ["footway", "highway"].iter().any(|key| tags.is(key, &["crossing", "traffic_island"]));
    let platform = tags.is("railway", &["platform"]) || tags.is("public_transport", &["platform"]);
    match tags.get("highway") {
        Some("footway" | "path" | "cycleway" | "crossing") if is_crossing => Some((WalkableKind::Crossing, CROSSING_M)),
        Some("footway" | "steps") => Some((WalkableKind::Sidewalk, 2.2)),
        Some("path") => Some((WalkableKind::Sidewalk, 1.8)),
        Some("pedestrian") => Some((WalkableKind::Plaza, 5.0)),
        Some("platform") => Some((WalkableKind::Sidewalk, 2.5)),
        Some("cycleway" | "bridleway") if for_people => Some((WalkableKind::Sidewalk, 2.8)),
        Some("track") => Some((WalkableKind::Shoulder, 2.5)),
        None if platform => Some((WalkableKind::Sidewalk, 2.5)),
        _ => None,
    }
}

/// Width of the ground along a way, metres; none where people do not walk.
pub fn usual_width_m(tags: &Tags) -> Option<f64> {
    usual(tags).map(|(_, usual_m)| tags.stated(&WIDTH).unwrap_or(usual_m))
}

/// Kind of the ground of an area; none where it is not for people.
fn kind_of_area(tags: &Tags) -> Option<WalkableKind> {
    if !tags.is_on_the_ground() || tags.is("foot", &["no"]) {
        return None;
    }
    match tags.get("area:highway") {
        Some("footway" | "path" | "pedestrian" | "traffic_island" | "steps" | "prohibited") => {
            return Some(WalkableKind::Sidewalk);
        }
        Some("crossing") => return Some(WalkableKind::Crossing),
        _ => {}
    }
    let is_area = tags.is("area", &["yes"]) || tags.is("type", &["multipolygon"]);
    let platform = tags.is("railway", &["platform"]) || tags.is("public_transport", &["platform"]);
    match tags.get("highway") {
        Some("pedestrian" | "footway" | "path" | "steps" | "platform") if is_area => Some(WalkableKind::Plaza),
        None if platform => Some(WalkableKind::Plaza),
        _ => None,
    }
}

/// Reads all ground for people and adds its surfaces.
///
/// # Errors
/// Absurdly many metres of paths.
pub fn read(
    elements: &Elements,
    frame: &Frame,
    roads: &[Road<'_>],
    options: &OsmOptions,
    meshes: &mut MeshBuilder,
    problems: &mut Problems,
) -> Result<Paths, MapError> {
    let index = RoadIndex::new(roads);
    let mut out = Paths::default();
    let mut length_m = 0.0;
    let arms = arms(elements);
    for way in elements.ways.iter().filter(|way| is_path(way)) {
        let Some((kind, usual_m)) = usual(&way.tags) else { continue };
        let pieces = lines(elements, frame, way, &mut length_m)?;
        out.nodes.extend(&way.nodes);
        let ends = [way.nodes.first(), way.nodes.last()].map(|id| {
            let alone = id.filter(|id| arms.get(*id) == Some(&1) && !is_crossing_node(elements, **id));
            alone.and_then(|id| frame.position(elements, *id))
        });
        if pieces.is_empty() {
            continue;
        }
        let stated_m = problems.doubts.read(&way.tags, &WIDTH, format_args!("way {}", way.id));
        let width_m = stated_m.unwrap_or(usual_m);
        for piece in pieces {
            let ends_alone = [piece.first(), piece.last()].map(|end| end.is_some() && ends.contains(&end.copied()));
            let path = Path { line: &piece, kind, width_m, is_marked: is_marked(&way.tags), ends_alone };
            out.add_path(&path, &index, meshes);
        }
    }
    for road in roads {
        out.nodes.extend(&road.way.nodes);
        if is_shared_street(&road.way.tags) {
            for strip in road.pieces.iter().flat_map(|piece| strips(piece, road.half_width_m)) {
                out.walkable.push(walkable(WalkableKind::Shoulder, false, &strip, CROSSING_HEIGHT_M));
            }
        }
    }
    let carriageways = Carriageways::new(roads);
    let mut cut = [0; 2];
    for area in areas(elements, frame, |tags| kind_of_area(tags).is_some(), problems) {
        let crossings = out.add_area(&area, frame, &carriageways, meshes, problems);
        cut = [cut[0] + usize::from(crossings.is_some()), cut[1] + crossings.unwrap_or(0)];
    }
    if cut[0] > 0 {
        out.notes.push(format!(
            "{} areas for people are cut where carriageways lead over them; {} crossings, {CROSSING_M} m wide, join their parts",
            cut[0], cut[1]
        ));
    }
    out.add_crossing_nodes(elements, frame, roads, meshes);
    let area_m2: f64 = out.walkable.iter().map(|polygon| 0.5 * twice_area_m2(&polygon.plan()).abs()).sum();
    let has_stated = out.add_pavements(roads, &index, options.assume_pavements, meshes);
    if area_m2 < ENOUGH_M2 && !has_stated && !options.assume_pavements {
        out.add_pavements(roads, &index, true, meshes);
    }
    Ok(out)
}

/// Whether a way is a line for people, and not the rim of an area.
fn is_path(way: &Way) -> bool {
    usual(&way.tags).is_some() && !(kind_of_area(&way.tags).is_some() && way.is_closed())
}

/// How many stretches of paths leave each node.
fn arms(elements: &Elements) -> BTreeMap<i64, usize> {
    let mut arms: BTreeMap<i64, usize> = BTreeMap::new();
    for way in elements.ways.iter().filter(|way| is_path(way)) {
        let last = way.nodes.len().saturating_sub(1);
        for (place, id) in way.nodes.iter().enumerate() {
            *arms.entry(*id).or_default() += if place == 0 || place == last { 1 } else { 2 };
        }
    }
    arms
}

fn is_crossing_node(elements: &Elements, id: i64) -> bool {
    elements.tags_of_node(id).is_some_and(|tags| tags.is("highway", &["crossing"]))
}

fn is_marked(tags: &Tags) -> bool {
    let unmarked = tags.is("crossing", &["unmarked", "no"]) || tags.is("crossing:markings", &["no"]);
    !unmarked && (tags.get("crossing").is_some() || tags.has("crossing:markings"))
}

impl Paths {
    /// A path; where it leads over a carriageway it is a crossing. One that ends on a carriageway where no other path goes on
    /// ends at the kerb. A pedestrian street that goes along a carriageway is one all the way.
    fn add_path(&mut self, path: &Path<'_>, index: &RoadIndex, meshes: &mut MeshBuilder) {
        let runs = runs(path.line, |point| index.is_road(point, |_| true));
        let last = runs.len().saturating_sub(1);
        for (number, (is_road, points)) in runs.into_iter().enumerate() {
            let [begins, ends] = path.ends_alone;
            let is_whole = number == 0 && number == last;
            if is_road && !is_whole && (number == 0 && begins || number == last && ends) {
                continue;
            }
            let length_m: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
            let is_along = path.kind == WalkableKind::Plaza && length_m > LONGEST_CROSSING_M;
            let is_crossing = is_road && !is_along || path.kind == WalkableKind::Crossing;
            let kind = if is_crossing { WalkableKind::Crossing } else { path.kind };
            self.add_strips(&points, kind, path.width_m, false, meshes);
            if is_road && path.is_marked {
                add_stripes(meshes, &points, path.width_m);
            }
        }
    }

    fn add_strips(
        &mut self,
        line: &[DVec2],
        kind: WalkableKind,
        width_m: f64,
        synthetic: bool,
        meshes: &mut MeshBuilder,
    ) {
        for strip in strips(line, 0.5 * width_m) {
            add_surface(meshes, label(kind), synthetic, &strip, height_m(kind));
            self.walkable.push(walkable(kind, synthetic, &strip, height_m(kind)));
        }
    }

    /// Ground over an area. Where carriageways lead over it they cut it, and crossings join its parts; gives their number then.
    fn add_area(
        &mut self,
        area: &Area<'_>,
        frame: &Frame,
        carriageways: &Carriageways<'_>,
        meshes: &mut MeshBuilder,
        problems: &mut Problems,
    ) -> Option<usize> {
        let kind = kind_of_area(area.tags)?;
        let ground = pieces_of(area, frame, problems);
        if ground.is_empty() {
            return None;
        }
        let is_over_streets = kind == WalkableKind::Crossing || area.tags.is("area:highway", &["traffic_island"]);
        let Some(pieces) = carriageways.cut(&ground).filter(|_| !is_over_streets) else {
            ground.iter().for_each(|piece| add_trapezoid(meshes, label(kind), piece, height_m(kind)));
            self.add_outline(area, kind, frame);
            return None;
        };
        for piece in pieces {
            let vertices: Vec<(DVec3, DVec2)> =
                piece.iter().map(|corner| (corner.extend(height_m(kind)), *corner)).collect();
            let fan: Vec<[u32; 3]> = (2..piece.len() as u32).map(|corner| [0, corner - 1, corner]).collect();
            meshes.polygon(label(kind), false, &vertices, &fan);
            let outline_in_world = vertices.into_iter().map(|(corner, _)| corner).collect();
            self.walkable.push(WalkablePolygon { kind, outline_in_world, synthetic: false });
        }
        let crossings = carriageways.ways_across(area, CROSSING_REACH_M);
        for line in &crossings {
            self.add_strips(line, WalkableKind::Crossing, CROSSING_M, true, meshes);
        }
        Some(crossings.len())
    }

    /// One outline around an area with bridges to its holes, which run the other way round.
    fn add_outline(&mut self, area: &Area<'_>, kind: WalkableKind, frame: &Frame) {
        let oriented = |ring: &[DVec2], is_positive: bool| {
            let mut ring = ring.to_vec();
            if (twice_area_m2(&ring) > 0.0) != is_positive {
                ring.reverse();
            }
            ring
        };
        let mut outline = oriented(&area.outer, true);
        let first = outline[0];
        for hole in &area.holes {
            let hole = oriented(hole, false);
            outline.push(first);
            outline.extend(&hole);
            outline.push(hole[0]);
        }
        let plan = frame.clipped_ring(&outline, LINE_MARGIN_M);
        if plan.len() >= 3 {
            let outline_in_world = plan.iter().map(|corner| corner.extend(height_m(kind))).collect();
            self.walkable.push(WalkablePolygon { kind, outline_in_world, synthetic: false });
        }
    }

    /// Crossings that are a point of a street and not a line of their own.
    fn add_crossing_nodes(&mut self, elements: &Elements, frame: &Frame, roads: &[Road<'_>], meshes: &mut MeshBuilder) {
        // A path that ends there leads to the crossing, and is not it.
        let arms = arms(elements);
        for road in roads {
            for (place, id) in road.way.nodes.iter().enumerate() {
                if !is_crossing_node(elements, *id) || arms.get(id).is_some_and(|count| *count > 1) {
                    continue;
                }
                let Some(at) = frame.position(elements, *id).filter(|at| frame.holds(*at, LINE_MARGIN_M)) else {
                    continue;
                };
                let beside = |place: Option<usize>| {
                    place.and_then(|place| road.way.nodes.get(place)).and_then(|id| frame.position(elements, *id))
                };
                let (before, after) = (beside(place.checked_sub(1)), beside(place.checked_add(1)));
                let along = (after.unwrap_or(at) - before.unwrap_or(at)).normalize_or_zero();
                let aside = (road.half_width_m + CROSSING_REACH_M) * along.perp();
                let line = [at - aside, at + aside];
                self.add_strips(&line, WalkableKind::Crossing, CROSSING_M, false, meshes);
                if elements.tags_of_node(*id).is_some_and(is_marked) {
                    let aside = road.half_width_m * along.perp();
                    add_stripes(meshes, &[at - aside, at + aside], CROSSING_M);
                }
            }
        }
    }

    /// Pavements beside streets. Gives whether there were any.
    fn add_pavements(&mut self, roads: &[Road<'_>], index: &RoadIndex, assume: bool, meshes: &mut MeshBuilder) -> bool {
        let lines = pavements::lines(roads, index, assume);
        let (mut crossings, mut invented) = (0, 0);
        for line in &lines {
            let kind = if line.is_crossing { WalkableKind::Crossing } else { WalkableKind::Sidewalk };
            crossings += usize::from(line.is_crossing);
            invented += usize::from(line.is_invented && !line.is_crossing);
            self.add_strips(&line.points, kind, PAVEMENT_M, line.is_invented, meshes);
        }
        if crossings > 0 {
            self.notes.push(format!("{crossings} unmarked crossings where a pavement meets a side street"));
        }
        if invented > 0 {
            self.notes.push(format!("{invented} pavements, {PAVEMENT_M} m wide, beside streets that state none"));
        }
        !lines.is_empty()
    }
}

/// Stripes of a marked crossing along a line over a carriageway.
fn add_stripes(meshes: &mut MeshBuilder, line: &[DVec2], width_m: f64) {
    for pair in line.windows(2) {
        let (length_m, along) = (pair[0].distance(pair[1]), (pair[1] - pair[0]).normalize_or_zero());
        let count = (length_m / (2.0 * STRIPE_M)).floor() as usize;
        for stripe in 0..count {
            let from = pair[0] + (2.0 * STRIPE_M * stripe as f64 + 0.5 * STRIPE_M) * along;
            for strip in strips(&[from, from + STRIPE_M * along], 0.5 * width_m) {
                add_surface(meshes, SemanticLabel::RoadLine, false, &strip, CROSSING_HEIGHT_M + 0.005);
            }
        }
    }
}

/// Adds the ground of an area with holes at a height; gives whether there is any.
pub fn add_ground(
    meshes: &mut MeshBuilder,
    label: SemanticLabel,
    (area, height_m): (&Area<'_>, f64),
    frame: &Frame,
    problems: &mut Problems,
) -> bool {
    let pieces = pieces_of(area, frame, problems);
    for piece in &pieces {
        add_trapezoid(meshes, label, piece, height_m);
    }
    !pieces.is_empty()
}

/// The pieces of an area with holes inside the extract; none where there are absurdly many, which is a problem.
fn pieces_of(area: &Area<'_>, frame: &Frame, problems: &mut Problems) -> Vec<Trapezoid> {
    let clipped: Vec<Vec<DVec2>> = area
        .rings()
        .iter()
        .map(|ring| frame.clipped_ring(ring, LINE_MARGIN_M))
        .filter(|ring| ring.len() >= 3)
        .collect();
    let rings: Vec<&[DVec2]> = clipped.iter().map(Vec::as_slice).collect();
    trapezoids(&rings).unwrap_or_else(|| {
        problems.too_crooked.add(area.source);
        Vec::new()
    })
}

/// Adds a piece of ground at a height.
pub fn add_trapezoid(meshes: &mut MeshBuilder, label: SemanticLabel, piece: &Trapezoid, height_m: f64) {
    let vertices = piece.map(|corner| (corner.extend(height_m), corner));
    meshes.polygon(label, false, &vertices, &[[0, 1, 3], [0, 3, 2]]);
}

/// The label under which ground is seen.
fn label(kind: WalkableKind) -> SemanticLabel {
    match kind {
        WalkableKind::Sidewalk | WalkableKind::Plaza => SemanticLabel::SideWalks,
        WalkableKind::Crossing | WalkableKind::Road => SemanticLabel::Roads,
        WalkableKind::Shoulder => SemanticLabel::Ground,
    }
}

fn height_m(kind: WalkableKind) -> f64 {
    match kind {
        WalkableKind::Sidewalk | WalkableKind::Plaza => PAVEMENT_HEIGHT_M,
        _ => CROSSING_HEIGHT_M,
    }
}
