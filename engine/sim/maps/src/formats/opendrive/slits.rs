//! Slits: lanes that miss each other by a few centimetres, where the land below would show, are joined by asphalt.

use super::network::{RoadLane, RoadLaneKind};
use super::stations::CrossSection;
use cosfly_domain::SemanticLabel;
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::GroundIndex;
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::world::WorldFromMap;

/// Longest piece that is closed or not as a whole, metres, and most pieces of an edge.
const PIECE_M: f64 = 0.5;
const MOST_PIECES: f64 = 1000.0;
/// Distances beyond an edge: a slit begins at the first and ends before one of the others, metres.
const OPEN_M: f64 = 0.005;
const PAVED_M: [f64; 5] = [0.03, 0.07, 0.15, 0.25, 0.4];
/// Largest difference of heights over a slit, metres.
const LEVEL_M: f64 = 0.3;
/// Asphalt in slits reaches this far over its neighbours, and lies this much higher, so that it covers grass, metres.
const OVERLAP_M: f64 = 0.05;
const ABOVE_M: f64 = 0.003;

/// A piece of the edge of a carriageway beyond which its road has no more lanes of any kind, in the world.
pub(super) struct Edge {
    ends: [DVec3; 2],
    /// Unit vector away from the carriageway.
    outward: DVec2,
}

/// The edges of a section's outermost and innermost lanes where they are carriageway, and those of all carriageways at
/// both ends of the section.
pub(super) fn edges(lanes: [&[RoadLane]; 2], rows: &[CrossSection], world: &WorldFromMap) -> Vec<Edge> {
    let mut edges = vec![];
    let is_paved = |lane: &RoadLane| matches!(lane.kind, RoadLaneKind::Carriageway | RoadLaneKind::Shoulder);
    let mut add = |ends: [DVec3; 2], inner: DVec3| {
        let [from, to] = ends.map(|end| world.point(end).truncate());
        let across = (to - from).perp().normalize_or_zero();
        let outward = if across.dot(from - world.point(inner).truncate()) < 0.0 { -across } else { across };
        if outward != DVec2::ZERO {
            edges.push(Edge { ends: ends.map(|end| world.point(end)), outward });
        }
    };
    for (side, own) in lanes.iter().enumerate() {
        let at = |row: &CrossSection, lane: usize, edge: usize| row.points[side][lane][edge];
        // Lanes without a kind may shrink to slits.
        let outermost = own.iter().rposition(|lane| lane.kind != RoadLaneKind::None);
        let last = outermost.filter(|last| is_paved(&own[*last]));
        for pair in rows.windows(2) {
            if let Some(last) = last {
                add([0, 1].map(|row: usize| at(&pair[row], last, 1)), at(&pair[0], last, 0));
            }
            let innermost = own.iter().position(|lane| lane.kind != RoadLaneKind::None);
            let has_open_side = innermost.is_some_and(|first| first > 0) || lanes[1 - side].is_empty();
            if let Some(first) = innermost.filter(|first| has_open_side && is_paved(&own[*first])) {
                add([0, 1].map(|row: usize| at(&pair[row], first, 0)), at(&pair[0], first, 1));
            }
        }
        let [.., before, last] = rows else { continue };
        for lane in (0..own.len()).filter(|lane| is_paved(&own[*lane])) {
            add([0, 1].map(|edge| at(&rows[0], lane, edge)), at(&rows[1], lane, 0));
            add([0, 1].map(|edge| at(last, lane, edge)), at(before, lane, 0));
        }
    }
    edges
}

/// Closes the slits at some edges and gives the number of pieces; `ground` is all ground so far.
pub(super) fn close(builder: &mut MeshBuilder, ground: &GroundIndex, edges: &[Edge]) -> usize {
    edges.iter().map(|edge| edge.close(builder, ground)).sum()
}

impl Edge {
    fn close(&self, builder: &mut MeshBuilder, ground: &GroundIndex) -> usize {
        let [from, to] = self.ends;
        let pieces = ((to - from).length() / PIECE_M).ceil().clamp(1.0, MOST_PIECES) as usize;
        let at = |piece: f64| from.lerp(to, piece / pieces as f64);
        let mut count = 0;
        for piece in 0..pieces {
            let (begin, end) = (piece as f64, piece as f64 + 1.0);
            let places = [begin + 0.1, begin + 0.5, end - 0.1].map(at);
            let widest = |a: Far, b: Far| if a.away_m >= b.away_m { a } else { b };
            let found = places.into_iter().filter_map(|place| self.far_side(ground, place));
            let Some(far) = found.reduce(widest) else { continue };
            let corner = |place: DVec3, across_m: f64, rise_m: f64| {
                let plan = place.truncate() + across_m * self.outward;
                (plan.extend(place.z + rise_m + ABOVE_M), plan)
            };
            let (begin, end, far_m) = (at(begin), at(end), far.away_m + OVERLAP_M);
            let near = [corner(begin, -OVERLAP_M, 0.0), corner(end, -OVERLAP_M, 0.0)];
            let corners = [near[0], near[1], corner(end, far_m, far.rise_m), corner(begin, far_m, far.rise_m)];
            builder.quad(SemanticLabel::Roads, true, corners);
            count += 1;
        }
        count
    }

    /// The far side of the slit beyond a place on the edge; `None` without a slit.
    fn far_side(&self, ground: &GroundIndex, place: DVec3) -> Option<Far> {
        let paved_m = |away_m: f64| {
            let seen = ground.ground_seen((place.truncate() + away_m * self.outward).extend(place.z), LEVEL_M);
            seen.filter(|it| it.label != SemanticLabel::Terrain)
        };
        if paved_m(OPEN_M).is_some() {
            return None;
        }
        PAVED_M.into_iter().find_map(|away_m| {
            let far = paved_m(away_m)?;
            // Asphalt ends at the foot of a kerb.
            let rise_m = if far.label == SemanticLabel::Roads { far.height_m - place.z } else { 0.0 };
            Some(Far { away_m, rise_m })
        })
    }
}

/// The far side of a slit: its distance from the edge and its height above it, metres.
#[derive(Clone, Copy)]
struct Far {
    away_m: f64,
    rise_m: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a slit of a width beside a carriageway of 10 m is closed.
    fn is_closed(width_m: f64) -> bool {
        let mut builder = MeshBuilder::default();
        for [from, to] in [[-3.0, 0.0], [width_m, 3.0]] {
            let corners = [[0.0, from], [10.0, from], [10.0, to], [0.0, to]].map(DVec2::from);
            builder.quad(SemanticLabel::Roads, false, corners.map(|corner| (corner.extend(1.0), corner)));
        }
        let ground = GroundIndex::of_surfaces(&builder.finish(), |_| true);
        let edge = Edge { ends: [DVec3::new(0.0, 0.0, 1.0), DVec3::new(10.0, 0.0, 1.0)], outward: DVec2::Y };
        let mut builder = MeshBuilder::default();
        let count = close(&mut builder, &ground, &[edge]);
        let ground = GroundIndex::of_surfaces(&builder.finish(), |_| true);
        let is_covered = |x: f64| ground.ground_near(DVec3::new(x, 0.5 * width_m, 1.0)).is_some();
        assert_eq!(count > 0, is_covered(0.2) && is_covered(9.8));
        count > 0
    }

    #[test]
    fn narrow_slits_are_closed_and_wide_ones_and_seams_are_left() {
        assert!(is_closed(0.03) && is_closed(0.35));
        assert!(!is_closed(0.0) && !is_closed(0.6));
    }
}
