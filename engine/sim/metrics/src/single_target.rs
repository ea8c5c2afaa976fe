//! Scores of a tracker of one target in a picture that shows it, as got10k's toolkit defines them.

use cosfly_frames::real;

/// Number of overlaps that success is a mean over: 0, 0.05 ... 1.
const OVERLAPS: usize = 21;
/// Number of distances in sizes of the target that normalised precision is a mean over: 0, 0.01 ... 0.5.
const DISTANCES: usize = 51;
/// Largest distance between the middles that precision allows, pixels.
pub const PRECISION_PX: f64 = 20.0;

/// Success, precision and normalised precision of a box in one picture; means over pictures are those of a sequence. Boxes are left, top,
/// width and height, pixels. In the order of [`OF_TARGETS`](crate::scores::OF_TARGETS).
pub fn scores(found: &[f64; 4], truth: &[f64; 4]) -> [f64; 3] {
    let overlap = overlap(found, truth);
    let success = (0..OVERLAPS).filter(|place| overlap > *place as f64 * 0.05).count() as f64 / OVERLAPS as f64;
    let away = |axis: usize| found[axis] + 0.5 * found[axis + 2] - truth[axis] - 0.5 * truth[axis + 2];
    let away_px = real::hypot(away(0), away(1));
    let sizes = real::hypot(away(0) / truth[2].max(1.0), away(1) / truth[3].max(1.0));
    let near = (0..DISTANCES).filter(|place| sizes <= *place as f64 * 0.01).count() as f64 / DISTANCES as f64;
    [success, f64::from(u8::from(away_px <= PRECISION_PX)), near]
}

/// Intersection over union.
fn overlap(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    let side = |axis: usize| ((a[axis] + a[axis + 2]).min(b[axis] + b[axis + 2]) - a[axis].max(b[axis])).max(0.0);
    let common = side(0) * side(1);
    let union = a[2] * a[3] + b[2] * b[3] - common;
    (common / (union + f64::EPSILON)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_true_box_misses_one_overlap_of_21_and_strangers_all() {
        let truth = [10.0, 20.0, 40.0, 80.0];
        assert_eq!(scores(&truth, &truth), [20.0 / 21.0, 1.0, 1.0]);
        assert_eq!(scores(&[500.0, 20.0, 40.0, 80.0], &truth), [0.0; 3]);
        // 20 pixels to the side are half a width: the last of the distances.
        assert_eq!(scores(&[30.0, 20.0, 40.0, 80.0], &truth)[1..], [1.0, 1.0 / 51.0]);
        assert_eq!(scores(&[0.0; 4], &truth), [0.0; 3], "no box at all");
    }
}
