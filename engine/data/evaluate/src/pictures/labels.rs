//! Labels, counted.

use super::report::ClassReport;
use super::tallies::Counted;
use cosfly_domain::SemanticLabel;
use cosfly_metrics::Metric;
use cosfly_metrics::scores::OF_LABELS;
use cosfly_metrics::segmentation::Confusion;

/// Pixels of classes by kind and group; kinds and groups without frames take no room.
pub struct LabelTallies {
    pixels: Vec<Vec<Option<Confusion>>>,
}

impl LabelTallies {
    /// Nothing counted yet.
    pub fn new(kinds: usize, groups: usize) -> Self {
        Self { pixels: vec![vec![None; groups]; kinds + 1] }
    }

    /// Counts an image.
    pub fn add(&mut self, kinds: &[usize], group: usize, image: &Confusion) {
        for kind in [0].into_iter().chain(kinds.iter().map(|kind| kind + 1)) {
            self.pixels[kind][group].get_or_insert_with(nothing).add_times(image, 1);
        }
    }

    fn total(&self, kind: usize, times: &dyn Fn(usize) -> u64) -> Confusion {
        let mut total = nothing();
        for (group, pixels) in self.pixels[kind].iter().enumerate() {
            match (pixels, times(group)) {
                (None, _) | (_, 0) => {}
                (Some(pixels), times) => total.add_times(pixels, times),
            }
        }
        total
    }

    /// Every class that occurs.
    pub fn classes(&self) -> Vec<ClassReport> {
        let total = self.total(0, &|_| 1);
        let classes = SemanticLabel::ALL.iter().zip(total.class_iou()).zip(total.true_pixels());
        classes
            .filter_map(|((label, iou), pixels)| {
                Some(ClassReport { id: label.id(), name: label.name(), truth: *pixels, scores: [("iou", iou?)].into() })
            })
            .collect()
    }
}

/// An empty count of CARLA's labels.
pub fn nothing() -> Confusion {
    Confusion::new(SemanticLabel::ALL.len())
}

impl Counted for LabelTallies {
    fn metrics(&self) -> &'static [Metric] {
        &OF_LABELS
    }

    fn means(&self, kind: usize, times: &dyn Fn(usize) -> u64) -> Vec<Option<f64>> {
        let total = self.total(kind, times);
        vec![total.mean_iou(), total.accuracy()]
    }
}
