//! Pavements that streets state by `sidewalk=*`: strips beside the carriageway that go on round the corners.

use super::roads::{Road, RoadIndex};
use super::strip::{moved_left, thinned};
use super::tags::Tags;
use cosfly_frames::DVec2;
use std::collections::{BTreeMap, BTreeSet};

/// Width of a pavement, metres.
pub const PAVEMENT_M: f64 = 2.0;
/// Streets that meet at less than this angle have one pavement, cosine: 60 degrees.
const SAME_STREET_COS: f64 = 0.5;
/// Distance between places that are tested for carriageways, metres.
const STEP_M: f64 = 1.0;
/// Streets that are looked at where one ends.
const MOST_ARMS: usize = 64;
/// Longest way over a carriageway, metres.
pub const LONGEST_CROSSING_M: f64 = 30.0;
/// One-way carriageways side by side have no invented pavement between them where they are at most so far apart, metres.
const MEDIAN_M: f64 = 12.0;
/// Share of a street's side that must lie at such a median.
const MEDIAN_SHARE: f64 = 0.5;

/// A middle line of a pavement, or of its way across a side street.
#[derive(Debug)]
pub struct Line {
    /// Points.
    pub points: Vec<DVec2>,
    /// Whether it leads over a carriageway.
    pub is_crossing: bool,
    /// Whether the file does not state it.
    pub is_invented: bool,
}

/// Sides of a street that have a pavement of their own: left, right; `None` where the tags say nothing.
fn stated_sides(tags: &Tags) -> Option<[bool; 2]> {
    let is_yes = |key| tags.get(key).map(|value| value == "yes");
    if let Some(side) = tags.get("sidewalk") {
        let left = ["both", "left", "yes"].contains(&side);
        let right = ["both", "right", "yes"].contains(&side);
        return Some([left, right]);
    }
    let both = is_yes("sidewalk:both");
    let (left, right) = (is_yes("sidewalk:left").or(both), is_yes("sidewalk:right").or(both));
    (left.is_some() || right.is_some()).then(|| [left.unwrap_or(false), right.unwrap_or(false)])
}

/// Whether a way is a street that usually has pavements.
pub fn is_street(tags: &Tags) -> bool {
    tags.is("highway", &["primary", "secondary", "tertiary", "residential", "unclassified", "living_street"])
}

/// Whether [`lines`] invents pavements of a street when it is asked to.
pub fn may_be_assumed(tags: &Tags) -> bool {
    is_street(tags) && is_for_people(tags) && stated_sides(tags).is_none()
}

/// Whether people may walk along a street.
fn is_for_people(tags: &Tags) -> bool {
    !tags.is("foot", &["no", "use_sidepath"]) && !tags.is("motorroad", &["yes"])
}

/// One side of a piece of street, directed so that the pavement is on its left.
struct Side {
    points: Vec<DVec2>,
    offset_m: f64,
    way: i64,
    is_invented: bool,
}

/// Middle lines of all pavements; with `assume`, streets that state nothing get some, too.
pub fn lines(roads: &[Road<'_>], index: &RoadIndex, assume: bool) -> Vec<Line> {
    let sides = sides(roads, index, assume);
    let mut out = Vec::new();
    for chain in chains(&sides) {
        let ways: BTreeSet<i64> = chain.iter().map(|side| sides[*side].way).collect();
        let is_invented = chain.iter().all(|side| sides[*side].is_invented);
        let points = beside(&sides, &chain);
        cut(&points, index, &ways, is_invented, &mut out);
    }
    out
}

fn sides(roads: &[Road<'_>], index: &RoadIndex, assume: bool) -> Vec<Side> {
    let mut sides = Vec::new();
    for road in roads {
        let tags = &road.way.tags;
        let stated = stated_sides(tags);
        let assumed = assume && may_be_assumed(tags);
        let offset_m = road.half_width_m + 0.5 * PAVEMENT_M;
        for piece in &road.pieces {
            let points = thinned(piece);
            if points.len() < 2 {
                continue;
            }
            let is_invented = stated.is_none();
            let back: Vec<DVec2> = points.iter().rev().copied().collect();
            let is_kerb = |line: &[DVec2]| assumed && !(road.is_oneway && is_at_median(line, road, index));
            let [left, right] = stated.unwrap_or_else(|| [is_kerb(&points), is_kerb(&back)]);
            if right {
                sides.push(Side { points: back, offset_m, way: road.way.id, is_invented });
            }
            if left {
                sides.push(Side { points, offset_m, way: road.way.id, is_invented });
            }
        }
    }
    sides
}

/// Whether another one-way carriageway runs close on the left of a line along a one-way road.
fn is_at_median(line: &[DVec2], road: &Road<'_>, index: &RoadIndex) -> bool {
    let (mut all_m, mut at_median_m) = (0.0, 0.0);
    for pair in line.windows(2) {
        let along = (pair[1] - pair[0]).normalize_or_zero();
        let left = DVec2::new(along.y, -along.x);
        let middle = 0.5 * (pair[0] + pair[1]);
        let steps = (MEDIAN_M / STEP_M) as usize;
        let beside = (1..=steps).map(|step| middle + (road.half_width_m + STEP_M * step as f64) * left);
        let length_m = pair[0].distance(pair[1]);
        all_m += length_m;
        if beside.into_iter().any(|point| index.is_parallel_oneway(point, road.way.id, along)) {
            at_median_m += length_m;
        }
    }
    at_median_m > MEDIAN_SHARE * all_m
}

/// Chains of sides that go on into each other.
fn chains(sides: &[Side]) -> Vec<Vec<usize>> {
    let key = |point: DVec2| (point.x.to_bits(), point.y.to_bits());
    let mut starts: BTreeMap<(u64, u64), Vec<usize>> = BTreeMap::new();
    for (index, side) in sides.iter().enumerate() {
        starts.entry(key(side.points[0])).or_default().push(index);
    }
    let mut next = vec![None; sides.len()];
    let mut has_before = vec![false; sides.len()];
    for (index, side) in sides.iter().enumerate() {
        let end = side.points[side.points.len() - 1];
        let into = (end - side.points[side.points.len() - 2]).normalize_or_zero();
        let straightness =
            |other: usize| into.dot((sides[other].points[1] - sides[other].points[0]).normalize_or_zero());
        let free = starts
            .get(&key(end))
            .into_iter()
            .flatten()
            .take(MOST_ARMS)
            .copied()
            .filter(|other| !has_before[*other] && *other != index);
        let best = free.max_by(|a, b| straightness(*a).total_cmp(&straightness(*b)).then(b.cmp(a)));
        if let Some(best) = best.filter(|best| straightness(*best) > SAME_STREET_COS) {
            (next[index], has_before[best]) = (Some(best), true);
        }
    }
    let mut is_used = vec![false; sides.len()];
    let mut chains = Vec::new();
    // First those with a beginning, then the rings.
    for index in (0..sides.len()).filter(|index| !has_before[*index]).chain(0..sides.len()) {
        let mut chain = Vec::new();
        let mut at = Some(index);
        while let Some(side) = at.filter(|side| !is_used[*side]) {
            is_used[side] = true;
            chain.push(side);
            at = next[side];
        }
        if !chain.is_empty() {
            chains.push(chain);
        }
    }
    chains
}

/// The line of the pavement beside a chain, longer than the street at both ends, so that it meets those round the corner.
fn beside(sides: &[Side], chain: &[usize]) -> Vec<DVec2> {
    let (mut points, mut offsets_m): (Vec<DVec2>, Vec<f64>) = (Vec::new(), Vec::new());
    for side in chain.iter().map(|side| &sides[*side]) {
        let is_going_on = points.last() == side.points.first();
        if is_going_on && let Some(offset_m) = offsets_m.last_mut() {
            *offset_m = side.offset_m.max(*offset_m);
        }
        let new = &side.points[usize::from(is_going_on)..];
        points.extend(new);
        offsets_m.extend(new.iter().map(|_| side.offset_m));
    }
    let mut line = moved_left(&points, &offsets_m);
    let count = line.len();
    let reach = |offset_m: f64, from: DVec2, to: DVec2| (offset_m + 0.5 * PAVEMENT_M) * (to - from).normalize_or_zero();
    line[count - 1] += reach(offsets_m[count - 1], points[count - 2], points[count - 1]);
    line[0] += reach(offsets_m[0], points[1], points[0]);
    line
}

/// Cuts a line where it leads over carriageways of other streets: short ways across become crossings, ends and long
/// ways on a carriageway are dropped.
fn cut(line: &[DVec2], index: &RoadIndex, own: &BTreeSet<i64>, is_invented: bool, out: &mut Vec<Line>) {
    let runs = runs(line, |point| index.is_road(point, |way| !own.contains(&way)));
    let last = runs.len().saturating_sub(1);
    for (number, (is_road, points)) in runs.into_iter().enumerate() {
        let length_m: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        let is_between = number > 0 && number < last && length_m <= LONGEST_CROSSING_M;
        if !is_road || is_between {
            out.push(Line { points, is_crossing: is_road, is_invented: is_invented || is_road });
        }
    }
}

/// A line in runs of places for which `is_road` says the same; neighbours share a point.
pub fn runs(line: &[DVec2], is_road: impl Fn(DVec2) -> bool) -> Vec<(bool, Vec<DVec2>)> {
    let mut runs: Vec<(bool, Vec<DVec2>)> = Vec::new();
    for pair in line.windows(2) {
        let count = (pair[0].distance(pair[1]) / STEP_M).ceil().max(1.0) as usize;
        let at = |step: usize| pair[0].lerp(pair[1], step as f64 / count as f64);
        for step in 0..count {
            let on_road = is_road(pair[0].lerp(pair[1], (step as f64 + 0.5) / count as f64));
            match runs.last_mut() {
                Some((own, _)) if *own == on_road => {}
                _ => runs.push((on_road, vec![at(step)])),
            }
            // Only corners of the line and ends of runs are kept.
            if let Some((_, points)) = runs.last_mut() {
                if points.len() > 1 && step > 0 {
                    points.pop();
                }
                points.push(at(step + 1));
            }
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(all: &[(f64, f64)]) -> Vec<DVec2> {
        all.iter().map(|(x, y)| DVec2::new(*x, *y)).collect()
    }

    #[test]
    fn runs_keep_the_corners_of_a_line_and_meet_each_other() {
        let line = points(&[(0.0, 0.0), (10.0, 0.0), (10.0, 5.0), (30.0, 5.0)]);
        let runs = runs(&line, |point| point.x > 14.0 && point.x < 18.0);
        let expected = [
            (false, points(&[(0.0, 0.0), (10.0, 0.0), (10.0, 5.0), (14.0, 5.0)])),
            (true, points(&[(14.0, 5.0), (18.0, 5.0)])),
            (false, points(&[(18.0, 5.0), (30.0, 5.0)])),
        ];
        assert_eq!(runs, expected);
    }

    #[test]
    fn sides_of_pavements_are_read_in_every_spelling() {
        let sides = |pairs: &[(&str, &str)]| {
            let mut tags = Tags::default();
            pairs.iter().for_each(|(key, value)| tags.add(key, value));
            stated_sides(&tags)
        };
        assert_eq!(sides(&[("sidewalk", "both")]), Some([true, true]));
        assert_eq!(sides(&[("sidewalk", "left")]), Some([true, false]));
        assert_eq!(sides(&[("sidewalk", "separate")]), Some([false, false]));
        assert_eq!(sides(&[("sidewalk:right", "yes")]), Some([false, true]));
        assert_eq!(sides(&[("sidewalk:both", "separate")]), Some([false, false]));
        assert_eq!(sides(&[]), None);
    }
}
