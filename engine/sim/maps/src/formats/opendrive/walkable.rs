//! Ground for pedestrians: pavements in short pieces, shoulders on request, kerb strips that join them.

use super::network::{LaneSection, Road, RoadLane, RoadLaneKind};
use super::stations::CrossSection;
use cosfly_domain::{WalkableKind, WalkablePolygon};
use cosfly_frames::DVec3;
use cosfly_town::world::WorldFromMap;

/// Longest piece of pavement in one polygon, metres.
pub(super) const LONGEST_PIECE_M: f64 = 10.0;
/// Kerb strips up to this width beside a pavement belong to it, metres.
const KERB_STRIP_M: f64 = 0.6;
/// Narrower pieces than this are no ground to walk on, metres.
const NARROWEST_M: f64 = 0.05;

/// Kind of walkable ground of each lane of one side; `None` for lanes that are not walkable.
pub(super) fn walkable_lanes(
    lanes: &[RoadLane],
    rows: &[CrossSection],
    side: usize,
    shoulders: bool,
) -> Vec<Option<WalkableKind>> {
    let own = |lane: &RoadLane| match lane.kind {
        RoadLaneKind::Sidewalk => Some(WalkableKind::Sidewalk),
        RoadLaneKind::Shoulder if shoulders => Some(WalkableKind::Shoulder),
        _ => None,
    };
    let mut kinds: Vec<_> = lanes.iter().map(own).collect();
    for index in 0..lanes.len() {
        let beside = [index.checked_sub(1), Some(index + 1)].into_iter().flatten();
        let touches = beside.filter_map(|i| lanes.get(i)).any(|lane| lane.kind == RoadLaneKind::Sidewalk);
        let widest = rows.iter().map(|row| width_m(row, side, index)).fold(0.0, f64::max);
        if kinds[index].is_none() && lanes[index].kind == RoadLaneKind::Kerb && touches && widest <= KERB_STRIP_M {
            kinds[index] = Some(WalkableKind::Sidewalk);
        }
    }
    kinds
}

/// Whether a section has any walkable lane.
pub(super) fn has_walkable(section: &LaneSection, shoulders: bool) -> bool {
    let mut lanes = section.left.iter().chain(&section.right);
    lanes.any(|lane| lane.kind == RoadLaneKind::Sidewalk || shoulders && lane.kind == RoadLaneKind::Shoulder)
}

/// Adds the walkable pieces of one lane section; `rows` are at most [`LONGEST_PIECE_M`] apart.
pub(super) fn add_section(
    out: &mut Vec<WalkablePolygon>,
    road: &Road,
    section: usize,
    rows: &[CrossSection],
    shoulders: bool,
    world: &WorldFromMap,
) {
    for (side, (_, lanes)) in road.sections[section].sides().into_iter().enumerate() {
        for (index, kind) in walkable_lanes(lanes, rows, side, shoulders).into_iter().enumerate() {
            let Some(kind) = kind else { continue };
            for piece in pieces(rows, |row| row.s_m) {
                let widest = piece.iter().map(|row| width_m(row, side, index)).fold(0.0, f64::max);
                if widest < NARROWEST_M {
                    continue;
                }
                let edge = |outer: usize| piece.iter().map(move |row| row.points[side][index][outer]);
                let outline = edge(0).chain(edge(1).rev()).map(|point| world.point(point)).collect();
                let outline_in_world = without_repeats(outline);
                if outline_in_world.len() >= 3 {
                    out.push(WalkablePolygon { kind, outline_in_world, synthetic: false });
                }
            }
        }
    }
}

/// Runs of rows that span at most [`LONGEST_PIECE_M`]; neighbours share a row.
pub(super) fn pieces<R>(rows: &[R], s_m: impl Fn(&R) -> f64) -> Vec<&[R]> {
    let mut out = Vec::new();
    let mut first = 0;
    for last in 1..rows.len() {
        let is_end = last + 1 == rows.len();
        if is_end || s_m(&rows[last + 1]) - s_m(&rows[first]) > LONGEST_PIECE_M {
            out.push(&rows[first..=last]);
            first = last;
        }
    }
    out
}

fn width_m(row: &CrossSection, side: usize, lane: usize) -> f64 {
    let [inner, outer] = row.spans[side][lane].t_m;
    (outer - inner).abs()
}

/// The outline without corners that coincide with the one before.
pub(super) fn without_repeats(mut outline: Vec<DVec3>) -> Vec<DVec3> {
    outline.dedup_by(|a, b| a.distance_squared(*b) < 1e-8);
    while outline.len() > 1 && outline[0].distance_squared(outline[outline.len() - 1]) < 1e-8 {
        outline.pop();
    }
    outline
}
