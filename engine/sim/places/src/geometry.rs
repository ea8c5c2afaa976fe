//! Polygons on the ground: areas, cuts, insets, distances. Corners counter-clockwise, the first not repeated.

use cosfly_frames::{DVec2, real};

/// Twice the signed area, square metres; positive when counter-clockwise.
pub fn twice_area_m2(outline: &[DVec2]) -> f64 {
    edges(outline).map(|[a, b]| a.perp_dot(b)).sum()
}

/// The sides of an outline.
pub fn edges(outline: &[DVec2]) -> impl Iterator<Item = [DVec2; 2]> + '_ {
    outline.iter().enumerate().map(|(at, corner)| [*corner, outline[(at + 1) % outline.len()]])
}

/// Middle of the area; the mean of the corners where there is none.
pub fn middle(outline: &[DVec2]) -> DVec2 {
    let mean = outline.iter().sum::<DVec2>() / outline.len().max(1) as f64;
    let mut sum = (0.0, DVec2::ZERO);
    for [a, b] in edges(outline) {
        let twice_m2 = (a - mean).perp_dot(b - mean);
        sum = (sum.0 + twice_m2, sum.1 + twice_m2 / 3.0 * (a + b - 2.0 * mean));
    }
    if sum.0.abs() > 1e-9 { mean + sum.1 / sum.0 } else { mean }
}

/// How far a ray from inside a convex polygon goes, metres.
pub fn reach_m(outline: &[DVec2], from: DVec2, direction: DVec2) -> f64 {
    let to_side = |[a, b]: [DVec2; 2]| {
        let along = b - a;
        let crossed = direction.perp_dot(along);
        if crossed.abs() < 1e-9 { f64::INFINITY } else { (a - from).perp_dot(along) / crossed }
    };
    edges(outline).map(to_side).filter(|reach_m| *reach_m > 0.0).fold(f64::INFINITY, f64::min)
}

/// Whether a point lies inside (even-odd rule).
pub fn contains(outline: &[DVec2], at: DVec2) -> bool {
    edges(outline).filter(|[a, b]| crosses_east(*a, *b, at)).count() % 2 == 1
}

/// Whether the ray from a point to the east crosses a segment.
pub fn crosses_east(a: DVec2, b: DVec2, at: DVec2) -> bool {
    (a.y > at.y) != (b.y > at.y) && at.x < (b.x - a.x) * (at.y - a.y) / (b.y - a.y) + a.x
}

/// The part of a convex polygon to the left of a directed line.
pub fn cut(outline: &[DVec2], point: DVec2, along: DVec2) -> Vec<DVec2> {
    let left_m = |at: DVec2| along.perp_dot(at - point);
    let mut part: Vec<DVec2> = Vec::new();
    for [a, b] in edges(outline) {
        let (from, to) = (left_m(a), left_m(b));
        if from >= 0.0 {
            part.push(a);
        }
        if (from < 0.0) != (to < 0.0) {
            part.push(a.lerp(b, from / (from - to)));
        }
    }
    part.dedup_by(|a, b| a.distance(*b) < 1e-6);
    part
}

/// A convex polygon with all sides moved inwards; empty where nothing is left.
pub fn inset(outline: &[DVec2], by_m: f64) -> Vec<DVec2> {
    let sides = edges(outline).filter(|[a, b]| a.distance(*b) > 1e-6);
    sides.fold(outline.to_vec(), |part, [a, b]| {
        let along = (b - a).normalize();
        cut(&part, a + by_m * along.perp(), along)
    })
}

/// Direction of the longer side of the smallest of the rectangles along a convex polygon's sides, and the
/// rectangle's extent in that direction and across it, metres.
pub fn long_axis(outline: &[DVec2]) -> (DVec2, DVec2) {
    let extent_m = |axis: DVec2| {
        let along = outline.iter().map(|at| at.dot(axis));
        let [low, high] = along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)]);
        high - low
    };
    let mut best: Option<(f64, DVec2, DVec2)> = None;
    for [a, b] in edges(outline) {
        let Some(axis) = (b - a).try_normalize() else { continue };
        let size_m = DVec2::new(extent_m(axis), extent_m(axis.perp()));
        if best.is_none_or(|(least, ..)| size_m.x * size_m.y < least) {
            best = Some((size_m.x * size_m.y, axis, size_m));
        }
    }
    let (_, axis, size_m) = best.unwrap_or((0.0, DVec2::X, DVec2::ZERO));
    if size_m.x >= size_m.y { (axis, size_m) } else { (axis.perp(), DVec2::new(size_m.y, size_m.x)) }
}

/// Distance of two segments, metres.
pub fn segment_distance_m([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> f64 {
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
    if side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0 {
        return 0.0;
    }
    let to_segment = |at: DVec2, [p, q]: [DVec2; 2]| {
        let along = q - p;
        let share = ((at - p).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
        at.distance(p + share * along)
    };
    to_segment(a, [c, d]).min(to_segment(b, [c, d])).min(to_segment(c, [a, b])).min(to_segment(d, [a, b]))
}

/// Smallest and largest corner.
pub fn bounds(outline: &[DVec2]) -> [DVec2; 2] {
    let around = |[low, high]: [DVec2; 2], at: &DVec2| [low.min(*at), high.max(*at)];
    outline.iter().fold([DVec2::INFINITY, DVec2::NEG_INFINITY], around)
}

/// A regular polygon.
pub fn disc(center: DVec2, radius_m: f64, corners: usize) -> Vec<DVec2> {
    let corner = |at: usize| {
        let (sin, cos) = real::sin_cos(2.0 * real::PI * at as f64 / corners as f64);
        center + radius_m * DVec2::new(cos, sin)
    };
    (0..corners).map(corner).collect()
}

/// The largest convex part of an outline that lies to the left of all its sides; the outline itself where it is convex.
pub fn convex_core(outline: &[DVec2]) -> Vec<DVec2> {
    grown(outline, 0.0)
}

/// A convex polygon with all sides moved outwards.
pub fn grown(outline: &[DVec2], by_m: f64) -> Vec<DVec2> {
    let [low, high] = bounds(outline);
    let (low, high) = (low - by_m, high + by_m);
    let all = vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
    let sides = edges(outline).filter(|[a, b]| a.distance(*b) > 1e-3).map(|[a, b]| (a, (b - a).normalize()));
    sides.fold(all, |part, (a, along)| cut(&part, a - by_m * along.perp(), along))
}

/// A rectangle `size_m` along and across a direction, from the middle of its front to the left of that direction.
pub fn rectangle(front: DVec2, along: DVec2, size_m: DVec2) -> Vec<DVec2> {
    let (half, deep) = (0.5 * size_m.x * along, size_m.y * along.perp());
    vec![front - half, front + half, front + half + deep, front - half + deep]
}

/// Where two lines meet, each by a point and a direction; between the points where they are parallel.
pub fn meeting([a, along_a]: [DVec2; 2], [b, along_b]: [DVec2; 2]) -> DVec2 {
    let crossed = along_a.perp_dot(along_b);
    if crossed.abs() < 1e-9 { 0.5 * (a + b) } else { a + along_a * ((b - a).perp_dot(along_b) / crossed) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [DVec2; 4] =
        [DVec2::new(0.0, 0.0), DVec2::new(10.0, 0.0), DVec2::new(10.0, 10.0), DVec2::new(0.0, 10.0)];

    #[test]
    fn a_cut_and_an_inset_keep_the_inner_part() {
        assert_eq!(twice_area_m2(&cut(&SQUARE, DVec2::new(4.0, 0.0), DVec2::Y)), 80.0);
        assert_eq!(twice_area_m2(&inset(&SQUARE, 1.0)), 128.0);
        assert!(inset(&SQUARE, 6.0).is_empty());
        assert!(contains(&SQUARE, DVec2::splat(3.0)) && !contains(&SQUARE, DVec2::splat(-1.0)));
    }

    #[test]
    fn the_middle_is_that_of_the_area_and_rays_end_at_the_sides() {
        let many = [SQUARE[0], DVec2::new(1.0, 0.0), DVec2::new(2.0, 0.0), SQUARE[1], SQUARE[2], SQUARE[3]];
        assert!(middle(&many).distance(DVec2::splat(5.0)) < 1e-9);
        assert_eq!(reach_m(&SQUARE, DVec2::new(4.0, 5.0), DVec2::X), 6.0);
    }

    #[test]
    fn segments_that_cross_have_no_distance() {
        let across = [DVec2::new(5.0, -1.0), DVec2::new(5.0, 1.0)];
        assert_eq!(segment_distance_m([SQUARE[0], SQUARE[1]], across), 0.0);
        assert_eq!(segment_distance_m([SQUARE[0], SQUARE[3]], across), 5.0);
    }
}
