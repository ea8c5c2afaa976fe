//! [`layout`]: a plan of streets along middle lines, where they are no wider than streets.

use super::clearance::{Clearance, OPEN_M};
use super::middles::Middle;
use cosfly_disjoint_sets::DisjointSets;
use cosfly_frames::DVec2;
use cosfly_places::streets::{Profile, StreetPlan, acute_ends, short_streets};

/// Half the width of the widest street space between facing houses, metres.
const WIDEST_M: f64 = 15.0;
/// Dead ends stop so far before their last house, in cells; shorter ones are left out, metres.
const BEFORE_END: usize = 7;
const SHORTEST_END_M: f64 = 35.0;
/// Streets of less length between two junctions make them one, metres.
const ONE_JUNCTION_M: f64 = 24.0;
/// Streets are straight so far from a junction, metres.
const STRAIGHT_M: f64 = 16.0;
/// Half the length over which middle lines are smoothed, metres, and distance by which they may be moved then.
const SMOOTH_M: f64 = 8.0;
const MOVED_M: f64 = 0.6;
/// Nets of less street in all are left out, metres.
const SHORTEST_NET_M: f64 = 80.0;

/// Widths of a lane and least ones of a pavement, wide streets first, metres. There is one lane for each direction.
const PROFILES: [[f64; 2]; 3] = [[2.9, 2.0], [2.7, 1.5], [2.4, 1.3]];
/// Pavements reach to the houses where they are no wider than this, metres; where junctions lack room, they narrow in steps.
const WIDEST_PAVEMENT_M: f64 = 5.5;
const STEP_M: f64 = 0.8;
/// Streets that meet another at an acute angle end so far before it, metres.
const PARTED_M: f64 = 26.0;
/// Rounding of corners, metres.
const CORNER_M: f64 = 1.2;
/// Ground that stays free between pavements and houses, metres.
const FREE_M: f64 = 0.1;

/// Streets along the middles between points; y is north, as in maps.
pub(super) fn layout(ground: &Clearance, points: Vec<DVec2>, middles: Vec<Middle>) -> StreetPlan {
    let mut net = Net { points, middles };
    net.cut_at_open_ground(ground);
    while net.drop_short_ends() {}
    net.join_junctions();
    let mut plan = StreetPlan { open_ends: true, ..StreetPlan::default() };
    let north = |at: DVec2| DVec2::new(at.x, -at.y);
    plan.nodes = net.points.iter().map(|at| north(*at)).collect();
    for middle in &net.middles {
        let line = net.smoothed(middle, ground.cell_m);
        let Some(profile) = widest(ground, &line) else { continue };
        let bends = line[1..line.len() - 1].iter().map(|at| north(*at)).collect();
        plan.bent(middle.ends[0], bends, middle.ends[1], profile);
    }
    make_room(&mut plan);
    drop_short_nets(&mut plan);
    plan
}

/// Parts streets from points that they leave at acute angles, and leaves out those that are too short then.
fn make_room(plan: &mut StreetPlan) {
    loop {
        let acute = acute_ends(plan);
        let are_acute = !acute.is_empty();
        let mut out = short_streets(plan);
        if are_acute {
            out = acute.into_iter().filter(|end| !part(plan, *end)).map(|(street, _)| street).collect();
        } else if out.is_empty() {
            break;
        } else if narrow_beside(plan, &out) {
            continue;
        }
        let mut number = 0..;
        plan.links.retain(|_| !out.contains(&number.next().unwrap_or_default()));
    }
}

/// Ends a street before a point that it leads to; whether it is long enough.
fn part(plan: &mut StreetPlan, (street, at_end): (usize, bool)) -> bool {
    let mut line = plan.points(&plan.links[street]);
    if length_m(&line) < PARTED_M + SHORTEST_END_M {
        return false;
    }
    if !at_end {
        line.reverse();
    }
    let mut left_m = PARTED_M;
    while let [.., before, last] = line[..] {
        line.pop();
        let leg_m = before.distance(last);
        if leg_m > left_m {
            line.push(last.lerp(before, left_m / leg_m));
            break;
        }
        left_m -= leg_m;
    }
    if !at_end {
        line.reverse();
    }
    let end = plan.node(line[if at_end { line.len() - 1 } else { 0 }]);
    let link = &mut plan.links[street];
    link.ends[usize::from(at_end)] = end;
    link.bends = line[1..line.len() - 1].to_vec();
    true
}

/// The widest cross-section that a line has room for.
fn widest(ground: &Clearance, line: &[DVec2]) -> Option<Profile> {
    let free_m = line.windows(2).flat_map(|leg| {
        let steps = (leg[0].distance(leg[1]) / ground.cell_m).ceil().max(1.0);
        (0..=steps as usize).map(move |step| ground.at_m(leg[0].lerp(leg[1], step as f64 / steps)))
    });
    let room_m = free_m.fold(f64::INFINITY, f64::min) - FREE_M;
    let [lane_m, _] = PROFILES.into_iter().find(|[lane_m, sidewalk_m]| lane_m + sidewalk_m <= room_m)?;
    let sidewalk_m = (10.0 * (room_m - lane_m).min(WIDEST_PAVEMENT_M)).floor() / 10.0;
    Some(Profile { lanes: 1, lane_m, sidewalk_m, corner_m: CORNER_M })
}

/// Narrows the pavements of some streets and of those that they meet; whether any was wide enough for that.
fn narrow_beside(plan: &mut StreetPlan, streets: &[usize]) -> bool {
    let points: Vec<usize> = streets.iter().flat_map(|street| plan.links[*street].ends).collect();
    let mut narrowed = false;
    for link in plan.links.iter_mut().filter(|link| link.ends.iter().any(|end| points.contains(end))) {
        if link.profile.sidewalk_m > PROFILES[0][1] {
            link.profile.sidewalk_m = (link.profile.sidewalk_m - STEP_M).max(PROFILES[0][1]);
            narrowed = true;
        }
    }
    narrowed
}

/// Length of a line, metres.
pub(super) fn length_m(line: &[DVec2]) -> f64 {
    line.windows(2).map(|leg| leg[0].distance(leg[1])).sum()
}

/// Leaves out the nets of few metres.
fn drop_short_nets(plan: &mut StreetPlan) {
    let mut nets = DisjointSets::new(plan.nodes.len());
    for [a, b] in plan.links.iter().map(|link| link.ends) {
        nets.join(a, b);
    }
    let mut lengths_m = vec![0.0; plan.nodes.len()];
    for link in &plan.links {
        lengths_m[nets.smallest(link.ends[0])] += length_m(&plan.points(link));
    }
    plan.links.retain(|link| lengths_m[nets.smallest(link.ends[0])] >= SHORTEST_NET_M);
}

/// Middle lines and their points.
struct Net {
    points: Vec<DVec2>,
    middles: Vec<Middle>,
}

impl Net {
    fn degrees(&self) -> Vec<usize> {
        let mut degrees = vec![0; self.points.len()];
        self.middles.iter().flat_map(|middle| middle.ends).for_each(|end| degrees[end] += 1);
        degrees
    }

    /// Ends lines where the ground opens, and leaves out those along wide ground.
    fn cut_at_open_ground(&mut self, ground: &Clearance) {
        let degrees = self.degrees();
        let points = &mut self.points;
        self.middles.retain_mut(|middle| {
            let [start, end] = middle.ends.map(|end| if degrees[end] == 1 { BEFORE_END } else { 0 });
            let is_street = |at: &DVec2| ground.house_distance_m(*at) <= OPEN_M;
            let mut kept = (start..middle.line.len().saturating_sub(end)).filter(|at| is_street(&middle.line[*at]));
            let Some(first) = kept.next() else { return false };
            let last = kept.next_back().unwrap_or(first);
            for (end, at) in [first, last].into_iter().enumerate() {
                if at != [0, middle.line.len() - 1][end] {
                    middle.ends[end] = points.len();
                    points.push(middle.line[at]);
                }
            }
            middle.line = middle.line[first..=last].to_vec();
            let narrow = middle.line.iter().filter(|at| ground.house_distance_m(**at) <= WIDEST_M).count();
            middle.line.iter().all(is_street) && middle.line.len() > 2 && 2 * narrow >= middle.line.len()
        });
    }

    /// Leaves out short dead ends; whether there were any.
    fn drop_short_ends(&mut self) -> bool {
        let (degrees, before) = (self.degrees(), self.middles.len());
        self.middles.retain(|middle| {
            let is_end = middle.ends.iter().any(|end| degrees[*end] == 1);
            !is_end || length_m(&middle.line) >= SHORTEST_END_M
        });
        self.middles.len() < before
    }

    /// Makes junctions one that are near to each other.
    fn join_junctions(&mut self) {
        let degrees = self.degrees();
        let mut joint = DisjointSets::new(self.points.len());
        for middle in &self.middles {
            if length_m(&middle.line) < ONE_JUNCTION_M && middle.ends.iter().all(|end| degrees[*end] > 2) {
                joint.join(middle.ends[0], middle.ends[1]);
            }
        }
        let mut sums = vec![(DVec2::ZERO, 0.0); self.points.len()];
        for (point, at) in self.points.iter().enumerate() {
            let (sum, count) = &mut sums[joint.smallest(point)];
            (*sum, *count) = (*sum + *at, *count + 1.0);
        }
        for middle in &mut self.middles {
            middle.ends = middle.ends.map(|end| joint.smallest(end));
        }
        self.middles.retain(|middle| middle.ends[0] != middle.ends[1]);
        for (point, (sum, count)) in self.points.iter_mut().zip(sums).filter(|(_, (_, count))| *count > 0.0) {
            *point = sum / count;
        }
    }

    /// A line without the cells' steps, from point to point, straight near junctions.
    fn smoothed(&self, middle: &Middle, cell_m: f64) -> Vec<DVec2> {
        let (line, last) = (&middle.line, middle.line.len() - 1);
        let reach = (SMOOTH_M / cell_m) as usize;
        let mean = |at: usize| {
            let reach = reach.min(at).min(last - at);
            line[at - reach..=at + reach].iter().sum::<DVec2>() / (2 * reach + 1) as f64
        };
        let [from, to] = middle.ends.map(|end| self.points[end]);
        let is_far = |at: &DVec2| at.distance(from) >= STRAIGHT_M && at.distance(to) >= STRAIGHT_M;
        let between = (1..last).map(mean).filter(is_far);
        let mut smooth: Vec<DVec2> = [from].into_iter().chain(between).chain([to]).collect();
        thin_out(&mut smooth);
        smooth
    }
}

/// Leaves out the points that lie nearly on the line without them (Douglas and Peucker).
fn thin_out(line: &mut Vec<DVec2>) {
    let mut is_kept = vec![false; line.len()];
    let mut parts = vec![[0, line.len() - 1]];
    while let Some([from, to]) = parts.pop() {
        (is_kept[from], is_kept[to]) = (true, true);
        let along = (line[to] - line[from]).normalize_or_zero();
        let aside_m = |at: &usize| (line[*at] - line[from]).perp_dot(along).abs();
        let farthest = (from + 1..to).max_by(|a, b| aside_m(a).total_cmp(&aside_m(b)));
        if let Some(at) = farthest.filter(|at| aside_m(at) > MOVED_M) {
            parts.extend([[from, at], [at, to]]);
        }
    }
    let mut number = 0..;
    line.retain(|_| is_kept[number.next().unwrap_or_default()]);
}
