//! Invented pavements beside the carriageways, for files that have no ground for pedestrians.

use super::network::{LaneSection, Road, RoadLaneKind, RoadNetwork};
use super::stations::{CrossSection, StationBudget, cross_sections};
use super::surfaces::{DEFAULT_KERB_M, SKIRT_M};
use super::walkable::{pieces, without_repeats};
use cosfly_domain::{SemanticLabel, WalkableKind, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::world::WorldFromMap;
use cosfly_town::{GroundIndex, MapError};

/// Width of an invented pavement, metres.
pub(super) const WIDTH_M: f64 = 2.0;
/// Longest piece that is kept or left out as a whole, metres.
const LONGEST_M: f64 = 2.5;
/// Roads this far above or below do not meet the pavement, metres.
const LEVEL_M: f64 = 0.8;

/// A cross-section of an invented pavement: the edge of the carriageway, then both edges of the top, in the world.
struct Row {
    s_m: f64,
    t_m: [f64; 2],
    carriageway: DVec3,
    top: [DVec3; 2],
}

/// Pavements outside of the outermost carriageway of each side of each road, but not on other roads; the second value
/// is their length, metres.
pub(super) fn verges(
    network: &RoadNetwork,
    ground: &GroundIndex,
    world: &WorldFromMap,
    budget: &mut StationBudget,
    meshes: &mut MeshBuilder,
) -> Result<(Vec<WalkablePolygon>, f64), MapError> {
    let (mut out, mut length_m) = (Vec::new(), 0.0);
    for road in &network.roads {
        for section in &road.sections {
            let stations = cross_sections(road, section, LONGEST_M, budget)?;
            for side in 0..2 {
                let rows = rows(road, section, side, &stations, world);
                for run in rows.chunk_by(|low, high| is_free(low, high, ground)).filter(|run| run.len() > 1) {
                    add_surface(meshes, run);
                    out.extend(polygons(run));
                    length_m +=
                        run.windows(2).map(|pair| pair[0].carriageway.distance(pair[1].carriageway)).sum::<f64>();
                }
            }
        }
    }
    Ok((out, length_m))
}

fn rows(road: &Road, section: &LaneSection, side: usize, stations: &[CrossSection], world: &WorldFromMap) -> Vec<Row> {
    let (sign, lanes) = section.sides()[side];
    let Some(last) = lanes.iter().rposition(|lane| lane.kind == RoadLaneKind::Carriageway) else { return Vec::new() };
    let row = |station: &CrossSection| {
        let (edge, inner_t_m) = (station.points[side][last][1], station.spans[side][last].t_m[1]);
        let t_m = [inner_t_m, inner_t_m + sign * WIDTH_M];
        let at = |t_m: f64| world.point(road.plan_position(station.s_m, t_m).extend(edge.z + DEFAULT_KERB_M));
        Row { s_m: station.s_m, t_m, carriageway: world.point(edge), top: t_m.map(at) }
    };
    stations.iter().map(row).collect()
}

/// Whether a pavement fits between two cross-sections: it is not folded in a tight bend and lies on no road.
fn is_free(low: &Row, high: &Row, ground: &GroundIndex) -> bool {
    let along = |edge: usize| (high.top[edge] - low.top[edge]).truncate();
    let is_road = |point: DVec3| {
        ground.ground_near(point).is_some_and(|near| {
            (near.height_m - point.z).abs() < LEVEL_M
                && matches!(near.label, SemanticLabel::Roads | SemanticLabel::RoadLine | SemanticLabel::Bridge)
        })
    };
    let mut places = [0.05, 0.5, 0.95].into_iter().flat_map(|u| [0.1, 0.5, 1.0].map(|v| (u, v)));
    along(0).dot(along(1)) > 0.0
        && !places.any(|(u, v)| is_road(low.top[0].lerp(low.top[1], v).lerp(high.top[0].lerp(high.top[1], v), u)))
}

fn polygons(run: &[Row]) -> Vec<WalkablePolygon> {
    let mut out = Vec::new();
    for piece in pieces(run, |row| row.s_m) {
        let outline = piece.iter().map(|row| row.top[0]).chain(piece.iter().rev().map(|row| row.top[1])).collect();
        let outline_in_world = without_repeats(outline);
        if outline_in_world.len() >= 3 {
            out.push(WalkablePolygon { kind: WalkableKind::Sidewalk, outline_in_world, synthetic: true });
        }
    }
    out
}

/// The top, the kerb, the skirt outside, and both ends.
fn add_surface(meshes: &mut MeshBuilder, run: &[Row]) {
    let mut quad = |corners: [(DVec3, DVec2); 4]| meshes.quad(SemanticLabel::SideWalks, true, corners);
    let top = |row: &Row, edge: usize| (row.top[edge], DVec2::new(row.s_m, row.t_m[edge]));
    let kerb = |row: &Row| (row.carriageway, DVec2::new(row.s_m, row.t_m[0]));
    let below = |(point, place): (DVec3, DVec2)| (point - (DEFAULT_KERB_M + SKIRT_M) * DVec3::Z, place);
    for pair in run.windows(2) {
        let [low, high] = [&pair[0], &pair[1]];
        quad([top(low, 0), top(high, 0), top(high, 1), top(low, 1)]);
        quad([top(low, 0), top(high, 0), kerb(high), kerb(low)]);
        quad([top(low, 1), top(high, 1), below(top(high, 1)), below(top(low, 1))]);
    }
    for end in [&run[0], &run[run.len() - 1]] {
        quad([top(end, 0), top(end, 1), below(top(end, 1)), below(top(end, 0))]);
    }
}
