//! The sea: what lies to the right of `natural=coastline`.

use super::elements::Elements;
use super::frame::Frame;
use super::roads::{LINE_MARGIN_M, lines_of};
use cosfly_frames::DVec2;
use cosfly_town::polygons::contains;
use std::collections::BTreeMap;

/// About so many nodes of streets are looked at.
const MOST_NODES: usize = 20_000;
/// More pieces of coast than this are given up.
const MOST_PIECES: usize = 5000;
/// An end of a coast within the extract is led on to the rim where that is at most this far away, a share of the rim's shorter side:
/// extracts are cut along borders.
const MOST_LED_ON: f64 = 0.15;
/// The sea that such a coast bounds holds at most this share of the nodes of streets.
const MOST_STREETS_IN_SEA: f64 = 0.02;
/// Ends of a coast this close to the rim of the extract lie on it, metres.
const ON_RIM_M: f64 = 1e-6;

/// The sea of an extract.
#[derive(Debug, Default)]
pub struct Sea {
    /// Rings around and in it (even-odd rule), none without a coast.
    pub rings: Vec<Vec<DVec2>>,
    /// Ends of its coast that were led on to the rim of the extract.
    pub led_on: usize,
}

/// The sea; `None` where the coast ends within the extract, so that sea and land cannot be told apart.
pub fn sea(elements: &Elements, frame: &Frame) -> Option<Sea> {
    let mut islands = Vec::new();
    let mut coasts = Vec::new();
    for chain in chains(elements) {
        let is_closed = chain.first() == chain.last();
        let mut pieces = lines_of(elements, frame, &chain);
        // A round coast that leaves the extract begins somewhere within one of its pieces.
        if is_closed
            && pieces.len() > 1
            && let (Some(first), Some(mut last)) = (pieces.first().cloned(), pieces.pop())
        {
            if last.last() == first.first() {
                last.extend(&first[1..]);
                pieces[0] = last;
            } else {
                pieces.push(last);
            }
        }
        for mut piece in pieces {
            if piece.first() == piece.last() {
                piece.pop();
                islands.push(piece);
            } else {
                coasts.push(piece);
            }
        }
    }
    if islands.is_empty() && coasts.is_empty() {
        return Some(Sea::default());
    }
    let rim = Rim { low: frame.low - LINE_MARGIN_M, high: frame.high + LINE_MARGIN_M };
    let led_on = coasts.iter_mut().map(|coast| rim.lead_on(coast)).sum();
    let mut rings = if coasts.is_empty() { vec![rim.corners().to_vec()] } else { rim.closed(coasts)? };
    rings.append(&mut islands);
    let sea = Sea { rings, led_on };
    (led_on == 0 || sea.leaves_streets_dry(elements, frame)).then_some(sea)
}

impl Sea {
    fn leaves_streets_dry(&self, elements: &Elements, frame: &Frame) -> bool {
        let streets = elements.ways.iter().filter(|way| way.tags.has("highway") && !way.tags.has("bridge"));
        let nodes = streets.flat_map(|way| &way.nodes).filter_map(|id| frame.position(elements, *id));
        let (mut count, mut wet) = (0_usize, 0_usize);
        for at in nodes.filter(|at| frame.holds(*at, 0.0)).step_by(1 + elements.nodes.len() / MOST_NODES) {
            count += 1;
            wet += self.rings.iter().filter(|ring| contains(ring, at)).count() % 2;
        }
        wet as f64 <= MOST_STREETS_IN_SEA * count as f64
    }
}

/// Nodes of the coast, ways joined end to beginning.
fn chains(elements: &Elements) -> Vec<Vec<i64>> {
    let ways: Vec<&[i64]> = elements
        .ways
        .iter()
        .filter(|way| way.tags.is("natural", &["coastline"]) && way.nodes.len() >= 2)
        .map(|way| way.nodes.as_slice())
        .collect();
    let begins: BTreeMap<i64, usize> = ways.iter().enumerate().map(|(way, nodes)| (nodes[0], way)).collect();
    let ends: BTreeMap<i64, usize> =
        ways.iter().enumerate().map(|(way, nodes)| (nodes[nodes.len() - 1], way)).collect();
    let mut is_used = vec![false; ways.len()];
    let mut chains = Vec::new();
    // First those that nothing leads to, then the round ones.
    let open = (0..ways.len()).filter(|way| !ends.contains_key(&ways[*way][0]));
    for first in open.chain(0..ways.len()).collect::<Vec<_>>() {
        let mut chain: Vec<i64> = Vec::new();
        let mut next = Some(first);
        while let Some(way) = next.filter(|way| !is_used[*way]) {
            is_used[way] = true;
            chain.extend(&ways[way][usize::from(!chain.is_empty())..]);
            next = begins.get(&ways[way][ways[way].len() - 1]).copied();
        }
        if !chain.is_empty() {
            chains.push(chain);
        }
    }
    chains
}

/// The rim of an extract, clockwise from its north-west corner.
struct Rim {
    low: DVec2,
    high: DVec2,
}

impl Rim {
    fn corners(&self) -> [DVec2; 4] {
        [self.low, DVec2::new(self.high.x, self.low.y), self.high, DVec2::new(self.low.x, self.high.y)]
    }

    /// How far along the rim a point lies, in sides; none inside.
    fn place(&self, point: DVec2) -> Option<f64> {
        let size = self.high - self.low;
        let share = (point - self.low) / size;
        [
            (point.y - self.low.y, share.x),
            (self.high.x - point.x, 1.0 + share.y),
            (self.high.y - point.y, 3.0 - share.x),
            (point.x - self.low.x, 4.0 - share.y),
        ]
        .into_iter()
        .find(|(away_m, _)| away_m.abs() < ON_RIM_M)
        .map(|(_, place)| place.rem_euclid(4.0))
    }

    /// Leads the ends of a coast that are near the rim straight on to it; gives how many.
    fn lead_on(&self, coast: &mut Vec<DVec2>) -> usize {
        let ends = [coast.first().copied(), coast.last().copied()].map(|end| end.and_then(|end| self.led_on(end)));
        if let Some(first) = ends[0] {
            coast.insert(0, first);
        }
        coast.extend(ends[1]);
        ends.iter().flatten().count()
    }

    /// The nearest point of the rim; none for points on it or far from it.
    fn led_on(&self, point: DVec2) -> Option<DVec2> {
        let on_rim =
            [point.with_x(self.low.x), point.with_x(self.high.x), point.with_y(self.low.y), point.with_y(self.high.y)];
        let nearest = on_rim.into_iter().min_by(|a, b| a.distance(point).total_cmp(&b.distance(point)))?;
        let most_m = MOST_LED_ON * (self.high - self.low).min_element();
        (self.place(point).is_none() && nearest.distance(point) <= most_m).then_some(nearest)
    }

    /// Coasts closed clockwise along the rim, the sea to their right.
    fn closed(&self, coasts: Vec<Vec<DVec2>>) -> Option<Vec<Vec<DVec2>>> {
        if coasts.len() > MOST_PIECES {
            return None;
        }
        let places: Option<Vec<(f64, f64)>> =
            coasts.iter().map(|coast| Some((self.place(*coast.first()?)?, self.place(*coast.last()?)?))).collect();
        let places = places?;
        let mut is_used = vec![false; coasts.len()];
        let mut rings = Vec::new();
        for first in 0..coasts.len() {
            let mut ring: Vec<DVec2> = Vec::new();
            let mut at = first;
            while !is_used[at] {
                is_used[at] = true;
                ring.extend(&coasts[at]);
                let end = places[at].1;
                let ahead = |place: f64| (place - end).rem_euclid(4.0);
                let next = (0..coasts.len()).min_by(|a, b| ahead(places[*a].0).total_cmp(&ahead(places[*b].0)))?;
                let mut passed: Vec<usize> =
                    (0..4).filter(|corner| ahead(*corner as f64) < ahead(places[next].0)).collect();
                passed.sort_by(|a, b| ahead(*a as f64).total_cmp(&ahead(*b as f64)));
                ring.extend(passed.into_iter().map(|corner| self.corners()[corner]));
                at = next;
            }
            if ring.len() >= 3 {
                rings.push(ring);
            }
        }
        Some(rings)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rim() -> Rim {
        Rim { low: DVec2::ZERO, high: DVec2::new(20.0, 10.0) }
    }

    fn line(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|(x, y)| DVec2::new(*x, *y)).collect()
    }

    #[test]
    fn the_sea_lies_to_the_right_of_its_coasts() {
        // y points south: a coast to the east has the sea in the south.
        let rings = rim().closed(vec![line(&[(0.0, 4.0), (12.0, 5.0), (20.0, 4.0)])]).unwrap();
        assert_eq!(rings.len(), 1);
        assert!(contains(&rings[0], DVec2::new(10.0, 9.0)) && !contains(&rings[0], DVec2::new(10.0, 1.0)));
        // A strait between two coasts.
        let both = vec![line(&[(0.0, 3.0), (20.0, 3.0)]), line(&[(20.0, 7.0), (0.0, 7.0)])];
        let rings = rim().closed(both).unwrap();
        assert_eq!(rings.len(), 1);
        let is_sea = |y: f64| contains(&rings[0], DVec2::new(10.0, y));
        assert!(is_sea(5.0) && !is_sea(1.0) && !is_sea(9.0));
    }

    #[test]
    fn ends_near_the_rim_are_led_on_to_it() {
        let wide = Rim { low: DVec2::ZERO, high: DVec2::new(4000.0, 3000.0) };
        let mut coast = line(&[(0.0, 1000.0), (3000.0, 1200.0), (3000.0, 400.0)]);
        assert_eq!(wide.lead_on(&mut coast), 1);
        assert_eq!(coast.last(), Some(&DVec2::new(3000.0, 0.0)));
        let rings = wide.closed(vec![coast]).unwrap();
        assert!(contains(&rings[0], DVec2::new(3500.0, 500.0)) && !contains(&rings[0], DVec2::new(2500.0, 500.0)));
        let mut inland = line(&[(0.0, 1000.0), (2000.0, 1500.0)]);
        assert_eq!((wide.lead_on(&mut inland), inland.len()), (0, 2));
    }

    #[test]
    fn a_coast_that_ends_on_land_is_refused() {
        assert!(rim().closed(vec![line(&[(0.0, 4.0), (12.0, 5.0)])]).is_none());
    }
}
