//! Triangles over an area with holes, by cutting it into level trapezoids (even-odd rule).

use cosfly_frames::DVec2;

/// Most trapezoids of one area.
const MOST_TRAPEZOIDS: usize = 100_000;
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

/// Trapezoids that fill what lies inside an odd number of `rings`; `None` where there are absurdly many.
pub fn trapezoids(rings: &[&[DVec2]]) -> Option<Vec<Trapezoid>> {
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
    let mut levels: Vec<f64> = edges.iter().flat_map(|edge| [edge.low.y, edge.high.y]).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup_by(|later, first| *later - *first <= SAME_LEVEL_M);
    edges.sort_by(|a, b| a.low.y.total_cmp(&b.low.y));
    let mut next = 0;
    let mut active: Vec<Edge> = Vec::new();
    // Pieces that may go on upwards: their edges and the level they begin on.
    let mut open: Vec<(Edge, Edge, f64)> = Vec::new();
    let mut done = Vec::new();
    for pair in levels.windows(2) {
        let middle = 0.5 * (pair[0] + pair[1]);
        active.retain(|edge| edge.high.y > middle);
        while let Some(edge) = edges.get(next).filter(|edge| edge.low.y < middle) {
            active.push(*edge);
            next += 1;
        }
        active.retain(|edge| edge.high.y > middle);
        active.sort_by(|a, b| a.x_at(middle).total_cmp(&b.x_at(middle)));
        let mut current = Vec::with_capacity(active.len() / 2);
        for sides in active.chunks_exact(2) {
            let same = |(left, right, _): &&(Edge, Edge, f64)| {
                left.low == sides[0].low
                    && left.high == sides[0].high
                    && right.low == sides[1].low
                    && right.high == sides[1].high
            };
            let begin = open.iter().find(same).map_or(pair[0], |(_, _, begin)| *begin);
            current.push((sides[0], sides[1], begin));
        }
        for (left, right, begin) in &open {
            let goes_on = current.iter().any(|(l, r, b)| {
                b == begin && l.low == left.low && l.high == left.high && r.low == right.low && r.high == right.high
            });
            if !goes_on {
                done.push(trapezoid(left, right, *begin, pair[0]));
            }
        }
        if done.len() > MOST_TRAPEZOIDS {
            return None;
        }
        open = current;
    }
    if let Some(top) = levels.last() {
        done.extend(open.iter().map(|(left, right, begin)| trapezoid(left, right, *begin, *top)));
    }
    Some(done)
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
