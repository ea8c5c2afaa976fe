//! The widest gap between the things of a town: towns whose parts were placed by two origins fall apart.

/// From this gap on, the things of one town are in two places, metres: no town has so wide a strip without anything.
pub const APART_M: f64 = 5_000.0;

/// The widest strip along the x or y axis that no point is in, metres; 0 of fewer than two points. `points` are x and y,
/// metres. Infinite where a coordinate is not finite.
pub fn widest_gap_m(points: &[[f64; 2]]) -> f64 {
    if points.iter().flatten().any(|value| !value.is_finite()) {
        return f64::INFINITY;
    }
    let along = |axis: usize| {
        let mut values: Vec<f64> = points.iter().map(|point| point[axis]).collect();
        values.sort_by(f64::total_cmp);
        values.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
    };
    along(0).max(along(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gap_is_the_widest_strip_without_a_point() {
        assert_eq!(widest_gap_m(&[]), 0.0);
        assert_eq!(widest_gap_m(&[[3.0, 4.0]]), 0.0);
        assert_eq!(widest_gap_m(&[[0.0, 0.0], [10.0, 1.0], [4.0, -7.0]]), 7.0);
        assert_eq!(widest_gap_m(&[[0.0, 0.0], [f64::NAN, 0.0]]), f64::INFINITY);
    }
}
