//! Covers a polygon's footprint with few turned rectangles that contain it.

use cosfly_frames::{DVec2, real};

/// A rectangle's overhang beyond the polygon's slanted sides is at most this deep, metres, as long as
/// [`MOST_STRIPS`] allows.
pub const COVER_TOLERANCE_M: f64 = 0.25;
/// Most strips between two corners of the polygon.
const MOST_STRIPS: f64 = 64.0;
/// Polygons with more corners are covered by one rectangle.
const MOST_CORNERS: usize = 512;

/// A rectangle turned about its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnedRectangle {
    /// Centre, metres.
    pub center: DVec2,
    /// Half its size along its own axes, metres.
    pub half_extents_m: DVec2,
    /// Turn from x towards y, radians.
    pub yaw_rad: f64,
}

/// Rectangles whose union contains the polygon (corners in order, either way round). One rectangle where it
/// fits within the tolerance, else strips along the side of the polygon that needs fewest.
pub fn cover_polygon(outline: &[DVec2]) -> Vec<TurnedRectangle> {
    if outline.len() < 2 {
        return Vec::new();
    }
    let area_m2 = area_m2(outline);
    let angles = side_angles_rad(outline);
    let smallest = angles
        .iter()
        .map(|angle| bounding(outline, *angle))
        .min_by(|a, b| rectangle_area_m2(a).total_cmp(&rectangle_area_m2(b)));
    let Some(smallest) = smallest else { return Vec::new() };
    // Allowed addition of a rectangle: its tolerance along half its edge.
    let spare_m2 = 0.5 * COVER_TOLERANCE_M * (smallest.half_extents_m.x + smallest.half_extents_m.y);
    if outline.len() < 4 && area_m2 <= 0.0
        || rectangle_area_m2(&smallest) - area_m2 <= spare_m2.min(0.05 * rectangle_area_m2(&smallest)) + 1e-9
        || outline.len() > MOST_CORNERS
    {
        return vec![smallest];
    }
    let covers = angles.iter().take(4).map(|angle| strips(outline, *angle));
    covers.min_by_key(Vec::len).filter(|cover| !cover.is_empty()).unwrap_or_else(|| vec![smallest])
}

/// Shoelace area, never negative.
fn area_m2(outline: &[DVec2]) -> f64 {
    let first = outline[0];
    let twice: f64 = (1..outline.len() - 1).map(|i| (outline[i] - first).perp_dot(outline[i + 1] - first)).sum();
    0.5 * twice.abs()
}

fn rectangle_area_m2(rectangle: &TurnedRectangle) -> f64 {
    4.0 * rectangle.half_extents_m.x * rectangle.half_extents_m.y
}

/// Directions of the sides, longest side first.
fn side_angles_rad(outline: &[DVec2]) -> Vec<f64> {
    let mut sides: Vec<DVec2> = (0..outline.len())
        .map(|i| outline[(i + 1) % outline.len()] - outline[i])
        .filter(|side| side.length() > 1e-6)
        .collect();
    sides.sort_by(|a, b| b.length_squared().total_cmp(&a.length_squared()));
    sides.truncate(16);
    if sides.is_empty() {
        sides.push(DVec2::X);
    }
    sides.iter().map(|side| real::atan2(side.y, side.x)).collect()
}

/// Into the frame that is turned by `yaw_rad`.
fn turned(point: DVec2, yaw_rad: f64) -> DVec2 {
    let (sin, cos) = real::sin_cos(yaw_rad);
    DVec2::new(cos * point.x + sin * point.y, -sin * point.x + cos * point.y)
}

fn rectangle(low: DVec2, high: DVec2, yaw_rad: f64) -> TurnedRectangle {
    TurnedRectangle { center: turned(0.5 * (low + high), -yaw_rad), half_extents_m: 0.5 * (high - low), yaw_rad }
}

fn bounding(outline: &[DVec2], yaw_rad: f64) -> TurnedRectangle {
    let (low, high) = outline.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), point| {
        let point = turned(*point, yaw_rad);
        (low.min(point), high.max(point))
    });
    rectangle(low, high, yaw_rad)
}

/// Cuts the polygon into strips along the axis `yaw_rad` at every corner, and where slanted sides ask for it.
fn strips(outline: &[DVec2], yaw_rad: f64) -> Vec<TurnedRectangle> {
    let local: Vec<DVec2> = outline.iter().map(|point| turned(*point, yaw_rad)).collect();
    let mut levels: Vec<f64> = local.iter().map(|point| point.y).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup_by(|a, b| (*a - *b).abs() < 1e-3);
    // The outermost corners must stay inside the outermost strips although near levels were merged.
    if let (Some(last), Some(top)) = (levels.last_mut(), local.iter().map(|p| p.y).max_by(f64::total_cmp)) {
        *last = top;
    }
    let mut pieces: Vec<(DVec2, DVec2)> = Vec::new();
    for pair in levels.windows(2) {
        let slant_m = slant_m(&local, pair[0], pair[1]);
        // A strip of height h beside a side that leans by slant/height adds at most h * slant / hypot deep.
        let height_m = pair[1] - pair[0];
        let depth_m = height_m * slant_m / real::hypot(height_m, slant_m).max(1e-12);
        let count = (depth_m / COVER_TOLERANCE_M).ceil().clamp(1.0, MOST_STRIPS) as usize;
        for i in 0..count {
            let level = |i: usize| if i == count { pair[1] } else { pair[0] + height_m * i as f64 / count as f64 };
            for (low_x, high_x) in spans(&local, level(i), level(i + 1)) {
                join(&mut pieces, DVec2::new(low_x, level(i)), DVec2::new(high_x, level(i + 1)));
            }
        }
    }
    pieces.into_iter().map(|(low, high)| rectangle(low, high, yaw_rad)).collect()
}

/// Adds a piece, or lets the piece below grow when it has the same sides.
fn join(pieces: &mut Vec<(DVec2, DVec2)>, low: DVec2, high: DVec2) {
    let same = |piece: &&mut (DVec2, DVec2)| {
        (piece.1.y - low.y).abs() < 1e-9 && (piece.0.x - low.x).abs() < 1e-2 && (piece.1.x - high.x).abs() < 1e-2
    };
    match pieces.iter_mut().rev().take(8).find(same) {
        Some(below) => {
            below.1.y = high.y;
            below.0.x = below.0.x.min(low.x);
            below.1.x = below.1.x.max(high.x);
        }
        None => pieces.push((low, high)),
    }
}

/// Crossings of the polygon's sides with the lower and the upper level of a strip.
fn crossings(local: &[DVec2], low_y: f64, high_y: f64) -> Vec<(f64, f64)> {
    let middle_y = 0.5 * (low_y + high_y);
    let mut out = Vec::new();
    for i in 0..local.len() {
        let (a, b) = (local[i], local[(i + 1) % local.len()]);
        if (a.y <= middle_y) != (b.y <= middle_y) {
            let x_at = |y: f64| a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)).clamp(0.0, 1.0);
            out.push((x_at(low_y), x_at(high_y)));
        }
    }
    out.sort_by(|p, q| (p.0 + p.1).total_cmp(&(q.0 + q.1)));
    out
}

fn slant_m(local: &[DVec2], low_y: f64, high_y: f64) -> f64 {
    crossings(local, low_y, high_y).iter().map(|(low, high)| (high - low).abs()).fold(0.0, f64::max)
}

/// Intervals that hold the polygon between two levels: sides pair up from the left.
fn spans(local: &[DVec2], low_y: f64, high_y: f64) -> Vec<(f64, f64)> {
    let mut out: Vec<(f64, f64)> = Vec::new();
    for pair in crossings(local, low_y, high_y).chunks_exact(2) {
        let low = pair.iter().map(|(a, b)| a.min(*b)).fold(f64::INFINITY, f64::min);
        let high = pair.iter().map(|(a, b)| a.max(*b)).fold(f64::NEG_INFINITY, f64::max);
        match out.last_mut() {
            Some(last) if low <= last.1 => last.1 = last.1.max(high),
            _ => out.push((low, high)),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inside(outline: &[DVec2], point: DVec2) -> bool {
        let mut odd = false;
        for i in 0..outline.len() {
            let (a, b) = (outline[i], outline[(i + 1) % outline.len()]);
            if (a.y > point.y) != (b.y > point.y) && point.x < a.x + (b.x - a.x) * (point.y - a.y) / (b.y - a.y) {
                odd = !odd;
            }
        }
        odd
    }

    fn distance_m(outline: &[DVec2], point: DVec2) -> f64 {
        if inside(outline, point) {
            return 0.0;
        }
        (0..outline.len())
            .map(|i| {
                let (a, b) = (outline[i], outline[(i + 1) % outline.len()]);
                let share = ((point - a).dot(b - a) / (b - a).length_squared().max(1e-12)).clamp(0.0, 1.0);
                point.distance(a.lerp(b, share))
            })
            .fold(f64::INFINITY, f64::min)
    }

    fn covered(cover: &[TurnedRectangle], point: DVec2) -> bool {
        cover.iter().any(|rectangle| {
            let local = turned(point - rectangle.center, rectangle.yaw_rad).abs();
            local.x <= rectangle.half_extents_m.x + 1e-9 && local.y <= rectangle.half_extents_m.y + 1e-9
        })
    }

    fn check_cover(name: &str, outline: &[(f64, f64)], at_most: usize) {
        let outline: Vec<DVec2> = outline.iter().map(|(x, y)| DVec2::new(*x, *y)).collect();
        let cover = cover_polygon(&outline);
        assert!(!cover.is_empty() && cover.len() <= at_most, "{name}: {} rectangles", cover.len());
        for i in -120..=120 {
            for j in -120..=120 {
                let point = DVec2::new(f64::from(i) * 0.251 + 0.017, f64::from(j) * 0.249 + 0.013);
                let (inside, covered) = (inside(&outline, point), covered(&cover, point));
                assert!(!inside || covered, "{name}: {point} is not covered");
                let far_m = distance_m(&outline, point);
                assert!(!covered || far_m <= COVER_TOLERANCE_M + 1e-6, "{name}: {point} is covered but {far_m} m away");
            }
        }
    }

    #[test]
    fn covers_contain_the_polygon_and_stay_within_the_tolerance() {
        check_cover("rectangle", &[(0.0, 0.0), (8.0, 6.0), (5.0, 10.0), (-3.0, 4.0)], 1);
        check_cover("L", &[(0.0, 0.0), (20.0, 0.0), (20.0, 6.0), (6.0, 6.0), (6.0, 15.0), (0.0, 15.0)], 2);
        check_cover(
            "U",
            &[(0.0, 0.0), (20.0, 0.0), (20.0, 9.0), (15.0, 9.0), (15.0, 4.0), (5.0, 4.0), (5.0, 9.0), (0.0, 9.0)],
            3,
        );
        check_cover("triangle", &[(0.0, 0.0), (12.0, 3.0), (4.0, 10.0)], 40);
        check_cover("chevron", &[(0.0, 0.0), (10.0, 4.0), (20.0, 0.0), (10.0, 14.0)], 90);
        check_cover("thin wall", &[(0.0, 0.0), (14.0, 0.3), (14.0, 0.5), (0.0, 0.2)], 2);
        let round: Vec<_> = (0..24)
            .map(|i| f64::from(i) / 24.0 * real::TAU)
            .map(|angle| (9.0 * real::cos(angle), 9.0 * real::sin(angle)))
            .collect();
        check_cover("round", &round, 90);
    }

    #[test]
    fn degenerate_outlines_do_not_panic() {
        for outline in [vec![], vec![DVec2::ZERO], vec![DVec2::ZERO; 5], vec![DVec2::ZERO, DVec2::X, 2.0 * DVec2::X]] {
            assert!(cover_polygon(&outline).len() <= 1, "{outline:?}");
        }
    }
}
