//! [`Carriageways`]: what carriageways leave of ground for people, and where people cross them.

use super::pavements::runs;
use super::rings::Area;
use super::roads::{Road, is_shared_street};
use crate::slabs::Trapezoid;
use cosfly_frames::DVec2;
use cosfly_town::polygons::{clipped_by_line, twice_area_m2};

/// Smaller pieces of ground are dropped, square metres.
const SMALLEST_M2: f64 = 0.05;
/// Tangent of an eighth of half a turn: corners of the octagon around a circle.
const OCTAGON: f64 = 0.414_213_562_373_095_1;
/// Places along a carriageway in an area where a way across is tried, shares of its length.
const TRIED: [f64; 3] = [0.5, 0.3, 0.7];

/// The carriageways of an extract that are no ground for people.
pub struct Carriageways<'r> {
    roads: Vec<&'r Road<'r>>,
    hulls: Vec<Hull>,
}

/// A convex outline around a straight stretch of a carriageway, rounded at its ends.
struct Hull {
    low: DVec2,
    high: DVec2,
    corners: [DVec2; 8],
}

impl Hull {
    fn around(from: DVec2, to: DVec2, half_width_m: f64) -> Self {
        let along = half_width_m * (to - from).normalize_or(DVec2::X);
        let corner = |end: DVec2, ahead: f64, aside: f64| end + ahead * along + aside * along.perp();
        let corners = [
            corner(from, -OCTAGON, -1.0),
            corner(to, OCTAGON, -1.0),
            corner(to, 1.0, -OCTAGON),
            corner(to, 1.0, OCTAGON),
            corner(to, OCTAGON, 1.0),
            corner(from, -OCTAGON, 1.0),
            corner(from, -1.0, OCTAGON),
            corner(from, -1.0, -OCTAGON),
        ];
        let [low, high] = bounds(&corners);
        Self { low, high, corners }
    }

    fn is_near(&self, [low, high]: [DVec2; 2]) -> bool {
        self.low.cmple(high).all() && self.high.cmpge(low).all()
    }

    /// Convex pieces of convex ground outside of the outline; none where they do not meet.
    fn cut(&self, ground: &[DVec2]) -> Option<Vec<Vec<DVec2>>> {
        let (mut inside, mut outside) = (ground.to_vec(), Vec::new());
        for (index, from) in self.corners.iter().enumerate() {
            let inward = (self.corners[(index + 1) % self.corners.len()] - *from).perp();
            outside.push(clipped_by_line(&inside, *from, -inward));
            inside = clipped_by_line(&inside, *from, inward);
        }
        outside.retain(|piece| is_ground(piece));
        is_ground(&inside).then_some(outside)
    }
}

impl<'r> Carriageways<'r> {
    /// Those of roads, without streets that people use as if they were pavements.
    pub fn new(roads: &'r [Road<'r>]) -> Self {
        let roads: Vec<&Road<'_>> = roads.iter().filter(|road| !is_shared_street(&road.way.tags)).collect();
        let sides = roads.iter().flat_map(|road| {
            let pairs = road.pieces.iter().flat_map(|piece| piece.windows(2));
            pairs.map(|pair| Hull::around(pair[0], pair[1], road.half_width_m))
        });
        Self { hulls: sides.collect(), roads }
    }

    /// Convex outlines of ground without the carriageways over it; none where no carriageway leads over it.
    pub fn cut(&self, ground: &[Trapezoid]) -> Option<Vec<Vec<DVec2>>> {
        let all: Vec<DVec2> = ground.iter().flatten().copied().collect();
        let near: Vec<&Hull> = self.hulls.iter().filter(|hull| hull.is_near(bounds(&all))).collect();
        let mut pieces: Vec<Vec<DVec2>> = ground.iter().map(|[a, b, c, d]| vec![*a, *b, *d, *c]).collect();
        let mut is_cut = false;
        for hull in near {
            let mut left = Vec::with_capacity(pieces.len());
            for piece in pieces {
                match Some(hull).filter(|hull| hull.is_near(bounds(&piece))).and_then(|hull| hull.cut(&piece)) {
                    Some(outside) => {
                        is_cut = true;
                        left.extend(outside);
                    }
                    None => left.push(piece),
                }
            }
            pieces = left;
        }
        is_cut.then_some(pieces)
    }

    /// A line across each carriageway that leads through an area, `reach_m` beyond its kerbs, where both ends lie in the area.
    pub fn ways_across(&self, area: &Area<'_>, reach_m: f64) -> Vec<[DVec2; 2]> {
        let limits = bounds(&area.outer);
        let mut ways = Vec::new();
        for road in &self.roads {
            let is_near = |piece: &&Vec<DVec2>| {
                let [low, high] = bounds(piece);
                low.cmple(limits[1]).all() && high.cmpge(limits[0]).all()
            };
            for piece in road.pieces.iter().filter(is_near) {
                let inside = runs(piece, |point| area.contains(point)).into_iter().filter(|(is_inside, _)| *is_inside);
                ways.extend(inside.filter_map(|(_, line)| {
                    let across = TRIED.iter().map(|share| across(&line, *share, road.half_width_m + reach_m));
                    across.into_iter().find(|ends| ends.iter().all(|end| area.contains(*end)))
                }));
            }
        }
        ways
    }
}

/// Ends of a line across another one at a share of its length.
fn across(line: &[DVec2], share: f64, half_m: f64) -> [DVec2; 2] {
    let mut left_m = share * line.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>();
    let (mut at, mut along) = (line[0], DVec2::X);
    for pair in line.windows(2) {
        let length_m = pair[0].distance(pair[1]);
        along = (pair[1] - pair[0]).normalize_or(along);
        at = pair[0] + left_m.min(length_m) * along;
        if left_m <= length_m {
            break;
        }
        left_m -= length_m;
    }
    [at - half_m * along.perp(), at + half_m * along.perp()]
}

fn bounds(points: &[DVec2]) -> [DVec2; 2] {
    let points = points.iter().copied();
    [points.clone().fold(DVec2::INFINITY, DVec2::min), points.fold(DVec2::NEG_INFINITY, DVec2::max)]
}

fn is_ground(outline: &[DVec2]) -> bool {
    outline.len() >= 3 && 0.5 * twice_area_m2(outline).abs() >= SMALLEST_M2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ground_without_a_stretch_has_the_rest_of_its_area_and_nothing_under_the_stretch() {
        let square = [DVec2::ZERO, DVec2::new(40.0, 0.0), DVec2::new(40.0, 20.0), DVec2::new(0.0, 20.0)];
        let area_m2 = |pieces: &[Vec<DVec2>]| pieces.iter().map(|it| 0.5 * twice_area_m2(it).abs()).sum::<f64>();
        let over = Hull::around(DVec2::new(-9.0, 8.0), DVec2::new(50.0, 8.0), 3.0).cut(&square).unwrap();
        assert!((area_m2(&over) - 40.0 * 14.0).abs() < 1e-6, "{over:?}");
        let into = Hull::around(DVec2::new(20.0, -9.0), DVec2::new(20.0, 10.0), 3.0).cut(&square).unwrap();
        let octagon_m2 = 9.0 * (4.0 - 2.0 * (1.0 - OCTAGON) * (1.0 - OCTAGON)) / 2.0;
        assert!((area_m2(&into) - (800.0 - 60.0 - octagon_m2)).abs() < 1e-6, "{}", area_m2(&into));
        assert!(Hull::around(DVec2::new(-9.0, 30.0), DVec2::new(50.0, 24.0), 3.0).cut(&square).is_none());
    }
}
