//! Outlines around points in plan: the convex hull and the direction of the smallest rectangle.

use cosfly_frames::{DVec2, real};

/// Sides of an outline that are tried as a side of its smallest rectangle.
const MOST_SIDES: usize = 256;

/// Corners of the smallest convex outline around points, counter-clockwise from x to y.
pub fn convex_hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let mut hull: Vec<DVec2> = Vec::new();
    let add = |point: DVec2, least: usize, hull: &mut Vec<DVec2>| {
        while hull.len() > least
            && (hull[hull.len() - 1] - hull[hull.len() - 2]).perp_dot(point - hull[hull.len() - 2]) <= 0.0
        {
            hull.pop();
        }
        hull.push(point);
    };
    for point in &points {
        add(*point, 1, &mut hull);
    }
    let lower = hull.len();
    for point in points.iter().rev().skip(1) {
        add(*point, lower, &mut hull);
    }
    hull
}

/// Direction of the smallest rectangle around a convex outline.
pub fn smallest_rectangle_rad(hull: &[DVec2]) -> f64 {
    let area_m2 = |side: &DVec2| {
        let along = side.normalize_or(DVec2::X);
        let extent = |axis: DVec2| {
            let reach = hull.iter().map(|corner| corner.dot(axis));
            reach.clone().fold(f64::NEG_INFINITY, f64::max) - reach.fold(f64::INFINITY, f64::min)
        };
        extent(along) * extent(along.perp())
    };
    let sides = hull.windows(2).map(|pair| pair[1] - pair[0]).filter(|side| side.length() > 1e-6);
    let sides = sides.step_by(1 + hull.len() / MOST_SIDES);
    let best = sides.map(|side| (area_m2(&side), side)).min_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or(0.0, |(_, side)| real::atan2(side.y, side.x))
}
