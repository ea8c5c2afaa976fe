//! From a grid route to a smooth path: evening out, Douglas-Peucker, centripetal Catmull-Rom, and the check that it is free.

use crate::WalkableGrid;
use cosfly_frames::DVec2;

/// Longest chord of the finished path, metres; every one of them is checked.
pub(crate) const CHORD_M: f64 = 0.05;

/// Sweeps of evening out the staircase of the grid.
const EVENING_SWEEPS: usize = 12;

/// A span of the spline is halved this often before it is walked straight.
const MAX_HALVINGS: u8 = 4;

/// The smooth path along a grid route, as points at most [`CHORD_M`] apart, each chord free in the exact sense.
pub(crate) fn smooth(grid: &WalkableGrid, route: &[DVec2], simplify_m: f64) -> Vec<DVec2> {
    let mut points = route.to_vec();
    even_out(grid, &mut points);
    spline(grid, &simplify(grid, &points, simplify_m))
}

/// Moves each point towards the middle of its neighbours as long as both its steps stay free.
fn even_out(grid: &WalkableGrid, points: &mut [DVec2]) {
    for _ in 0..EVENING_SWEEPS {
        for i in 1..points.len().saturating_sub(1) {
            let (before, after) = (points[i - 1], points[i + 1]);
            let moved = 0.5 * points[i] + 0.25 * (before + after);
            if grid.step_is_free(before, moved) && grid.step_is_free(moved, after) {
                points[i] = moved;
            }
        }
    }
}

/// Douglas-Peucker, with one rule more: a simplified step must be free, else it is split on.
fn simplify(grid: &WalkableGrid, points: &[DVec2], tolerance_m: f64) -> Vec<DVec2> {
    let Some(last) = points.len().checked_sub(1) else { return vec![] };
    let mut kept = vec![false; points.len()];
    (kept[0], kept[last]) = (true, true);
    let mut open = vec![(0, last)];
    while let Some((first, last)) = open.pop() {
        if last - first < 2 {
            continue;
        }
        let (distance, farthest) = (first + 1..last)
            .map(|i| (distance_to_segment(points[i], points[first], points[last]), i))
            .fold((-1.0, first), |best, new| if new.0 > best.0 { new } else { best });
        if distance <= tolerance_m && grid.step_is_free(points[first], points[last]) {
            continue;
        }
        let split = if distance > tolerance_m { farthest } else { first.midpoint(last) };
        kept[split] = true;
        open.extend([(first, split), (split, last)]);
    }
    points.iter().zip(kept).filter_map(|(point, kept)| kept.then_some(*point)).collect()
}

fn distance_to_segment(point: DVec2, from: DVec2, to: DVec2) -> f64 {
    let step = to - from;
    let length_squared = step.length_squared();
    let share = if length_squared > 0.0 { ((point - from).dot(step) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    (from + share * step - point).length()
}

/// Course of a span between two control points.
#[derive(Clone, Copy, PartialEq)]
enum Span {
    /// On the spline, after this many halvings.
    Curved(u8),
    /// On the chord, which is known to be free.
    Straight,
}

/// Centripetal Catmull-Rom through the points. A span that leaves the free ground is halved (its middle becomes
/// a control point), at last walked straight; its neighbours bend anew, so this repeats until all is free.
fn spline(grid: &WalkableGrid, controls: &[DVec2]) -> Vec<DVec2> {
    let mut controls = controls.to_vec();
    controls.dedup_by(|a, b| (*a - *b).length() < 1e-6);
    if controls.len() < 2 {
        return controls;
    }
    let mut spans = vec![Span::Curved(0); controls.len() - 1];
    // Samples of a span while its four control points are unchanged.
    let mut sampled: Vec<Option<Vec<DVec2>>> = vec![None; spans.len()];
    while let Some(span) = sampled.iter().position(Option::is_none) {
        let chord = [controls[span], controls[span + 1]];
        let Span::Curved(halvings) = spans[span] else {
            sampled[span] = Some(subdivided(chord[0], chord[1]));
            continue;
        };
        let points = span_points(neighbourhood(&controls, span));
        if points.windows(2).all(|pair| grid.step_is_free(pair[0], pair[1])) {
            sampled[span] = Some(points);
        } else if halvings < MAX_HALVINGS && (chord[1] - chord[0]).length() > 4.0 * CHORD_M {
            controls.insert(span + 1, 0.5 * (chord[0] + chord[1]));
            spans[span] = Span::Curved(halvings + 1);
            spans.insert(span, Span::Curved(halvings + 1));
            sampled.insert(span, None);
            for beside in [span.checked_sub(1), Some(span + 2)].into_iter().flatten() {
                if beside < sampled.len() {
                    sampled[beside] = None;
                }
            }
        } else {
            spans[span] = Span::Straight;
        }
    }
    let mut path = vec![controls[0]];
    path.extend(sampled.iter().flatten().flat_map(|points| &points[1..]));
    path
}

/// The four control points of a span; at the ends the curve goes on straight.
fn neighbourhood(controls: &[DVec2], span: usize) -> [DVec2; 4] {
    let (from, to) = (controls[span], controls[span + 1]);
    let before = if span > 0 { controls[span - 1] } else { 2.0 * from - to };
    let after = controls.get(span + 2).copied().unwrap_or(2.0 * to - from);
    [before, from, to, after]
}

/// Points of the curve between the middle two control points, at most [`CHORD_M`] apart, both ends included.
fn span_points(p: [DVec2; 4]) -> Vec<DVec2> {
    let mut count = ((p[2] - p[1]).length() / CHORD_M * 1.1).ceil().max(1.0) as usize;
    loop {
        let points: Vec<DVec2> = (0..=count)
            .map(|i| match i {
                0 => p[1],
                i if i == count => p[2],
                i => catmull_rom(p, i as f64 / count as f64),
            })
            .collect();
        if points.windows(2).all(|pair| (pair[1] - pair[0]).length() <= CHORD_M) {
            return points;
        }
        count = count * 3 / 2 + 1;
    }
}

fn subdivided(from: DVec2, to: DVec2) -> Vec<DVec2> {
    let count = ((to - from).length() / CHORD_M).ceil().max(1.0) as usize;
    (0..=count).map(|i| if i == count { to } else { from + (to - from) * (i as f64 / count as f64) }).collect()
}

/// Centripetal Catmull-Rom (knots at the square root of the chord) by Barry and Goldman's pyramid.
fn catmull_rom(p: [DVec2; 4], share: f64) -> DVec2 {
    let knot = |a: DVec2, b: DVec2| (b - a).length().sqrt().max(1e-6);
    let t1 = knot(p[0], p[1]);
    let t2 = t1 + knot(p[1], p[2]);
    let t3 = t2 + knot(p[2], p[3]);
    let t = t1 + share * (t2 - t1);
    let mix = |a: DVec2, b: DVec2, from: f64, to: f64| a * ((to - t) / (to - from)) + b * ((t - from) / (to - from));
    let (a1, a2, a3) = (mix(p[0], p[1], 0.0, t1), mix(p[1], p[2], t1, t2), mix(p[2], p[3], t2, t3));
    let (b1, b2) = (mix(a1, a2, 0.0, t2), mix(a2, a3, t1, t3));
    mix(b1, b2, t1, t2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PedestrianConfig;
    use crate::grid::test_towns::{pillar, rectangle, town};
    use cosfly_domain::WalkableKind;

    fn corner_town() -> WalkableGrid {
        let along = rectangle(WalkableKind::Sidewalk, (0.0, 0.0), (30.0, 2.0), 0.0);
        let down = rectangle(WalkableKind::Sidewalk, (28.0, 0.0), (30.0, 30.0), 0.0);
        let post = pillar((20.0, 1.0), 0.3, 3.0);
        WalkableGrid::build(&town(vec![along, down], vec![post]), &PedestrianConfig::default()).unwrap()
    }

    #[test]
    fn a_spline_that_would_leave_the_pavement_is_pulled_back() {
        let grid = corner_town();
        // Along the very edge and sharply round the outer corner: the curve swings out of the ground there.
        let controls = [(1.0, 0.1), (15.0, 0.1), (22.0, 0.1), (29.9, 0.1), (29.9, 29.0)].map(|(x, y)| DVec2::new(x, y));
        let free = |points: &[DVec2]| points.windows(2).all(|pair| grid.step_is_free(pair[0], pair[1]));
        let swung: Vec<DVec2> = (0..4).flat_map(|span| span_points(neighbourhood(&controls, span))).collect();
        assert!(!free(&swung));
        let path = spline(&grid, &controls);
        assert!(free(&path));
        assert!(path.windows(2).all(|pair| (pair[1] - pair[0]).length() <= CHORD_M + 1e-12));
        assert_eq!((path[0], path[path.len() - 1]), (controls[0], controls[4]));
    }

    #[test]
    fn a_simplified_step_never_cuts_through_a_post() {
        let grid = corner_town();
        let around =
            [(15.0, 1.0), (19.0, 0.35), (20.0, 0.35), (21.0, 0.35), (25.0, 1.0)].map(|(x, y)| DVec2::new(x, y));
        assert!(!grid.step_is_free(around[0], around[4]));
        let kept = simplify(&grid, &around, 5.0);
        assert!(kept.windows(2).all(|pair| grid.step_is_free(pair[0], pair[1])), "{kept:?}");
    }

    #[test]
    fn centripetal_knots_pass_through_their_points() {
        let p = [(0.0, 0.0), (1.0, 0.0), (1.0, 5.0), (9.0, 5.0)].map(|(x, y)| DVec2::new(x, y));
        assert!((catmull_rom(p, 0.0) - p[1]).length() < 1e-12 && (catmull_rom(p, 1.0) - p[2]).length() < 1e-12);
    }
}
