//! [`Lane`]s: where vehicles drive, which lane follows which, and where people cross.

use crate::polygons::PolygonIndex;
use cosfly_domain::{Town, WalkableKind, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A lane follows another one when it begins within this distance of the other's end, in plan and in height, metres.
const MEETING_M: [f64; 2] = [0.6, 0.5];
/// Smallest cosine of the turn between a lane and the one that follows.
const MEETING_COS: f64 = 0.6;
/// Distance between the points of a lane that are looked up in crossings, metres.
const SPACING_M: f64 = 0.5;

/// A lane for vehicles; they drive from its first point to its last.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lane {
    /// Use of the lane.
    pub kind: LaneKind,
    /// Its middle line, at least two points, in the direction of driving.
    pub middle_in_world: Vec<DVec3>,
    /// Width at its narrowest place, metres.
    pub width_m: f64,
    /// Speed limit, m/s.
    pub speed_limit_mps: f64,
    /// Whether it is a way through a junction.
    pub in_junction: bool,
    /// Lanes that follow: indices in [`Town::lanes`], ascending.
    pub successors: Vec<u32>,
    /// Crossings and other ground where people cross it: indices in [`Town::walkable`], ascending.
    pub crossings: Vec<u32>,
}

/// Use of a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LaneKind {
    /// Motor vehicles, and bicycles where there is no lane for them.
    Driving,
    /// Bicycles.
    Biking,
}

impl Lane {
    /// A lane whose followers and crossings are not known yet, see [`Town::link_lanes`]; `None` for one without extent.
    /// Points that nearly coincide become one.
    pub fn new(kind: LaneKind, points: impl IntoIterator<Item = DVec3>, width_m: f64, limit_mps: f64) -> Option<Self> {
        let mut middle_in_world: Vec<DVec3> = points.into_iter().collect();
        middle_in_world.dedup_by(|next, before| (*next - *before).truncate().length() < 0.05);
        (middle_in_world.len() >= 2 && width_m > 0.0).then_some(Self {
            kind,
            middle_in_world,
            width_m,
            speed_limit_mps: limit_mps,
            in_junction: false,
            successors: vec![],
            crossings: vec![],
        })
    }

    /// Length in plan, metres.
    pub fn length_m(&self) -> f64 {
        self.middle_in_world.windows(2).map(|pair| (pair[1] - pair[0]).truncate().length()).sum()
    }

    /// Place and direction of the first or the last point.
    fn end(&self, last: bool) -> (DVec3, DVec2) {
        let line = &self.middle_in_world;
        let [from, to] = if last { [line.len() - 2, line.len() - 1] } else { [0, 1] };
        let along = (line[to] - line[from]).truncate().normalize_or_zero();
        (line[if last { to } else { 0 }], along)
    }
}

impl Town {
    /// Finds which lane follows which, from the places of their ends, and which crossings each lane passes.
    pub fn link_lanes(&mut self) {
        let mut lanes = std::mem::take(&mut self.lanes);
        find_successors(&mut lanes);
        find_crossings(&mut lanes, &self.walkable);
        self.lanes = lanes;
    }

    /// Checks the lanes; see [`Town::assert_well_formed`].
    pub(crate) fn check_lanes(&self, is_near: impl Fn(DVec3) -> bool) -> Result<(), String> {
        for (i, lane) in self.lanes.iter().enumerate() {
            let line = &lane.middle_in_world;
            if line.len() < 2 || !line.iter().all(|point| is_near(*point)) {
                return Err(format!("lane {i} has {} points or one that is far away", line.len()));
            }
            let sizes = [lane.width_m, lane.speed_limit_mps];
            if !sizes.iter().all(|size| size.is_finite() && *size > 0.0) {
                return Err(format!("lane {i} has the width and speed limit {sizes:?}"));
            }
            let has = |list: &[u32], count: usize| list.iter().all(|index| (*index as usize) < count);
            if !has(&lane.successors, self.lanes.len()) || !has(&lane.crossings, self.walkable.len()) {
                return Err(format!("lane {i} has a follower or a crossing that does not exist"));
            }
        }
        Ok(())
    }
}

fn find_successors(lanes: &mut [Lane]) {
    let [near_m, level_m] = MEETING_M;
    let cell = |point: DVec3| [point.x, point.y].map(|at| (at / near_m).floor() as i64);
    let mut starts: BTreeMap<[i64; 2], Vec<u32>> = BTreeMap::new();
    for (number, lane) in (0u32..).zip(&*lanes) {
        starts.entry(cell(lane.end(false).0)).or_default().push(number);
    }
    for number in 0..lanes.len() {
        let (end, along) = lanes[number].end(true);
        let begin = lanes[number].end(false).0;
        let [column, row] = cell(end);
        let around = (-1..=1).flat_map(|right| (-1..=1).map(move |down| [column + right, row + down]));
        let follows = |other: &u32| {
            let lane = &lanes[*other as usize];
            let (start, onward) = lane.end(false);
            let away = start - end;
            *other as usize != number
                && lane.kind == lanes[number].kind
                && away.truncate().length() < near_m
                && away.z.abs() < level_m
                // Of two lanes shorter than a gap, only one follows the other.
                && away.length_squared() < (start - begin).length_squared()
                && along.dot(onward) > MEETING_COS
        };
        let mut found: Vec<u32> =
            around.filter_map(|key| starts.get(&key)).flatten().copied().filter(follows).collect();
        found.sort_unstable();
        lanes[number].successors = found;
    }
}

fn find_crossings(lanes: &mut [Lane], walkable: &[WalkablePolygon]) {
    let is_crossed = |polygon: &WalkablePolygon| matches!(polygon.kind, WalkableKind::Crossing | WalkableKind::Road);
    let numbers: Vec<u32> =
        (0u32..).zip(walkable).filter(|(_, polygon)| is_crossed(polygon)).map(|(number, _)| number).collect();
    let index = PolygonIndex::new(numbers.iter().map(|number| walkable[*number as usize].plan()).collect());
    for lane in lanes {
        let mut found = vec![];
        for pair in lane.middle_in_world.windows(2) {
            let steps = ((pair[1] - pair[0]).truncate().length() / SPACING_M).ceil().clamp(1.0, 1e5) as usize;
            for step in 0..=steps {
                let point = pair[0].lerp(pair[1], step as f64 / steps as f64);
                let here = index.at(point.truncate()).map(|at| numbers[at]);
                // A bridge over a crossing is not crossed.
                found.extend(here.filter(|number| (walkable[*number as usize].mean_height_m() - point.z).abs() < 2.0));
            }
        }
        found.sort_unstable();
        found.dedup();
        lane.crossings = found;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lane(points: &[(f64, f64)]) -> Lane {
        let points = points.iter().map(|(x, y)| DVec3::new(*x, *y, 0.0));
        Lane::new(LaneKind::Driving, points, 3.0, 10.0).unwrap()
    }

    #[test]
    fn lanes_that_meet_follow_each_other_and_opposite_ones_do_not() {
        let crossing = [(4.0, -3.0), (6.0, -3.0), (6.0, 3.0), (4.0, 3.0)].map(|(x, y)| DVec3::new(x, y, 0.1));
        let polygon =
            |kind: WalkableKind| WalkablePolygon { kind, outline_in_world: crossing.to_vec(), synthetic: false };
        let mut town = Town {
            lanes: vec![
                lane(&[(0.0, 0.0), (10.0, 0.0)]),
                lane(&[(10.1, 0.0), (20.0, 0.0)]),
                lane(&[(10.0, 0.0), (12.0, 0.2), (14.0, 3.0)]),
                lane(&[(10.0, 0.0), (0.0, 0.0)]),
                lane(&[(10.0, 0.7), (20.0, 0.7)]),
                Lane { kind: LaneKind::Biking, ..lane(&[(10.0, 0.0), (20.0, 0.0)]) },
            ],
            walkable: vec![polygon(WalkableKind::Sidewalk), polygon(WalkableKind::Crossing)],
            ..Town::default()
        };
        town.link_lanes();
        assert_eq!(town.lanes[0].successors, [1, 2]);
        assert_eq!(town.lanes[0].crossings, [1]);
        assert!(town.lanes[1..].iter().all(|lane| lane.successors.is_empty()));
        let short = |from: f64| lane(&[(from, 0.0), (from + 0.1, 0.0)]);
        town.lanes = vec![short(0.0), short(0.1), short(0.2)];
        town.link_lanes();
        assert_eq!(town.lanes.iter().map(|lane| &lane.successors[..]).collect::<Vec<_>>(), [&[1, 2][..], &[2], &[]]);
        assert!(Lane::new(LaneKind::Driving, [DVec3::ONE; 4], 3.0, 10.0).is_none());
    }
}
