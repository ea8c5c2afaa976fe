//! Triangles over an area with holes, by cutting it into level trapezoids (even-odd rule).

use cosfly_frames::DVec2;

/// Most trapezoids of one area.
const MOST_TRAPEZOIDS: usize = 100_000;
/// Most sides that are looked at, over all levels.
const MOST_WORK: usize = 20_000_000;
/// Levels closer than this are one, metres.
const SAME_LEVEL_M: f64 = 1e-6;

/// A piece between two levels of y: left and right end on the lower level, left and right end on the upper one.
pub type Trapezoid = [DVec2; 4];

/// An edge that rises from `low` to `high`.
#[derive(Clone, Copy)]
struct Edge {
    low: DVec2,
    high: DVec2,
}

impl Edge {
    fn x_at(&self, y: f64) -> f64 {
        self.low.x + (self.high.x - self.low.x) * ((y - self.low.y) / (self.high.y - self.low.y)).clamp(0.0, 1.0)
    }
}

/// A piece that may go on upwards: left and right edge, the level it begins on.
type Piece = (usize, usize, f64);

/// Trapezoids that fill what lies inside an odd number of `rings`; `None` where there are absurdly many.
pub fn trapezoids(rings: &[&[DVec2]]) -> Option<Vec<Trapezoid>> {
    let edges = rising_edges(rings);
    let mut levels: Vec<f64> = edges.iter().flat_map(|edge| [edge.low.y, edge.high.y]).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup_by(|later, first| *later - *first <= SAME_LEVEL_M);
    let (mut next, mut work) = (0, 0);
    let mut active: Vec<usize> = Vec::new();
    let mut open: Vec<Piece> = Vec::new();
    // For each left edge: the right one and the beginning of its piece, as of the last level that had one.
    let mut pieces: Vec<Option<(usize, f64)>> = vec![None; edges.len()];
    let mut done = Vec::new();
    for pair in levels.windows(2) {
        let middle = 0.5 * (pair[0] + pair[1]);
        active.extend((next..edges.len()).take_while(|edge| edges[*edge].low.y < middle));
        next = active.last().map_or(next, |last| next.max(last + 1));
        active.retain(|edge| edges[*edge].high.y > middle);
        work += active.len();
        if work > MOST_WORK || done.len() > MOST_TRAPEZOIDS {
            return None;
        }
        let order = |a: &usize, b: &usize| edges[*a].x_at(middle).total_cmp(&edges[*b].x_at(middle));
        let mut sorted = active.clone();
        sorted.sort_by(order);
        let current: Vec<Piece> = sorted
            .chunks_exact(2)
            .map(|sides| {
                let before = pieces[sides[0]].filter(|(right, _)| *right == sides[1]);
                (sides[0], sides[1], before.map_or(pair[0], |(_, begin)| begin))
            })
            .collect();
        open.iter().for_each(|(left, _, _)| pieces[*left] = None);
        current.iter().for_each(|(left, right, begin)| pieces[*left] = Some((*right, *begin)));
        let ended = open.iter().filter(|(left, right, _)| pieces[*left].is_none_or(|(other, _)| other != *right));
        done.extend(ended.map(|(left, right, begin)| trapezoid(&edges[*left], &edges[*right], *begin, pair[0])));
        open = current;
    }
    if let Some(top) = levels.last() {
        done.extend(open.iter().map(|(left, right, begin)| trapezoid(&edges[*left], &edges[*right], *begin, *top)));
    }
    Some(done)
}

/// All sides that are not level, by their lower ends.
fn rising_edges(rings: &[&[DVec2]]) -> Vec<Edge> {
    let mut edges: Vec<Edge> = Vec::new();
    for ring in rings {
        for (index, from) in ring.iter().enumerate() {
            let to = ring[(index + 1) % ring.len()];
            if (from.y - to.y).abs() > SAME_LEVEL_M {
                let (low, high) = if from.y < to.y { (*from, to) } else { (to, *from) };
                edges.push(Edge { low, high });
            }
        }
    }
    edges.sort_by(|a, b| a.low.y.total_cmp(&b.low.y));
    edges
}

fn trapezoid(left: &Edge, right: &Edge, from: f64, to: f64) -> Trapezoid {
    [(left, from), (right, from), (left, to), (right, to)].map(|(edge, y)| DVec2::new(edge.x_at(y), y))
}

/// A point well inside the rings: the middle of the widest trapezoid.
pub fn inner_point(rings: &[&[DVec2]]) -> Option<DVec2> {
    let pieces = trapezoids(rings)?;
    let area = |piece: &Trapezoid| (piece[1].x - piece[0].x + piece[3].x - piece[2].x) * (piece[2].y - piece[0].y);
    let widest = pieces.iter().max_by(|a, b| area(a).total_cmp(&area(b)))?;
    Some(0.25 * (widest[0] + widest[1] + widest[2] + widest[3]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_town::polygons::contains;

    fn area_m2(pieces: &[Trapezoid]) -> f64 {
        pieces.iter().map(|p| 0.5 * (p[1].x - p[0].x + p[3].x - p[2].x) * (p[2].y - p[0].y)).sum()
    }

    fn ring(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|(x, y)| DVec2::new(*x, *y)).collect()
    }

    #[test]
    fn trapezoids_fill_an_area_and_leave_its_holes() {
        let outer = ring(&[(0.0, 0.0), (20.0, 0.0), (24.0, 10.0), (10.0, 16.0), (0.0, 10.0)]);
        let hole = ring(&[(4.0, 3.0), (4.0, 8.0), (9.0, 8.0), (9.0, 3.0)]);
        let pieces = trapezoids(&[&outer, &hole]).unwrap();
        let expected = 0.5 * cosfly_town::polygons::twice_area_m2(&outer).abs() - 25.0;
        assert!((area_m2(&pieces) - expected).abs() < 1e-6, "{} {expected}", area_m2(&pieces));
        let inner = inner_point(&[&outer, &hole]).unwrap();
        assert!(contains(&outer, inner) && !contains(&hole, inner));
    }

    #[test]
    fn a_rectangle_is_one_piece_and_degenerate_rings_are_none() {
        let square = ring(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]);
        assert_eq!(trapezoids(&[&square]).unwrap().len(), 1);
        for points in [vec![], ring(&[(1.0, 1.0)]), ring(&[(0.0, 0.0), (5.0, 0.0), (9.0, 0.0)])] {
            assert!(trapezoids(&[&points]).unwrap().is_empty());
        }
    }
}
