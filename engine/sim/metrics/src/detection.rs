//! Average precision as COCO defines it: matching by overlap, interpolated at 101 recalls.

/// Detections that count per image, the ones with the best scores.
pub const MAX_DETECTIONS: usize = 100;

/// Detections of one class in one image, and how they overlap what is there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImageDetections {
    /// Score of each detection.
    pub scores: Vec<f64>,
    /// Intersection over union: row per detection, column per true object. Of boxes or of masks.
    pub overlaps: Vec<Vec<f64>>,
    /// True objects.
    pub objects: usize,
}

/// Average precisions over images.
#[derive(Clone, Debug, PartialEq)]
pub struct AveragePrecision {
    /// At an overlap of 0.5.
    pub ap50: f64,
    /// At 0.75.
    pub ap75: f64,
    /// Mean over overlaps 0.5, 0.55 ... 0.95: COCO's AP.
    pub ap: f64,
}

/// The ten overlaps that COCO averages over.
fn thresholds() -> [f64; 10] {
    core::array::from_fn(|k| if k == 9 { 0.95 } else { 0.5 + k as f64 * ((0.95 - 0.5) / 9.0) })
}

/// Average precision of one class; `None` when there is no object at all.
pub fn average_precision(images: &[ImageDetections]) -> Option<AveragePrecision> {
    let objects: usize = images.iter().map(|image| image.objects).sum();
    if objects == 0 {
        return None;
    }
    let at: Vec<f64> = thresholds().iter().map(|threshold| precision_at(images, objects, *threshold)).collect();
    Some(AveragePrecision { ap50: at[0], ap75: at[5], ap: at.iter().sum::<f64>() / at.len() as f64 })
}

fn precision_at(images: &[ImageDetections], objects: usize, threshold: f64) -> f64 {
    let mut found: Vec<(f64, bool)> = images.iter().flat_map(|image| matches(image, threshold)).collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (mut hits, mut recalls, mut precisions) = (0_usize, vec![], vec![]);
    for (number, (_, hit)) in found.iter().enumerate() {
        hits += usize::from(*hit);
        recalls.push(hits as f64 / objects as f64);
        precisions.push(hits as f64 / (number + 1) as f64);
    }
    // A precision is the best that is still to come at this recall or more.
    for number in (1..precisions.len()).rev() {
        precisions[number - 1] = precisions[number - 1].max(precisions[number]);
    }
    let at_recall = |recall: f64| {
        let first = recalls.partition_point(|it| *it < recall);
        precisions.get(first).copied().unwrap_or(0.0)
    };
    (0..=100).map(|k| at_recall(if k == 100 { 1.0 } else { f64::from(k) * 0.01 })).sum::<f64>() / 101.0
}

/// Score of each counted detection, best first, and whether it found an object that no better one had found.
fn matches(image: &ImageDetections, threshold: f64) -> Vec<(f64, bool)> {
    let mut order: Vec<usize> = (0..image.scores.len().min(image.overlaps.len())).collect();
    order.sort_by(|a, b| image.scores[*b].total_cmp(&image.scores[*a]));
    order.truncate(MAX_DETECTIONS);
    let mut taken = vec![false; image.objects];
    let mut found = Vec::with_capacity(order.len());
    for detection in order {
        let (mut best, mut matched) = (threshold.min(1.0 - 1e-10), None);
        for (object, overlap) in image.overlaps[detection].iter().enumerate().take(image.objects) {
            if !taken[object] && *overlap >= best {
                (best, matched) = (*overlap, Some(object));
            }
        }
        if let Some(object) = matched {
            taken[object] = true;
        }
        found.push((image.scores[detection], matched.is_some()));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_detection_of_the_same_object_is_a_false_one() {
        let image = ImageDetections {
            scores: vec![0.9, 0.8, 0.7],
            overlaps: vec![vec![0.9, 0.0], vec![0.8, 0.0], vec![0.0, 0.6]],
            objects: 2,
        };
        let found = average_precision(&[image]).unwrap();
        // Precision 1 up to recall 0.5 (51 of the 101 recalls), 2/3 up to recall 1.
        assert!((found.ap50 - (51.0 + 50.0 * 2.0 / 3.0) / 101.0).abs() < 1e-12, "{found:?}");
        assert!((found.ap75 - 51.0 / 101.0).abs() < 1e-12);
    }

    #[test]
    fn without_objects_there_is_no_precision_and_without_detections_it_is_zero() {
        assert_eq!(average_precision(&[ImageDetections::default()]), None);
        let missed = ImageDetections { objects: 1, ..Default::default() };
        assert_eq!(average_precision(&[missed]).unwrap().ap, 0.0);
    }
}
