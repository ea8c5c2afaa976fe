//! Carriageways: their widths, their surfaces, and what lies on one.

use super::elements::{CUT_OUT, Elements, Way};
use super::frame::Frame;
use super::stated::{Doubts, Quantity};
use super::strip::{add_surface, strips};
use super::tags::Tags;
use cosfly_domain::SemanticLabel;
use cosfly_frames::{DVec2, real};
use cosfly_town::MapError;
use cosfly_town::mesh::MeshBuilder;
use std::collections::BTreeMap;

/// Lines are kept so far beyond the stated bounds, metres.
pub const LINE_MARGIN_M: f64 = 30.0;
/// Most metres of roads and paths, all together.
const LONGEST_M: f64 = 2e7;
/// Height of carriageways, of paint on them, of rails, metres.
pub const ROAD_HEIGHT_M: f64 = 0.03;
const PAINT_HEIGHT_M: f64 = 0.04;
const RAIL_HEIGHT_M: f64 = 0.035;
/// Half the gauge of a track with its sleepers, metres.
const HALF_TRACK_M: f64 = 1.2;
/// Dash and gap of a middle line, and half its width, metres.
const DASH_M: [f64; 2] = [3.0, 6.0];
const HALF_DASH_M: f64 = 0.07;
/// Side of a cell of the index, metres.
const CELL_M: f64 = 16.0;

/// Width of a carriageway, and number of its lanes.
const WIDTH: Quantity =
    Quantity::length("streets", &["width"], [2.0, 60.0], "their lanes, of the usual width, make them as wide");
pub const LANES: Quantity =
    Quantity::number("streets", &["lanes"], [1.0, 12.0], "they have the usual number of their kind");

/// A carriageway inside the extract.
#[derive(Debug)]
pub struct Road<'e> {
    /// Its way.
    pub way: &'e Way,
    /// Its middle line, in the pieces that are inside and whole.
    pub pieces: Vec<Vec<DVec2>>,
    /// Half its width, metres.
    pub half_width_m: f64,
    /// Whether traffic goes one way only.
    pub is_oneway: bool,
    has_middle_line: bool,
}

/// Lanes, width of a lane in metres, whether a middle line is usual.
fn usual(class: &str) -> Option<(f64, f64, bool)> {
    Some(match class {
        "motorway" | "trunk" => (2.0, 3.5, true),
        "primary" | "secondary" => (2.0, 3.25, true),
        "tertiary" => (2.0, 3.0, true),
        "unclassified" | "residential" | "road" => (2.0, 2.75, false),
        "living_street" => (2.0, 2.5, false),
        "motorway_link" | "trunk_link" | "primary_link" | "secondary_link" | "tertiary_link" => (1.0, 4.0, false),
        "service" | "busway" | "bus_guideway" | "escape" => (1.0, 3.5, false),
        "raceway" => (1.0, 10.0, false),
        _ => return None,
    })
}

/// Whether people on foot use a street as if it were a pavement.
pub fn is_shared_street(tags: &Tags) -> bool {
    tags.is("highway", &["living_street"])
}

/// The carriageways of an extract.
///
/// # Errors
/// Absurdly many metres of them.
pub fn read<'e>(elements: &'e Elements, frame: &Frame, doubts: &mut Doubts) -> Result<Vec<Road<'e>>, MapError> {
    let mut roads = Vec::new();
    let mut length_m = 0.0;
    for way in &elements.ways {
        let Some((lanes, lane_m, has_middle_line)) = way.tags.get("highway").and_then(usual) else { continue };
        if !way.tags.is_on_the_ground() || way.tags.is("area", &["yes"]) {
            continue;
        }
        let pieces = lines(elements, frame, way, &mut length_m)?;
        if pieces.is_empty() {
            continue;
        }
        let is_oneway = way.tags.is("oneway", &["yes", "1", "-1"]) || way.tags.is("junction", &["roundabout"]);
        let usual_lanes = if is_oneway && !has_middle_line { 1.0 } else { lanes };
        let name = format_args!("way {}", way.id);
        let stated_lanes = doubts.read(&way.tags, &LANES, name);
        let stated_m = doubts.read(&way.tags, &WIDTH, name);
        // A single lane of a minor street is wider: cars stand in it.
        let spare_m = if is_oneway && !has_middle_line && lanes > 1.0 { 1.25 } else { 0.0 };
        let width_m = stated_m.unwrap_or(stated_lanes.unwrap_or(usual_lanes) * lane_m + spare_m);
        let has_middle_line = has_middle_line && !is_oneway && stated_lanes.unwrap_or(lanes) >= 2.0;
        roads.push(Road { way, pieces, half_width_m: 0.5 * width_m, is_oneway, has_middle_line });
    }
    Ok(roads)
}

/// The pieces of a way that lie in the extract; a node that the file lacks ends a piece. Their length is added up.
///
/// # Errors
/// The sum is absurd.
pub fn lines(elements: &Elements, frame: &Frame, way: &Way, length_m: &mut f64) -> Result<Vec<Vec<DVec2>>, MapError> {
    let pieces = lines_of(elements, frame, &way.nodes);
    *length_m += pieces.iter().flat_map(|piece| piece.windows(2)).map(|pair| pair[0].distance(pair[1])).sum::<f64>();
    if *length_m > LONGEST_M {
        return Err(MapError::new(format!(
            "the ways of the file are longer than {} km (at way {})",
            LONGEST_M / 1000.0,
            way.id
        ))
        .hint(CUT_OUT));
    }
    Ok(pieces)
}

/// The pieces of a line of nodes that lie in the extract.
pub fn lines_of(elements: &Elements, frame: &Frame, nodes: &[i64]) -> Vec<Vec<DVec2>> {
    let mut pieces = Vec::new();
    for run in nodes.split(|id| elements.node(*id).is_none()) {
        let points: Vec<DVec2> = run.iter().filter_map(|id| frame.position(elements, *id)).collect();
        pieces.extend(frame.clipped_line(&points, LINE_MARGIN_M));
    }
    pieces
}

/// Adds the surfaces of carriageways, rounded at their ends, with dashed middle lines.
pub fn add_surfaces(meshes: &mut MeshBuilder, roads: &[Road<'_>]) {
    let ends = widths_at_ends(roads);
    for road in roads {
        for piece in &road.pieces {
            for strip in strips(piece, road.half_width_m) {
                add_surface(meshes, SemanticLabel::Roads, false, &strip, ROAD_HEIGHT_M);
            }
            if road.has_middle_line {
                add_dashes(meshes, piece);
            }
        }
    }
    for (place, widths) in ends {
        if let [narrowest, _, ..] = widths[..] {
            add_disc(meshes, DVec2::new(f64::from_bits(place.0), f64::from_bits(place.1)), narrowest);
        }
    }
}

/// Half widths of the roads that end at each place, ascending.
fn widths_at_ends(roads: &[Road<'_>]) -> BTreeMap<(u64, u64), Vec<f64>> {
    let mut ends: BTreeMap<(u64, u64), Vec<f64>> = BTreeMap::new();
    for road in roads {
        for end in road.pieces.iter().flat_map(|piece| [piece.first(), piece.last()]).flatten() {
            ends.entry((end.x.to_bits(), end.y.to_bits())).or_default().push(road.half_width_m);
        }
    }
    ends.values_mut().for_each(|widths| widths.sort_by(f64::total_cmp));
    ends
}

fn add_disc(meshes: &mut MeshBuilder, middle: DVec2, radius_m: f64) {
    const CORNERS: u32 = 12;
    let corners: Vec<(cosfly_frames::DVec3, DVec2)> = (0..CORNERS)
        .map(|corner| {
            let (sin, cos) = real::sin_cos(f64::from(corner) / f64::from(CORNERS) * real::TAU);
            let aside = radius_m * DVec2::new(cos, sin);
            ((middle + aside).extend(ROAD_HEIGHT_M), aside)
        })
        .collect();
    let triangles: Vec<[u32; 3]> = (1..CORNERS - 1).map(|corner| [0, corner, corner + 1]).collect();
    meshes.polygon(SemanticLabel::Roads, false, &corners, &triangles);
}

fn add_dashes(meshes: &mut MeshBuilder, line: &[DVec2]) {
    let [dash_m, gap_m] = DASH_M;
    let mut at_m = 0.0;
    for pair in line.windows(2) {
        let length_m = pair[0].distance(pair[1]);
        let along = (pair[1] - pair[0]).normalize_or_zero();
        // The first dash that reaches into this side.
        let mut begin_m = (at_m / (dash_m + gap_m)).floor() * (dash_m + gap_m) - at_m;
        while begin_m < length_m {
            let (from, to) = (begin_m.max(0.0), (begin_m + dash_m).min(length_m));
            if to > from {
                for strip in strips(&[pair[0] + from * along, pair[0] + to * along], HALF_DASH_M) {
                    add_surface(meshes, SemanticLabel::RoadLine, false, &strip, PAINT_HEIGHT_M);
                }
            }
            begin_m += dash_m + gap_m;
        }
        at_m += length_m;
    }
}

/// Adds the tracks of railways and trams.
///
/// # Errors
/// Absurdly many metres of them.
pub fn add_rails(meshes: &mut MeshBuilder, elements: &Elements, frame: &Frame) -> Result<(), MapError> {
    let mut length_m = 0.0;
    for way in &elements.ways {
        if way.tags.is("railway", &["rail", "tram", "light_rail", "narrow_gauge", "funicular"])
            && way.tags.is_on_the_ground()
        {
            for piece in lines(elements, frame, way, &mut length_m)? {
                for strip in strips(&piece, HALF_TRACK_M) {
                    add_surface(meshes, SemanticLabel::RailTrack, false, &strip, RAIL_HEIGHT_M);
                }
            }
        }
    }
    Ok(())
}

/// Finds the carriageway at a point.
#[derive(Debug, Default)]
pub struct RoadIndex {
    segments: Vec<Segment>,
    cells: BTreeMap<(i32, i32), Vec<u32>>,
}

#[derive(Clone, Copy, Debug)]
struct Segment {
    from: DVec2,
    to: DVec2,
    half_width_m: f64,
    way: i64,
    is_oneway: bool,
}

impl RoadIndex {
    /// An index over roads.
    pub fn new(roads: &[Road<'_>]) -> Self {
        let mut index = Self::default();
        for road in roads {
            for pair in road.pieces.iter().flat_map(|piece| piece.windows(2)) {
                index.add(pair[0], pair[1], road);
            }
        }
        index
    }

    /// Adds a side in pieces no longer than a cell, so that slanted ones touch few cells.
    fn add(&mut self, from: DVec2, to: DVec2, road: &Road<'_>) {
        let (half_width_m, way, is_oneway) = (road.half_width_m, road.way.id, road.is_oneway);
        let count = (from.distance(to) / CELL_M).ceil().max(1.0) as usize;
        for piece in 0..count {
            let at = |step: usize| from.lerp(to, step as f64 / count as f64);
            let segment = Segment { from: at(piece), to: at(piece + 1), half_width_m, way, is_oneway };
            let number = self.segments.len() as u32;
            let low = cell(segment.from.min(segment.to) - half_width_m);
            let high = cell(segment.from.max(segment.to) + half_width_m);
            for row in low.1..=high.1 {
                for column in low.0..=high.0 {
                    self.cells.entry((column, row)).or_default().push(number);
                }
            }
            self.segments.push(segment);
        }
    }

    /// Whether a point lies on the carriageway of another one-way street that runs along a direction, either way.
    pub fn is_parallel_oneway(&self, point: DVec2, own: i64, along: DVec2) -> bool {
        const PARALLEL_COS: f64 = 0.9;
        let near = self.cells.get(&cell(point)).into_iter().flatten().map(|number| &self.segments[*number as usize]);
        near.filter(|segment| segment.is_oneway && segment.way != own).any(|segment| {
            let direction = (segment.to - segment.from).normalize_or_zero();
            direction.dot(along).abs() > PARALLEL_COS
                && distance_m(point, segment.from, segment.to) < segment.half_width_m
        })
    }

    /// Whether a point lies on the carriageway of a way that `counts` accepts.
    pub fn is_road(&self, point: DVec2, counts: impl Fn(i64) -> bool) -> bool {
        let near = self.cells.get(&cell(point)).into_iter().flatten().map(|number| &self.segments[*number as usize]);
        near.into_iter()
            .any(|segment| counts(segment.way) && distance_m(point, segment.from, segment.to) < segment.half_width_m)
    }
}

fn cell(point: DVec2) -> (i32, i32) {
    ((point.x / CELL_M).floor() as i32, (point.y / CELL_M).floor() as i32)
}

fn distance_m(point: DVec2, from: DVec2, to: DVec2) -> f64 {
    let along = to - from;
    let share = ((point - from).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
    point.distance(from + share * along)
}
