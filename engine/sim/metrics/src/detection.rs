//! Average precision as COCO defines it: matching by overlap, interpolated at 101 recalls.

/// Most detections scored per image, those with the best scores.
pub const MAX_DETECTIONS: usize = 100;

/// Number of overlaps that COCO averages over: 0.5, 0.55 ... 0.95.
pub const THRESHOLDS: usize = 10;

/// Detections of one class in one image, and their overlaps with the true objects.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImageDetections {
    /// Score of each detection.
    pub scores: Vec<f64>,
    /// Intersection over union of boxes or masks: a row per detection, a column per true object.
    pub overlaps: Vec<Vec<f64>>,
    /// Number of true objects.
    pub objects: usize,
}

/// Average precisions over images.
#[derive(Clone, Debug, PartialEq)]
pub struct AveragePrecision {
    /// Average precision at an overlap of 0.5.
    pub ap50: f64,
    /// Average precision at an overlap of 0.75.
    pub ap75: f64,
    /// Mean over overlaps 0.5, 0.55 ... 0.95: COCO's AP.
    pub ap: f64,
}

/// A scored detection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ranked {
    /// Score of the detection.
    pub score: f64,
    /// Cluster of its image; images of one cluster are resampled together.
    pub cluster: u32,
    /// Bit k: at overlap k of the ten it matches an object that no better detection matches.
    pub hits: u16,
}

impl ImageDetections {
    /// Scored detections, best first.
    pub fn ranked(&self, cluster: u32) -> Vec<Ranked> {
        let mut order: Vec<usize> = (0..self.scores.len().min(self.overlaps.len())).collect();
        order.sort_by(|a, b| self.scores[*b].total_cmp(&self.scores[*a]));
        order.truncate(MAX_DETECTIONS);
        let mut found: Vec<Ranked> =
            order.iter().map(|at| Ranked { score: self.scores[*at], cluster, hits: 0 }).collect();
        for (bit, threshold) in thresholds().into_iter().enumerate() {
            let mut taken = vec![false; self.objects];
            for (detection, ranked) in order.iter().zip(&mut found) {
                let (mut best, mut matched) = (threshold.min(1.0 - 1e-10), None);
                for (object, overlap) in self.overlaps[*detection].iter().enumerate().take(self.objects) {
                    if !taken[object] && *overlap >= best {
                        (best, matched) = (*overlap, Some(object));
                    }
                }
                if let Some(object) = matched {
                    taken[object] = true;
                    ranked.hits |= 1 << bit;
                }
            }
        }
        found
    }

    /// Sum over the objects of the largest overlap with a detection.
    pub fn best_overlaps(&self) -> f64 {
        let best = |object: usize| self.overlaps.iter().filter_map(|row| row.get(object)).copied().fold(0.0, f64::max);
        (0..self.objects).map(best).sum()
    }
}

/// Detections of one class in all images, best first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ranking {
    cluster: Vec<u32>,
    /// Indices of the hits at each overlap.
    hits: [Vec<u32>; THRESHOLDS],
    /// Numbers of true objects by cluster.
    objects: Vec<u64>,
}

impl Ranking {
    /// Ranks detections, given in the order of their images; `objects` are the numbers of true objects by cluster.
    pub fn new(mut found: Vec<Ranked>, objects: Vec<u64>) -> Self {
        found.sort_by(|a, b| b.score.total_cmp(&a.score));
        let at = |bit: usize| {
            let hits = found.iter().zip(0..).filter(move |(ranked, _)| ranked.hits & (1 << bit) != 0);
            hits.map(|(_, place): (_, u32)| place).collect()
        };
        Self { hits: core::array::from_fn(at), cluster: found.iter().map(|ranked| ranked.cluster).collect(), objects }
    }

    /// Average precision when cluster k counts `times(k)` times; `None` without objects.
    pub fn precision(&self, times: &dyn Fn(usize) -> u64) -> Option<AveragePrecision> {
        let weights: Vec<u64> = (0..self.objects.len()).map(times).collect();
        let objects: u64 = self.objects.iter().zip(&weights).map(|(objects, times)| objects * times).sum();
        if objects == 0 {
            return None;
        }
        let weight = |place: usize| weights.get(self.cluster[place] as usize).copied().unwrap_or(0);
        let mut counted = 0;
        let mut so_far = Vec::with_capacity(self.cluster.len());
        for place in 0..self.cluster.len() {
            counted += weight(place);
            so_far.push(counted);
        }
        let at: [f64; THRESHOLDS] = core::array::from_fn(|bit| {
            let mut found = 0;
            let mut curve = Vec::with_capacity(self.hits[bit].len());
            for place in self.hits[bit].iter().map(|place| *place as usize).filter(|place| weight(*place) > 0) {
                found += weight(place);
                curve.push((found as f64 / objects as f64, found as f64 / so_far[place] as f64));
            }
            interpolated(&mut curve)
        });
        Some(AveragePrecision { ap50: at[0], ap75: at[5], ap: at.iter().sum::<f64>() / at.len() as f64 })
    }
}

/// Mean over 101 recalls of the best precision at this recall or above; `curve` has recall and precision at every hit.
fn interpolated(curve: &mut [(f64, f64)]) -> f64 {
    for number in (1..curve.len()).rev() {
        curve[number - 1].1 = curve[number - 1].1.max(curve[number].1);
    }
    let (mut first, mut sum) = (0, 0.0);
    for k in 0..=100 {
        let recall = if k == 100 { 1.0 } else { f64::from(k) * 0.01 };
        while curve.get(first).is_some_and(|(reached, _)| *reached < recall) {
            first += 1;
        }
        sum += curve.get(first).map_or(0.0, |(_, precision)| *precision);
    }
    sum / 101.0
}

/// Overlaps 0.5, 0.55 ... 0.95.
fn thresholds() -> [f64; THRESHOLDS] {
    core::array::from_fn(|k| if k == 9 { 0.95 } else { 0.5 + k as f64 * ((0.95 - 0.5) / 9.0) })
}

/// Average precision of one class; `None` without objects.
pub fn average_precision(images: &[ImageDetections]) -> Option<AveragePrecision> {
    let objects = images.iter().map(|image| image.objects as u64).sum();
    Ranking::new(images.iter().flat_map(|image| image.ranked(0)).collect(), vec![objects]).precision(&|_| 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_objects() -> ImageDetections {
        ImageDetections {
            scores: vec![0.9, 0.8, 0.7],
            overlaps: vec![vec![0.9, 0.0], vec![0.8, 0.0], vec![0.0, 0.6]],
            objects: 2,
        }
    }

    #[test]
    fn a_second_detection_of_the_same_object_is_a_false_one() {
        let image = two_objects();
        assert_eq!(image.best_overlaps(), 1.5);
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

    #[test]
    fn a_cluster_that_counts_not_at_all_is_as_if_it_were_not_there() {
        let noise = ImageDetections { scores: vec![0.95], overlaps: vec![vec![0.1]], objects: 1 };
        let both: Vec<Ranked> = [two_objects().ranked(0), noise.ranked(1)].concat();
        let ranking = Ranking::new(both, vec![2, 1]);
        assert_eq!(ranking.precision(&|cluster| u64::from(cluster == 0)), average_precision(&[two_objects()]));
        assert!(ranking.precision(&|_| 1).unwrap().ap50 < average_precision(&[two_objects()]).unwrap().ap50);
        assert_eq!(ranking.precision(&|_| 0), None);
    }
}
