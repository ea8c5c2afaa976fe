//! Meshes of the lanes: carriageway, raised pavements with kerb faces, green strips, skirts at the road's edge.

use super::network::{LaneHeight, Road, RoadLane, RoadLaneKind};
use super::road_geometry::LaneSpan;
use super::stations::CrossSection;
use cosfly_domain::SemanticLabel;
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::world::WorldFromMap;

/// Height of the skirt below a road's edge, so that no gap opens towards the terrain, metres.
pub(super) const SKIRT_M: f64 = 1.5;
/// Height of pavements in files that give none, metres.
pub(super) const DEFAULT_KERB_M: f64 = 0.15;

/// The label under which lane `index` of a side is seen. A lane without a kind that lies between paved ones (closed
/// roads of CARLA's towns) is paved as well; elsewhere it is green.
fn seen_label(side_lanes: &[RoadLane], index: usize) -> SemanticLabel {
    let paved = |lane: &RoadLane| matches!(lane.kind, RoadLaneKind::Carriageway | RoadLaneKind::Shoulder);
    let lane = &side_lanes[index];
    if lane.kind == RoadLaneKind::None && side_lanes[..index].iter().any(paved) && side_lanes[index..].iter().any(paved)
    {
        return SemanticLabel::Roads;
    }
    lane_label(lane)
}

/// The label of a lane by its own kind.
pub(super) fn lane_label(lane: &RoadLane) -> SemanticLabel {
    match lane.kind {
        RoadLaneKind::Carriageway | RoadLaneKind::Shoulder => SemanticLabel::Roads,
        RoadLaneKind::Sidewalk | RoadLaneKind::Kerb => SemanticLabel::SideWalks,
        RoadLaneKind::Median | RoadLaneKind::None => SemanticLabel::Terrain,
        RoadLaneKind::Rail => SemanticLabel::RailTrack,
    }
}

/// Raises pavements of files without lane heights.
pub(super) fn raise_default_kerbs(road: &mut Road) -> bool {
    let mut raised = false;
    for section in &mut road.sections {
        for lane in section.left.iter_mut().chain(&mut section.right) {
            if lane.kind == RoadLaneKind::Sidewalk && lane.heights.is_empty() {
                let s_m = section.start_s_m;
                lane.heights = vec![LaneHeight { s_m, inner_m: DEFAULT_KERB_M, outer_m: DEFAULT_KERB_M }];
                raised = true;
            }
        }
    }
    raised
}

/// Adds everything of one lane section.
pub(super) fn add_section(
    builder: &mut MeshBuilder,
    lanes: [&[RoadLane]; 2],
    rows: &[CrossSection],
    world: &WorldFromMap,
) {
    for (side, side_lanes) in lanes.into_iter().enumerate() {
        for (index, lane) in side_lanes.iter().enumerate() {
            let label = seen_label(side_lanes, index);
            for pair in rows.windows(2) {
                let [low, high] = [&pair[0], &pair[1]];
                let width_m = |row: &CrossSection| span_width_m(&row.spans[side][index]);
                if width_m(low) > 1e-3 || width_m(high) > 1e-3 {
                    let corners = [
                        edge(low, side, index, 0),
                        edge(high, side, index, 0),
                        edge(high, side, index, 1),
                        edge(low, side, index, 1),
                    ];
                    builder.quad(label, false, corners.map(|corner| in_world(corner, world)));
                }
                let outer = [edge(low, side, index, 1), edge(high, side, index, 1)];
                let below = match side_lanes.get(index + 1) {
                    Some(_) => [edge(low, side, index + 1, 0), edge(high, side, index + 1, 0)],
                    None => outer.map(|(point, along_across)| (point - SKIRT_M * DVec3::Z, along_across)),
                };
                let face = side_lanes.get(index + 1).map_or(label, |next| face_label(lane, next));
                add_face(builder, face, outer, below, world);
            }
        }
    }
    add_center_face(builder, lanes, rows, world);
}

/// The face between the first lanes of both sides, when they differ in height at the centre.
fn add_center_face(builder: &mut MeshBuilder, lanes: [&[RoadLane]; 2], rows: &[CrossSection], world: &WorldFromMap) {
    for pair in rows.windows(2) {
        let [low, high] = [&pair[0], &pair[1]];
        match (lanes[0].first(), lanes[1].first()) {
            (Some(left), Some(right)) => {
                let (left_edge, right_edge) =
                    ([edge(low, 0, 0, 0), edge(high, 0, 0, 0)], [edge(low, 1, 0, 0), edge(high, 1, 0, 0)]);
                add_face(builder, face_label(left, right), left_edge, right_edge, world);
            }
            (Some(only), None) | (None, Some(only)) => {
                let side = usize::from(lanes[0].is_empty());
                let top = [edge(low, side, 0, 0), edge(high, side, 0, 0)];
                let below = top.map(|(point, along_across)| (point - SKIRT_M * DVec3::Z, along_across));
                add_face(builder, lane_label(only), top, below, world);
            }
            (None, None) => {}
        }
    }
}

fn add_face(
    builder: &mut MeshBuilder,
    label: SemanticLabel,
    upper: [(DVec3, DVec2); 2],
    lower: [(DVec3, DVec2); 2],
    world: &WorldFromMap,
) {
    let step_m = |i: usize| (upper[i].0.z - lower[i].0.z).abs();
    if step_m(0).max(step_m(1)) > 1e-3 {
        builder.quad(label, false, [upper[0], upper[1], lower[1], lower[0]].map(|corner| in_world(corner, world)));
    }
}

fn face_label(a: &RoadLane, b: &RoadLane) -> SemanticLabel {
    let labels = [lane_label(a), lane_label(b)];
    if labels.contains(&SemanticLabel::SideWalks) { SemanticLabel::SideWalks } else { labels[0] }
}

fn span_width_m(span: &LaneSpan) -> f64 {
    (span.t_m[1] - span.t_m[0]).abs()
}

fn edge(row: &CrossSection, side: usize, lane: usize, outer: usize) -> (DVec3, DVec2) {
    (row.points[side][lane][outer], DVec2::new(row.s_m, row.spans[side][lane].t_m[outer]))
}

fn in_world((point_in_map, along_across): (DVec3, DVec2), world: &WorldFromMap) -> (DVec3, DVec2) {
    (world.point(point_in_map), along_across)
}
