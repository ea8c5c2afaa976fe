//! Overlap of pixel boxes.

/// Intersection over union (IoU) of two boxes given by their left, top, right and bottom edges: areas between
/// continuous edges, without an added pixel. Boxes without area have an IoU of 0.
pub fn iou(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    let side = |low: f64, high: f64| (high - low).max(0.0);
    let area = |edges: &[f64; 4]| side(edges[0], edges[2]) * side(edges[1], edges[3]);
    let common = side(a[0].max(b[0]), a[2].min(b[2])) * side(a[1].max(b[1]), a[3].min(b[3]));
    let union = area(a) + area(b) - common;
    if union > 0.0 { common / union } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_overlap_by_a_third_and_strangers_not_at_all() {
        let a = [0.0, 0.0, 2.0, 2.0];
        assert_eq!(iou(&a, &a), 1.0);
        assert!((iou(&a, &[1.0, 0.0, 3.0, 2.0]) - 1.0 / 3.0).abs() < 1e-15);
        assert_eq!(iou(&a, &[2.0, 0.0, 3.0, 2.0]), 0.0);
        assert_eq!(iou(&[1.0, 1.0, 1.0, 1.0], &[1.0, 1.0, 1.0, 1.0]), 0.0);
        assert_eq!(iou(&[2.0, 2.0, 0.0, 0.0], &a), 0.0, "reversed edges enclose nothing");
    }
}
