//! Metrics of label images: IoU per class and their mean.

/// How often which true class was called what.
#[derive(Clone, Debug, PartialEq)]
pub struct Confusion {
    classes: usize,
    /// Row: truth, column: prediction; the last column is for labels out of range.
    pixels: Vec<u64>,
}

impl Confusion {
    /// Nothing counted yet, for labels 0..`classes`.
    pub fn new(classes: usize) -> Self {
        Self { classes, pixels: vec![0; classes * (classes + 1)] }
    }

    /// Counts the pixels of an image. A predicted label that is out of range counts as wrong for its true class;
    /// pixels whose truth is out of range are left out.
    pub fn add(&mut self, predicted: &[u8], truth: &[u8]) {
        for (predicted, truth) in predicted.iter().zip(truth) {
            let (predicted, truth) = (usize::from(*predicted), usize::from(*truth));
            if truth < self.classes {
                self.pixels[truth * (self.classes + 1) + predicted.min(self.classes)] += 1;
            }
        }
    }

    /// Intersection over union of every class; `None` where it occurs in neither.
    pub fn class_iou(&self) -> Vec<Option<f64>> {
        let of = |truth: usize, predicted: usize| self.pixels[truth * (self.classes + 1) + predicted];
        let scores = (0..self.classes).map(|class| {
            let row: u64 = (0..=self.classes).map(|other| of(class, other)).sum();
            let column: u64 = (0..self.classes).map(|other| of(other, class)).sum();
            let union = row + column - of(class, class);
            (union > 0).then(|| of(class, class) as f64 / union as f64)
        });
        scores.collect()
    }

    /// Mean of [`Self::class_iou`] over the classes that occur in truth or prediction, over all images at once.
    pub fn mean_iou(&self) -> Option<f64> {
        let scores: Vec<f64> = self.class_iou().into_iter().flatten().collect();
        (!scores.is_empty()).then(|| scores.iter().sum::<f64>() / scores.len() as f64)
    }
}

/// Intersection over union of two masks of the same size; 0 when both are empty.
pub fn mask_iou(a: &[bool], b: &[bool]) -> f64 {
    let (mut common, mut union) = (0_u64, 0_u64);
    for (a, b) in a.iter().zip(b) {
        common += u64::from(*a && *b);
        union += u64::from(*a || *b);
    }
    if union > 0 { common as f64 / union as f64 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_that_occur_nowhere_do_not_count() {
        let mut confusion = Confusion::new(29);
        confusion.add(&[1, 1, 2, 2], &[1, 1, 1, 2]);
        assert_eq!(confusion.class_iou()[1], Some(2.0 / 3.0));
        assert_eq!(confusion.mean_iou(), Some((2.0 / 3.0 + 0.5) / 2.0));
        assert_eq!(Confusion::new(3).mean_iou(), None);
        let mut confusion = Confusion::new(2);
        confusion.add(&[200, 0], &[0, 0]);
        assert_eq!(confusion.class_iou(), [Some(0.5), None], "a label out of range is a miss and nothing else");
    }

    #[test]
    fn masks_overlap_by_their_common_share() {
        assert_eq!(mask_iou(&[true, true, false], &[false, true, true]), 1.0 / 3.0);
        assert_eq!(mask_iou(&[false], &[false]), 0.0);
    }
}
