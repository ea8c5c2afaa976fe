//! [`Area`]s of an extract: closed ways, and multipolygon relations with their holes.

use super::elements::{Elements, Relation, Role, Way};
use super::frame::Frame;
use super::stated::Doubts;
use super::tags::Tags;
use super::tally::Tally;
use core::fmt;
use cosfly_frames::DVec2;
use cosfly_town::polygons::{contains, twice_area_m2};
use std::collections::{BTreeMap, BTreeSet};

/// Most corners of one ring.
const MOST_CORNERS: usize = 50_000;
/// Rings of less area are none, square metres.
const SMALLEST_M2: f64 = 0.01;
/// Pairs of sides that are compared at most to find where a ring crosses itself.
const MOST_PAIRS: usize = 2_000_000;

/// Which element an area is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Source {
    /// A closed way.
    Way(i64),
    /// A multipolygon.
    Relation(i64),
}

impl fmt::Display for Source {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Way(id) => write!(out, "way {id}"),
            Self::Relation(id) => write!(out, "relation {id}"),
        }
    }
}

/// An outer ring with its holes, plan view; first corners not repeated.
#[derive(Debug)]
pub struct Area<'e> {
    /// The element.
    pub source: Source,
    /// Its tags.
    pub tags: &'e Tags,
    /// Outer ring.
    pub outer: Vec<DVec2>,
    /// Rings of the holes.
    pub holes: Vec<Vec<DVec2>>,
}

impl Area<'_> {
    /// All rings.
    pub fn rings(&self) -> Vec<&[DVec2]> {
        core::iter::once(&self.outer).chain(&self.holes).map(Vec::as_slice).collect()
    }

    /// Whether a point lies in the area.
    pub fn contains(&self, point: DVec2) -> bool {
        contains(&self.outer, point) && !self.holes.iter().any(|hole| contains(hole, point))
    }
}

/// Areas that could not be used, or only in part.
#[derive(Debug, Default)]
pub struct Problems {
    /// Values that are not believed.
    pub doubts: Doubts,
    /// Rings that lack nodes or ways.
    pub incomplete: Tally,
    /// Rings without area.
    pub empty: Tally,
    /// Rings that cross themselves.
    pub crossed: Tally,
    /// Rings of too many corners.
    pub too_long: Tally,
    /// Areas whose ground is too crooked to be filled.
    pub too_crooked: Tally,
    /// Ends of the coast that were led on to the edge of the extract.
    pub coast_ends: usize,
    /// The sea has too many corners.
    pub is_sea_too_crooked: bool,
    /// The sea cannot be told from the land.
    pub is_coast_open: bool,
}

/// The areas of all elements whose tags `is_wanted` accepts, ways first, by number.
pub fn areas<'e>(
    elements: &'e Elements,
    frame: &Frame,
    is_wanted: impl Fn(&Tags) -> bool,
    problems: &mut Problems,
) -> Vec<Area<'e>> {
    let mut areas = Vec::new();
    let mut rims = BTreeSet::new();
    for relation in elements.relations.iter().filter(|relation| relation.tags.is("type", &["multipolygon"])) {
        let outer_ways = outer_ways(elements, relation);
        // In old files the outer ways have the tags.
        let own = is_wanted(&relation.tags);
        let tags = if own { Some(&relation.tags) } else { shared_tags(elements, &outer_ways, &is_wanted) };
        if let Some(tags) = tags {
            add_multipolygon(elements, frame, relation, tags, &mut areas, problems);
            rims.extend(outer_ways);
        }
    }
    let mut of_ways = Vec::new();
    for (place, way) in elements.ways.iter().enumerate() {
        if rims.contains(&place) || !is_wanted(&way.tags) || !closes(elements, frame, way) {
            continue;
        }
        let source = Source::Way(way.id);
        if let Some(outer) = ring(elements, frame, &way.nodes, source, problems) {
            of_ways.push(Area { source, tags: &way.tags, outer, holes: Vec::new() });
        }
    }
    of_ways.append(&mut areas);
    of_ways
}

/// Whether a way ends where it begins: at the same node, or at another one in the same place.
pub fn closes(elements: &Elements, frame: &Frame, way: &Way) -> bool {
    let end = |id: Option<&i64>| id.and_then(|id| frame.position(elements, *id));
    way.is_closed()
        || way.nodes.len() >= 4 && end(way.nodes.first()).is_some_and(|at| Some(at) == end(way.nodes.last()))
}

/// Places of the ways on the outer rim that are in the file.
fn outer_ways(elements: &Elements, relation: &Relation) -> Vec<usize> {
    let outer = relation.members.iter().filter(|member| member.is_way && member.role == Role::Outer);
    outer.filter_map(|member| elements.way_place(member.id)).collect()
}

fn shared_tags<'e>(elements: &'e Elements, ways: &[usize], is_wanted: &impl Fn(&Tags) -> bool) -> Option<&'e Tags> {
    let first = &elements.ways[*ways.first()?].tags;
    let is_shared = is_wanted(first) && ways.iter().all(|place| elements.ways[*place].tags == *first);
    is_shared.then_some(first)
}

fn add_multipolygon<'e>(
    elements: &'e Elements,
    frame: &Frame,
    relation: &'e Relation,
    tags: &'e Tags,
    areas: &mut Vec<Area<'e>>,
    problems: &mut Problems,
) {
    let source = Source::Relation(relation.id);
    let mut is_complete = true;
    let mut known = BTreeSet::new();
    let mut rings_of = |is_inner: bool| {
        let mut lines = Vec::new();
        let mut is_whole = true;
        let of_rings = relation.members.iter().filter(|member| member.is_way);
        for member in of_rings.filter(|member| (member.role == Role::Inner) == is_inner) {
            if !known.insert(member.id) {
                continue; // listed twice: its line is there once
            }
            match elements.way_place(member.id) {
                Some(place) => lines.push(elements.ways[place].nodes.as_slice()),
                None => is_whole = false,
            }
        }
        let (closed, left) = closed_lines(&lines);
        is_complete &= is_whole && left == 0;
        closed.iter().filter_map(|nodes| ring(elements, frame, nodes, source, problems)).collect::<Vec<_>>()
    };
    let (outers, inners) = (rings_of(false), rings_of(true));
    if !is_complete {
        problems.incomplete.add(source);
    }
    let first = areas.len();
    areas.extend(outers.into_iter().map(|outer| Area { source, tags, outer, holes: Vec::new() }));
    for inner in inners {
        let middle = 0.5 * (inner[0] + inner[1]);
        let around =
            areas[first..].iter_mut().find(|area| contains(&area.outer, inner[0]) || contains(&area.outer, middle));
        if let Some(area) = around {
            area.holes.push(inner);
        }
    }
}

/// Joins lines at their ends to closed ones; also the number of lines left over.
fn closed_lines(lines: &[&[i64]]) -> (Vec<Vec<i64>>, usize) {
    let mut ends: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
    for (index, line) in lines.iter().enumerate() {
        for end in [line.first(), line.last()].into_iter().flatten() {
            ends.entry(*end).or_default().push(index);
        }
    }
    let mut is_used = vec![false; lines.len()];
    let mut closed = Vec::new();
    let mut left = 0;
    for index in 0..lines.len() {
        if is_used[index] || lines[index].len() < 2 {
            continue;
        }
        is_used[index] = true;
        let mut ring = lines[index].to_vec();
        let mut pieces = 1;
        while ring.first() != ring.last() {
            let end = ring[ring.len() - 1];
            // Used lines are dropped for good, so that many lines at one node cost no more than their number.
            let next = ends.get_mut(&end).and_then(|there| {
                while there.last().is_some_and(|line| is_used[*line]) {
                    there.pop();
                }
                there.last().copied()
            });
            let Some(next) = next else { break };
            is_used[next] = true;
            pieces += 1;
            if lines[next][0] == end {
                ring.extend(&lines[next][1..]);
            } else {
                ring.extend(lines[next].iter().rev().skip(1));
            }
        }
        if ring.first() == ring.last() && ring.len() >= 4 {
            closed.push(ring);
        } else {
            left += pieces;
        }
    }
    (closed, left)
}

/// The corners of a closed line of nodes.
fn ring(
    elements: &Elements,
    frame: &Frame,
    nodes: &[i64],
    source: Source,
    problems: &mut Problems,
) -> Option<Vec<DVec2>> {
    if nodes.len() > MOST_CORNERS {
        problems.too_long.add(source);
        return None;
    }
    let corners: Option<Vec<DVec2>> = nodes.iter().map(|id| frame.position(elements, *id)).collect();
    let Some(mut corners) = corners else {
        problems.incomplete.add(source);
        return None;
    };
    corners.dedup();
    if corners.first() == corners.last() {
        corners.pop();
    }
    if corners.len() < 3 || twice_area_m2(&corners).abs() < 2.0 * SMALLEST_M2 {
        problems.empty.add(source);
        return None;
    }
    if crosses_itself(&corners) {
        problems.crossed.add(source);
    }
    Some(corners)
}

/// Whether two sides of a ring cross; gives up after many comparisons.
fn crosses_itself(ring: &[DVec2]) -> bool {
    if ring.len() < 4 {
        return false;
    }
    let side = |index: usize| (ring[index], ring[(index + 1) % ring.len()]);
    let mut order: Vec<usize> = (0..ring.len()).collect();
    let start = |index: usize| side(index).0.x.min(side(index).1.x);
    order.sort_by(|a, b| start(*a).total_cmp(&start(*b)));
    let mut pairs = 0;
    for (place, first) in order.iter().enumerate() {
        let (a, b) = side(*first);
        let end = a.x.max(b.x);
        for second in order[place + 1..].iter().take_while(|second| start(**second) <= end) {
            pairs += 1;
            if pairs > MOST_PAIRS {
                return false;
            }
            let (c, d) = side(*second);
            let turn = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
            if turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0 {
                return true;
            }
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_joined_to_rings_either_way_round() {
        let lines: [&[i64]; 5] = [&[1, 2, 3], &[5, 4, 3], &[5, 1], &[10, 11, 12, 10], &[20, 21]];
        let (closed, left) = closed_lines(&lines);
        assert_eq!(closed, [vec![1, 2, 3, 4, 5, 1], vec![10, 11, 12, 10]]);
        assert_eq!(left, 1);
    }

    #[test]
    fn a_bow_tie_crosses_itself_and_a_square_does_not() {
        let ring = |points: [(f64, f64); 4]| points.map(|(x, y)| DVec2::new(x, y));
        assert!(crosses_itself(&ring([(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)])));
        assert!(!crosses_itself(&ring([(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)])));
    }
}
