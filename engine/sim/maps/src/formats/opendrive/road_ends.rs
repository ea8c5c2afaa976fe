//! Ends of roads that face each other over a short gap: lanes and pavements go on from one to the other.
//!
//! Short ways through junctions often have the driving lanes only; gutters, shoulders and pavements stop beside them.

use super::network::{RoadLane, RoadLaneKind};
use super::stations::CrossSection;
use super::surfaces::lane_label;
use cosfly_domain::SemanticLabel;
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::GroundIndex;
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::world::WorldFromMap;
use std::collections::BTreeMap;

/// Longest gap, and the shortest, metres.
const LONGEST_M: f64 = 3.0;
const SHORTEST_M: f64 = 0.02;
/// Longest piece that is joined or not as a whole, metres, and most pieces of an end.
const PIECE_M: f64 = 0.25;
const MOST_PIECES: f64 = 400.0;
/// Largest difference of heights over a gap, metres.
const LEVEL_M: f64 = 0.3;
/// Least cosine between the directions of two ends.
const OPPOSITE: f64 = 0.85;
/// Joins lie this far above what they join, so that they cover grass, and pavements have faces this high, metres.
const ABOVE_M: f64 = 0.004;
const FACE_M: f64 = 0.3;

/// The end of a lane, in the world.
pub(super) struct LaneEnd {
    edges: [DVec3; 2],
    /// Unit vector out of the lane.
    outward: DVec2,
    label: SemanticLabel,
}

/// Both ends of each carriageway and pavement of a section.
pub(super) fn ends(lanes: [&[RoadLane]; 2], rows: &[CrossSection], world: &WorldFromMap) -> Vec<LaneEnd> {
    let ([first, second, ..], [.., before, last]) = (rows, rows) else { return vec![] };
    let mut ends = vec![];
    for (side, own) in lanes.into_iter().enumerate() {
        for (lane, of_lane) in own.iter().enumerate().filter(|(_, lane)| is_joined(lane)) {
            for (end, inner) in [(first, second), (last, before)] {
                let edges = [0, 1].map(|edge| world.point(end.points[side][lane][edge]));
                let across = (edges[1] - edges[0]).truncate().perp().normalize_or_zero();
                let inner = world.point(inner.points[side][lane][0]);
                let away = across.dot((edges[0] - inner).truncate());
                let outward = if away < 0.0 { -across } else { across };
                if edges[0].distance(edges[1]) > 0.05 {
                    ends.push(LaneEnd { edges, outward, label: lane_label(of_lane) });
                }
            }
        }
    }
    ends
}

fn is_joined(lane: &RoadLane) -> bool {
    matches!(lane.kind, RoadLaneKind::Carriageway | RoadLaneKind::Shoulder | RoadLaneKind::Sidewalk)
}

/// Joins the ends that face each other where neither carriageway nor pavement lies between them; gives the number of pieces. `ground`
/// is all ground so far.
pub(super) fn join(builder: &mut MeshBuilder, ground: &GroundIndex, ends: &[LaneEnd]) -> usize {
    let mut near: BTreeMap<(i64, i64), Vec<u32>> = BTreeMap::new();
    for (number, end) in ends.iter().enumerate() {
        for piece in 0..=end.pieces() {
            let list = near.entry(cell(end.at(piece as f64).truncate())).or_default();
            if list.last() != Some(&(number as u32)) {
                list.push(number as u32);
            }
        }
    }
    (0..ends.len()).map(|number| ends[number].join(builder, ground, (number, ends), &near)).sum()
}

fn cell(place: DVec2) -> (i64, i64) {
    let [column, row] = (place / LONGEST_M).floor().to_array();
    (column as i64, row as i64)
}

impl LaneEnd {
    fn pieces(&self) -> usize {
        (self.edges[0].distance(self.edges[1]) / PIECE_M).ceil().clamp(1.0, MOST_PIECES) as usize
    }

    fn at(&self, piece: f64) -> DVec3 {
        self.edges[0].lerp(self.edges[1], piece / self.pieces() as f64)
    }

    fn join(
        &self,
        builder: &mut MeshBuilder,
        ground: &GroundIndex,
        (own, ends): (usize, &[LaneEnd]),
        near: &BTreeMap<(i64, i64), Vec<u32>>,
    ) -> usize {
        let pieces: Vec<Option<usize>> =
            (0..self.pieces()).map(|piece| self.open_to(piece, ground, (own, ends), near)).collect();
        let (mut count, mut first) = (0, 0);
        for run in pieces.chunk_by(|a, b| a == b) {
            let end = first + run.len();
            if let Some(other) = run[0] {
                self.add(builder, &ends[other], [first, end]);
                count += 1;
            }
            first = end;
        }
        count
    }

    /// The end that a piece faces over open ground. The first of two ends joins both.
    fn open_to(
        &self,
        piece: usize,
        ground: &GroundIndex,
        (own, ends): (usize, &[LaneEnd]),
        near: &BTreeMap<(i64, i64), Vec<u32>>,
    ) -> Option<usize> {
        let middle = self.at(piece as f64 + 0.5);
        let other = self.facing(middle, ends, near).filter(|other| *other > own)?;
        let far = ends[other].beyond(middle, self.outward)?;
        let is_open = |share: f64| {
            let seen = ground.ground_seen(middle.lerp(far, share), LEVEL_M);
            seen.is_none_or(|it| it.label == SemanticLabel::Terrain)
        };
        [0.25, 0.5, 0.75].into_iter().all(is_open).then_some(other)
    }

    fn add(&self, builder: &mut MeshBuilder, other: &LaneEnd, run: [usize; 2]) {
        let [begin, end] = run.map(|piece| self.at(piece as f64));
        let far = |place: DVec3| other.edges[0].lerp(other.edges[1], other.share_met(place, self.outward));
        let (far_begin, far_end) = (far(begin), far(end));
        let corner = |place: DVec3, below_m: f64| (place - below_m * DVec3::Z, place.truncate());
        builder.quad(self.label, true, [begin, end, far_end, far_begin].map(|place| corner(place, -ABOVE_M)));
        if self.label == SemanticLabel::SideWalks {
            for [a, b] in [[begin, far_begin], [end, far_end]] {
                let sides = [corner(a, -ABOVE_M), corner(b, -ABOVE_M), corner(b, FACE_M), corner(a, FACE_M)];
                builder.quad(self.label, true, sides);
            }
        }
    }

    /// The nearest end of the same kind that a place on this one faces.
    fn facing(&self, place: DVec3, ends: &[LaneEnd], near: &BTreeMap<(i64, i64), Vec<u32>>) -> Option<usize> {
        let (column, row) = cell(place.truncate());
        let around = (-1..=1).flat_map(|x| (-1..=1).map(move |y| (column + x, row + y)));
        let candidates = around.filter_map(|key| near.get(&key)).flatten().map(|number| *number as usize);
        let is_facing = |it: &LaneEnd| it.label == self.label && it.outward.dot(self.outward) < -OPPOSITE;
        let reached = candidates.filter(|it| is_facing(&ends[*it])).filter_map(|it| {
            let far = ends[it].beyond(place, self.outward)?;
            let gap_m = (far - place).truncate().length();
            let is_level = (far.z - place.z).abs() <= LEVEL_M;
            (is_level && (SHORTEST_M..=LONGEST_M).contains(&gap_m)).then_some((gap_m, it))
        });
        reached.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))).map(|(_, end)| end)
    }

    /// The place on this end that a ray meets; `None` beside it and behind the ray.
    fn beyond(&self, from: DVec3, along: DVec2) -> Option<DVec3> {
        const SLACK: f64 = 0.12;
        let share = self.share_met(from, along);
        let place = self.edges[0].lerp(self.edges[1], share);
        let is_ahead = (place - from).truncate().dot(along) > 0.0;
        ((-SLACK..=1.0 + SLACK).contains(&share) && is_ahead).then_some(place)
    }

    /// Where the line through both edges meets a ray: 0 at the first, 1 at the second.
    fn share_met(&self, from: DVec3, along: DVec2) -> f64 {
        let [a, b] = self.edges.map(DVec3::truncate);
        along.perp_dot(from.truncate() - a) / along.perp_dot(b - a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The end of a lane 4 m wide across x, that leads in a direction along x.
    fn end(x: f64, along: f64, label: SemanticLabel) -> LaneEnd {
        LaneEnd { edges: [DVec3::new(x, 0.0, 0.15), DVec3::new(x, 4.0, 0.15)], outward: DVec2::new(along, 0.0), label }
    }

    /// Area of the ground between two ends.
    fn joined_m2(ends: [LaneEnd; 2]) -> f64 {
        let mut builder = MeshBuilder::default();
        let ground = GroundIndex::of_surfaces(&[], |_| true);
        join(&mut builder, &ground, &ends);
        let meshes = builder.finish();
        let areas = meshes.iter().flat_map(|mesh| {
            let corner = |k: u32| mesh.vertices_in_world[k as usize].truncate();
            let areas = mesh.triangles.iter().map(move |it| it.map(corner));
            areas.map(|it| 0.5 * cosfly_town::polygons::twice_area_m2(&it).abs())
        });
        areas.sum()
    }

    #[test]
    fn ends_of_one_kind_that_face_each_other_are_joined() {
        use SemanticLabel::{Roads, SideWalks};
        assert!((joined_m2([end(0.0, 1.0, Roads), end(2.0, -1.0, Roads)]) - 8.0).abs() < 1e-9);
        assert!((joined_m2([end(0.0, 1.0, SideWalks), end(2.0, -1.0, SideWalks)]) - 8.0).abs() < 1e-9);
        assert_eq!(joined_m2([end(0.0, 1.0, Roads), end(2.0, -1.0, SideWalks)]), 0.0);
        assert_eq!(joined_m2([end(0.0, 1.0, Roads), end(5.0, -1.0, Roads)]), 0.0, "too far");
        assert_eq!(joined_m2([end(0.0, -1.0, Roads), end(2.0, 1.0, Roads)]), 0.0, "back to back");
    }
}
