//! [`Frame`]: the area of an extract and the plan positions of its nodes.

use super::elements::{Bounds, CUT_OUT, Elements, Node, UNITS_PER_DEGREE};
use crate::projection::TransverseMercator;
use cosfly_frames::DVec2;
use cosfly_town::MapError;

/// Widest extract, metres: lengths at its rim are too long by 20 mm in a kilometre.
const WIDEST_M: f64 = 80_000.0;
/// Nodes farther from the middle than this are moved to this distance, degrees; what leads to them is cut anyway.
const FARTHEST_DEG: f64 = 3.0;
/// Share of the nodes beyond each side of an extract that does not state its bounds.
const OUTLIERS: f64 = 0.005;

/// Plan view of an extract in the world frame: x east, y south, metres, about the middle of its bounds.
#[derive(Debug)]
pub struct Frame {
    /// From degrees.
    pub projection: TransverseMercator,
    /// North-west corner of the extract.
    pub low: DVec2,
    /// South-east corner.
    pub high: DVec2,
    middle_deg: [f64; 2],
    positions: Vec<DVec2>,
}

impl Frame {
    /// The frame of an extract.
    ///
    /// # Errors
    /// An extract without nodes, or a very wide one.
    pub fn new(elements: &Elements) -> Result<Self, MapError> {
        let stated = stated_bounds(elements);
        let Some(bounds) = stated.or_else(|| most_nodes(&elements.nodes)) else {
            return Err(MapError::new("the file has no nodes with a place")
                .hint("export an area with its nodes, ways and relations"));
        };
        let middle_deg = [0, 1].map(|axis| 0.5 * (bounds.low[axis] + bounds.high[axis]));
        let mut frame = Self {
            projection: TransverseMercator::about(middle_deg),
            low: DVec2::ZERO,
            high: DVec2::ZERO,
            middle_deg,
            positions: Vec::new(),
        };
        let [[west, south], [east, north]] = [bounds.low, bounds.high];
        let span_deg = (east - west).max(north - south);
        let corners = [[west, south], [east, south], [west, north], [east, north]]
            .map(|corner| frame.position_of_degrees(corner));
        frame.low = corners.into_iter().fold(DVec2::INFINITY, DVec2::min);
        frame.high = corners.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max);
        let across_m = (frame.high - frame.low).max_element();
        if span_deg > FARTHEST_DEG || across_m > WIDEST_M {
            let message =
                format!("the extract is {span_deg:.2} degrees across; at most {} km are read", WIDEST_M / 1000.0);
            let error = MapError::new(message);
            let error = if elements.bounds.len() < 2 {
                error
            } else {
                error.hint(format!(
                    "the file states {} areas; leave out those that are far from the others",
                    elements.bounds.len()
                ))
            };
            return Err(error.hint(CUT_OUT));
        }
        frame.positions = elements.nodes.iter().map(|node| frame.position_of_node(node)).collect();
        Ok(frame)
    }

    fn position_of_degrees(&self, degrees: [f64; 2]) -> DVec2 {
        let near = |axis: usize| {
            self.middle_deg[axis] + (degrees[axis] - self.middle_deg[axis]).clamp(-FARTHEST_DEG, FARTHEST_DEG)
        };
        let plan = self.projection.project([near(0), near(1).clamp(-89.9, 89.9)]);
        DVec2::new(plan.x, -plan.y)
    }

    fn position_of_node(&self, node: &Node) -> DVec2 {
        self.position_of_degrees([f64::from(node.lon) / UNITS_PER_DEGREE, f64::from(node.lat) / UNITS_PER_DEGREE])
    }

    /// Position of the node with a number; `None` where the file lacks it.
    pub fn position(&self, elements: &Elements, id: i64) -> Option<DVec2> {
        elements.nodes.binary_search_by_key(&id, |node| node.id).ok().map(|place| self.positions[place])
    }

    /// Whether a point lies in the extract grown by a margin.
    pub fn holds(&self, point: DVec2, margin_m: f64) -> bool {
        point.cmpge(self.low - margin_m).all() && point.cmple(self.high + margin_m).all()
    }

    /// The pieces of a line inside the extract grown by a margin.
    pub fn clipped_line(&self, points: &[DVec2], margin_m: f64) -> Vec<Vec<DVec2>> {
        let (low, high) = (self.low - margin_m, self.high + margin_m);
        let mut pieces: Vec<Vec<DVec2>> = Vec::new();
        let mut goes_on = false;
        for pair in points.windows(2) {
            let Some((from, to)) = clipped_segment(pair[0], pair[1], low, high) else {
                goes_on = false;
                continue;
            };
            match pieces.last_mut().filter(|_| goes_on && from == pair[0]) {
                Some(piece) => piece.push(to),
                None => pieces.push(vec![from, to]),
            }
            goes_on = to == pair[1];
        }
        pieces
    }

    /// The part of a ring inside the extract grown by a margin.
    pub fn clipped_ring(&self, ring: &[DVec2], margin_m: f64) -> Vec<DVec2> {
        if ring.iter().all(|point| self.holds(*point, margin_m)) {
            return ring.to_vec();
        }
        let (low, high) = (self.low - margin_m, self.high + margin_m);
        let band = |ring: &[DVec2], along: DVec2| {
            cosfly_town::polygons::clipped_to_band(ring, along, low.dot(along), high.dot(along))
        };
        band(&band(ring, DVec2::X), DVec2::Y)
    }
}

impl Bounds {
    fn is_an_area(&self) -> bool {
        let [low, high] = [self.low, self.high];
        let is_place = |[lon, lat]: [f64; 2]| lon.abs() <= 180.0 && lat.abs() < 89.0;
        is_place(low) && is_place(high) && low[0] < high[0] && low[1] < high[1]
    }

    /// The least area that holds both.
    fn and(self, other: Self) -> Self {
        let pick = |pick: fn(f64, f64) -> f64, a: [f64; 2], b: [f64; 2]| [pick(a[0], b[0]), pick(a[1], b[1])];
        Self { low: pick(f64::min, self.low, other.low), high: pick(f64::max, self.high, other.high) }
    }

    fn touches(&self, other: &Self) -> bool {
        (0..2).all(|axis| self.low[axis] <= other.high[axis] && self.high[axis] >= other.low[axis])
    }

    fn holds(&self, node: &Node) -> bool {
        let at = [node.lon, node.lat].map(|value| f64::from(value) / UNITS_PER_DEGREE);
        (0..2).all(|axis| (self.low[axis]..=self.high[axis]).contains(&at[axis]))
    }
}

/// The least area that holds every area that the file states. Areas of another place, which hold no node and touch none that
/// does, are not believed.
fn stated_bounds(elements: &Elements) -> Option<Bounds> {
    let whole = bounds_with_nodes(elements)?;
    Some(areas(elements).filter(|bounds| bounds.touches(&whole)).copied().fold(whole, Bounds::and))
}

/// Number of stated bounds that are no area, and of all where none holds a node. One without nodes beside others may be an empty
/// download.
pub fn unbelieved_bounds(elements: &Elements) -> usize {
    let believed = bounds_with_nodes(elements).map_or(0, |_| areas(elements).count());
    elements.bounds.len() - believed
}

fn areas(elements: &Elements) -> impl Iterator<Item = &Bounds> {
    elements.bounds.iter().filter(|bounds| bounds.is_an_area())
}

fn bounds_with_nodes(elements: &Elements) -> Option<Bounds> {
    let has_nodes = |bounds: &Bounds| elements.nodes.is_empty() || elements.nodes.iter().any(|node| bounds.holds(node));
    areas(elements).filter(|bounds| has_nodes(bounds)).copied().reduce(Bounds::and)
}

/// The area of nearly all nodes.
fn most_nodes(nodes: &[Node]) -> Option<Bounds> {
    let range = |value: fn(&Node) -> i32| {
        let mut values: Vec<i32> = nodes.iter().map(value).collect();
        values.sort_unstable();
        let skipped = (OUTLIERS * values.len() as f64) as usize;
        let (low, high) = (*values.get(skipped)?, *values.get(values.len().checked_sub(skipped + 1)?)?);
        Some([low, high].map(|value| f64::from(value) / UNITS_PER_DEGREE))
    };
    let ([west, east], [south, north]) = (range(|node| node.lon)?, range(|node| node.lat)?);
    Some(Bounds { low: [west, south], high: [east, north] })
}

fn clipped_segment(from: DVec2, to: DVec2, low: DVec2, high: DVec2) -> Option<(DVec2, DVec2)> {
    let step = to - from;
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        if step[axis] == 0.0 {
            if from[axis] < low[axis] || from[axis] > high[axis] {
                return None;
            }
            continue;
        }
        let (a, b) = ((low[axis] - from[axis]) / step[axis], (high[axis] - from[axis]) / step[axis]);
        enter = enter.max(a.min(b));
        leave = leave.min(a.max(b));
    }
    let at = |share: f64| {
        if share <= 0.0 {
            from
        } else if share >= 1.0 {
            to
        } else {
            from + share * step
        }
    };
    (enter < leave).then(|| (at(enter), at(leave)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Frame {
        Frame {
            projection: TransverseMercator::about([0.0, 0.0]),
            low: DVec2::ZERO,
            high: DVec2::splat(10.0),
            middle_deg: [0.0; 2],
            positions: vec![],
        }
    }

    #[test]
    fn lines_are_cut_where_they_leave_the_extract() {
        let points = [(-5.0, 5.0), (5.0, 5.0), (5.0, 20.0), (8.0, 20.0), (8.0, 2.0)].map(|(x, y)| DVec2::new(x, y));
        let pieces = square().clipped_line(&points, 0.0);
        let expected = [[(0.0, 5.0), (5.0, 5.0), (5.0, 10.0)].as_slice(), &[(8.0, 10.0), (8.0, 2.0)]];
        assert_eq!(pieces, expected.map(|piece| piece.iter().map(|(x, y)| DVec2::new(*x, *y)).collect::<Vec<_>>()));
    }

    #[test]
    fn a_ring_is_cut_to_the_extract() {
        let ring = [(-5.0, -5.0), (5.0, -5.0), (5.0, 5.0), (-5.0, 5.0)].map(|(x, y)| DVec2::new(x, y));
        let cut = square().clipped_ring(&ring, 0.0);
        assert!((cosfly_town::polygons::twice_area_m2(&cut).abs() - 50.0).abs() < 1e-9);
    }
}
