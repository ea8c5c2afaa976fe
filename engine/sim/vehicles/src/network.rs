//! [`Network`]: the lanes of a town prepared for driving: places along them, crossings, conflicts in junctions.

use cosfly_domain::{Lane, LaneKind, Town};
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::polygons::contains;
use std::collections::{BTreeMap, BTreeSet};

/// Lanes through a junction whose middle lines come closer than this are in conflict, metres.
const CONFLICT_M: f64 = 2.9;
/// The same where a long vehicle bends off: its rear cuts the corner.
const LONG_CONFLICT_M: f64 = 5.0;
/// Lanes bend off where they turn by more than this, cosine.
const BENDS_OFF: f64 = 0.94;
/// Distance between the points that are compared, metres.
const SPACING_M: f64 = 1.0;
/// Side of a cell of the search for conflicts, metres.
const CELL_M: f64 = 8.0;
/// Ways ahead are followed so far, metres.
const FAR_M: f64 = 600.0;

/// Lanes ahead that are counted, at most.
const MOST_LANES_AHEAD: usize = 64;

/// A lane prepared for driving.
#[derive(Clone, Debug)]
pub(crate) struct Drive {
    pub kind: LaneKind,
    pub in_junction: bool,
    pub width_m: f64,
    pub limit_mps: f64,
    pub length_m: f64,
    pub successors: Vec<u32>,
    /// Lanes through the same junction that must be empty.
    pub conflicts: Vec<u32>,
    /// Lanes through the same junction that must be empty of long vehicles, and empty for one.
    pub long_conflicts: Vec<u32>,
    pub crossings: Vec<Crossing>,
    /// How far one can drive from its beginning, metres, up to [`FAR_M`].
    pub leads_m: f64,
    /// Whether vehicles leave the town at its end: a street that ends as a whole.
    pub is_exit: bool,
    points: Vec<DVec3>,
    /// Way along the lane to each point, metres.
    at_m: Vec<f64>,
}

/// Ground where people cross a lane.
#[derive(Clone, Debug)]
pub(crate) struct Crossing {
    /// First and last place along the lane, metres.
    pub from_m: f64,
    pub to_m: f64,
    /// Middle of that stretch.
    pub middle: DVec2,
    pub outline: Vec<DVec2>,
}

/// The lanes of a town.
#[derive(Clone, Debug)]
pub(crate) struct Network {
    pub lanes: Vec<Drive>,
    /// The side of the kerb: 1 to the right of the driver, -1 to the left.
    pub kerb: f64,
}

impl Drive {
    fn new(lane: &Lane, town: &Town) -> Self {
        let points = lane.middle_in_world.clone();
        let mut at_m = vec![0.0];
        for pair in points.windows(2) {
            at_m.push(at_m[at_m.len() - 1] + (pair[1] - pair[0]).truncate().length());
        }
        let length_m = at_m[at_m.len() - 1];
        let mut drive = Self {
            kind: lane.kind,
            in_junction: lane.in_junction,
            width_m: lane.width_m,
            limit_mps: lane.speed_limit_mps,
            length_m,
            successors: lane.successors.clone(),
            conflicts: vec![],
            long_conflicts: vec![],
            crossings: vec![],
            leads_m: 0.0,
            is_exit: false,
            points,
            at_m,
        };
        let outlines = lane.crossings.iter().map(|number| town.walkable[*number as usize].plan());
        drive.crossings = outlines.filter_map(|outline| drive.crossing(outline)).collect();
        drive.crossings.sort_by(|a, b| a.from_m.total_cmp(&b.from_m));
        drive
    }

    /// Point and direction at a way along the lane, held to the lane.
    pub fn at(&self, way_m: f64) -> (DVec3, DVec2) {
        let after = self.at_m.partition_point(|at| *at <= way_m).clamp(1, self.points.len() - 1);
        let (from, to) = (self.points[after - 1], self.points[after]);
        let span_m = self.at_m[after] - self.at_m[after - 1];
        let share = ((way_m - self.at_m[after - 1]) / span_m.max(1e-9)).clamp(0.0, 1.0);
        (from.lerp(to, share), (to - from).truncate().normalize_or_zero())
    }

    fn crossing(&self, outline: Vec<DVec2>) -> Option<Crossing> {
        let places = (0..=(2.0 * self.length_m) as usize).map(|half| 0.5 * half as f64);
        let mut within = places.filter(|way_m| contains(&outline, self.at(*way_m).0.truncate()));
        let from_m = within.next()?;
        let to_m = within.next_back().unwrap_or(from_m);
        let middle = self.at(0.5 * (from_m + to_m)).0.truncate();
        Some(Crossing { from_m, to_m, middle, outline })
    }

    /// Points of the lane, a metre apart.
    pub fn spaced(&self) -> impl Iterator<Item = DVec3> + '_ {
        (0..=(self.length_m / SPACING_M) as usize).map(|step| self.at(step as f64 * SPACING_M).0)
    }
}

impl Network {
    pub fn new(town: &Town) -> Self {
        let mut lanes: Vec<Drive> = town.lanes.iter().map(|lane| Drive::new(lane, town)).collect();
        find_conflicts(&mut lanes);
        let kerb = kerb_side(&lanes);
        let mut network = Self { lanes, kerb };
        for number in 0..network.lanes.len() {
            let lane = &network.lanes[number];
            let ends = lane.successors.is_empty() && !lane.in_junction;
            let beside = [1.0, -1.0].map(|side| ends && network.beside(number as u32, side, 1.0).is_some());
            network.lanes[number].is_exit = ends && beside == [false; 2];
        }
        network.measure();
        network
    }

    /// Closes lanes to traffic: no way leads into them any more, nor into ways through junctions that led nowhere else.
    pub fn close(&mut self, closed: &[u32]) {
        let mut gone: BTreeSet<u32> = closed.iter().copied().collect();
        while !gone.is_empty() {
            let mut cut_off = BTreeSet::new();
            for (number, lane) in (0u32..).zip(&mut self.lanes) {
                let before = lane.successors.len();
                lane.successors.retain(|next| !gone.contains(next));
                if lane.in_junction && lane.successors.is_empty() && before > 0 {
                    cut_off.insert(number);
                }
            }
            gone = cut_off;
        }
        self.measure();
    }

    /// For each lane, those that it follows.
    pub fn predecessors(&self) -> Vec<Vec<u32>> {
        let mut before = vec![vec![]; self.lanes.len()];
        for (number, lane) in (0u32..).zip(&self.lanes) {
            lane.successors.iter().for_each(|next| before[*next as usize].push(number));
        }
        before
    }

    /// Measures how far each lane leads: the longest way ahead grows from the ends of lanes backwards.
    fn measure(&mut self) {
        let lanes = &mut self.lanes;
        lanes.iter_mut().for_each(|lane| lane.leads_m = 0.0);
        for _ in 0..MOST_LANES_AHEAD {
            let mut has_changed = false;
            for number in 0..lanes.len() {
                let ahead = lanes[number].successors.iter().map(|next| lanes[*next as usize].leads_m);
                let beyond_m = if lanes[number].is_exit { FAR_M } else { ahead.fold(0.0, f64::max) };
                let leads_m = (lanes[number].length_m + beyond_m).min(FAR_M);
                has_changed |= leads_m > lanes[number].leads_m;
                lanes[number].leads_m = leads_m;
            }
            if !has_changed {
                break;
            }
        }
    }

    /// The lane beside another one in the same direction, away from the kerb.
    pub fn inner_neighbour(&self, number: u32) -> Option<u32> {
        self.beside(number, -self.kerb, 1.0)
    }

    /// The lane beside another one in the other direction, away from the kerb.
    pub fn opposite_neighbour(&self, number: u32) -> Option<u32> {
        self.beside(number, -self.kerb, -1.0)
    }

    /// The lane beside another one in the same direction, towards the kerb.
    pub fn outer_neighbour(&self, number: u32) -> Option<u32> {
        self.beside(number, self.kerb, 1.0)
    }

    /// The lane on a side of another one, in the same direction (1) or against it (-1).
    fn beside(&self, number: u32, side: f64, sense: f64) -> Option<u32> {
        let own = &self.lanes[number as usize];
        let (middle, along) = own.at(0.5 * own.length_m);
        let place = middle.truncate() + side * own.width_m * along.perp();
        let is_there = |lane: &Drive| {
            let (other, direction) = lane.at(0.5 * lane.length_m);
            lane.kind == own.kind
                && !lane.in_junction
                && sense * direction.dot(along) > 0.9
                && (lane.length_m - own.length_m).abs() < 5.0 + 0.1 * own.length_m
                && (other.truncate() - place).length() < 1.5
        };
        (0u32..).zip(&self.lanes).find(|(other, lane)| *other != number && is_there(lane)).map(|(other, _)| other)
    }
}

/// The side on which lanes of the opposite direction are not.
fn kerb_side(lanes: &[Drive]) -> f64 {
    let mut cells: BTreeMap<[i64; 2], Vec<usize>> = BTreeMap::new();
    let cell = |point: DVec2| [point.x, point.y].map(|at| (at / CELL_M).floor() as i64);
    let middles: Vec<(DVec3, DVec2)> = lanes.iter().map(|lane| lane.at(0.5 * lane.length_m)).collect();
    for (number, (middle, _)) in middles.iter().enumerate().filter(|(number, _)| !lanes[*number].in_junction) {
        cells.entry(cell(middle.truncate())).or_default().push(number);
    }
    let mut balance = 0.0;
    for (middle, along) in &middles {
        let [column, row] = cell(middle.truncate());
        for key in (-1..=1).flat_map(|x| (-1..=1).map(move |y| [column + x, row + y])) {
            for other in cells.get(&key).into_iter().flatten() {
                let (place, direction) = middles[*other];
                let away = place.truncate() - middle.truncate();
                if direction.dot(*along) < -0.9 && away.length() < 8.0 && away.dot(*along).abs() < 3.0 {
                    // y points to the right of x: a positive product is on the driver's right.
                    balance += along.perp_dot(away).signum();
                }
            }
        }
    }
    if balance > 0.0 { -1.0 } else { 1.0 }
}

/// Finds lanes of one junction that come too close to each other. Lanes that begin at one place part from each other, which
/// following the vehicle ahead covers.
fn find_conflicts(lanes: &mut [Drive]) {
    let mut cells: BTreeMap<[i64; 2], Vec<(u32, DVec3)>> = BTreeMap::new();
    let cell = |point: DVec3| [point.x, point.y].map(|at| (at / CELL_M).floor() as i64);
    let inner = (0u32..).zip(&*lanes).filter(|(_, lane)| lane.in_junction);
    for (number, point) in inner.flat_map(|(number, lane)| lane.spaced().map(move |point| (number, point))) {
        cells.entry(cell(point)).or_default().push((number, point));
    }
    // Pairs, and whether they are in conflict for all vehicles.
    let mut pairs: BTreeMap<[u32; 2], bool> = BTreeMap::new();
    let bends_off = |number: u32| {
        let lane = &lanes[number as usize];
        lane.at(0.0).1.dot(lane.at(lane.length_m).1) < BENDS_OFF
    };
    for ([column, row], members) in &cells {
        let around = (-1..=1).flat_map(|x| (-1..=1).map(move |y| [column + x, row + y]));
        for (other, place) in around.filter_map(|key| cells.get(&key)).flatten() {
            for (number, point) in members.iter().filter(|(number, _)| number < other) {
                let away = *place - *point;
                // Lanes side by side are no conflict.
                let widths_m = [number, other].map(|lane| lanes[*lane as usize].width_m);
                let apart_m = (0.5 * (widths_m[0] + widths_m[1]) - 0.15).min(CONFLICT_M);
                let (away_m, is_level) = (away.truncate().length(), away.z.abs() < 2.5);
                let is_near = away_m < LONG_CONFLICT_M && (bends_off(*number) || bends_off(*other));
                if is_level && (away_m < apart_m || is_near) {
                    *pairs.entry([*number, *other]).or_default() |= away_m < apart_m;
                }
            }
        }
    }
    for ([one, other], for_all) in pairs {
        let [first, second] = [one, other].map(|number| &lanes[number as usize]);
        let parts = first.points[0].distance(second.points[0]) < 0.5;
        let follows = first.successors.contains(&other) || second.successors.contains(&one);
        let alongside = first.at(0.0).1.dot(second.at(0.0).1) > 0.98
            && first.at(first.length_m).1.dot(second.at(second.length_m).1) > 0.98
            && first.at(first.length_m).0.distance(second.at(second.length_m).0) > 2.5;
        let is_for_all = for_all && !alongside;
        for [lane, other] in [[one, other], [other, one]].into_iter().filter(|_| !(parts || follows)) {
            let Drive { conflicts, long_conflicts, .. } = &mut lanes[lane as usize];
            if is_for_all { conflicts.push(other) } else { long_conflicts.push(other) }
        }
    }
}
