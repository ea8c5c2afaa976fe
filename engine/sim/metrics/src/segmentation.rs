//! Metrics of label images: IoU per class and their mean.

/// Numbers of pixels by class: in the intersection, in the truth, and in the prediction.
#[derive(Clone, Debug, PartialEq)]
pub struct Confusion {
    common: Vec<u64>,
    truth: Vec<u64>,
    predicted: Vec<u64>,
}

impl Confusion {
    /// Creates empty counts for labels 0..`classes`.
    pub fn new(classes: usize) -> Self {
        Self { common: vec![0; classes], truth: vec![0; classes], predicted: vec![0; classes] }
    }

    /// Adds the pixels of an image. A predicted label that is out of range counts as wrong for its true class; pixels
    /// whose true label is out of range are skipped.
    pub fn add(&mut self, predicted: &[u8], truth: &[u8]) {
        let classes = self.truth.len();
        // Neighbouring pixels mostly have the same pair of labels: runs are counted at once.
        let mut run: ([u8; 2], u64) = ([0, 0], 0);
        for pair in predicted.iter().zip(truth).map(|(predicted, truth)| [*predicted, *truth]) {
            if pair == run.0 {
                run.1 += 1;
            } else {
                self.add_run(run, classes);
                run = (pair, 1);
            }
        }
        self.add_run(run, classes);
    }

    fn add_run(&mut self, ([predicted, truth], pixels): ([u8; 2], u64), classes: usize) {
        let (predicted, truth) = (usize::from(predicted), usize::from(truth));
        if truth >= classes {
            return;
        }
        self.truth[truth] += pixels;
        if predicted < classes {
            self.predicted[predicted] += pixels;
        }
        if predicted == truth {
            self.common[truth] += pixels;
        }
    }

    /// Adds other counts `times` times.
    pub fn add_times(&mut self, other: &Self, times: u64) {
        for (sum, more) in [
            (&mut self.common, &other.common),
            (&mut self.truth, &other.truth),
            (&mut self.predicted, &other.predicted),
        ] {
            sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += times * more);
        }
    }

    /// Intersection over union of every class; `None` where it occurs in neither truth nor prediction.
    pub fn class_iou(&self) -> Vec<Option<f64>> {
        let counts = self.common.iter().zip(&self.truth).zip(&self.predicted);
        counts
            .map(|((common, truth), predicted)| {
                let union = truth + predicted - common;
                (union > 0).then(|| *common as f64 / union as f64)
            })
            .collect()
    }

    /// Mean of [`Self::class_iou`] over the classes that occur in truth or prediction, over all images at once.
    pub fn mean_iou(&self) -> Option<f64> {
        let scores: Vec<f64> = self.class_iou().into_iter().flatten().collect();
        (!scores.is_empty()).then(|| scores.iter().sum::<f64>() / scores.len() as f64)
    }

    /// Share of pixels with the right label.
    pub fn accuracy(&self) -> Option<f64> {
        let pixels: u64 = self.truth.iter().sum();
        (pixels > 0).then(|| self.common.iter().sum::<u64>() as f64 / pixels as f64)
    }

    /// Numbers of true pixels by class.
    pub fn true_pixels(&self) -> &[u64] {
        &self.truth
    }
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
        assert_eq!(confusion.accuracy(), Some(0.75));
        assert_eq!(Confusion::new(3).mean_iou(), None);
        let mut confusion = Confusion::new(2);
        confusion.add(&[200, 0], &[0, 0]);
        assert_eq!(confusion.class_iou(), [Some(0.5), None], "a label out of range is only a miss");
    }

    #[test]
    fn an_image_counted_twice_is_the_same_as_twice_the_image() {
        let (mut once, mut twice) = (Confusion::new(4), Confusion::new(4));
        once.add(&[0, 0, 3, 1, 200], &[0, 1, 3, 3, 2]);
        twice.add(&[0, 0, 3, 1, 200, 0, 0, 3, 1, 200], &[0, 1, 3, 3, 2, 0, 1, 3, 3, 2]);
        let mut sum = Confusion::new(4);
        sum.add_times(&once, 2);
        assert_eq!(sum, twice);
    }
}
