//! Detected boxes and masks: what is true in a frame, how detections overlap it, and the count of that.

use super::report::ClassReport;
use super::tallies::Counted;
use super::things::things;
use cosfly_domain::SemanticLabel;
use cosfly_metrics::detection::{ImageDetections, Ranked, Ranking};
use cosfly_metrics::scores::OF_DETECTIONS;
use cosfly_metrics::{Metric, boxes};
use cosfly_read::LoggedFrame;
use cosfly_read::predictions::detections::Detection;
use cosfly_read::predictions::run_lengths::Runs;

/// Detections and objects of one class in one frame.
pub struct FrameDetections {
    /// CARLA's label.
    pub category: u8,
    found: Vec<Ranked>,
    objects: u64,
    overlaps: f64,
}

/// Compares the detections of a frame with what is there, class by class of `categories`. Detections are of these.
pub fn compare(
    logged: &LoggedFrame,
    detections: &[&Detection],
    categories: &[u8],
    group: usize,
) -> Vec<FrameDetections> {
    let truth = things(&logged.instance, &logged.semantic, [logged.width, logged.height]);
    let of_category = |category: u8| {
        let objects: Vec<&Runs> =
            truth.iter().filter(|((_, label), _)| *label == category).map(|(_, runs)| runs).collect();
        let edges: Vec<[f64; 4]> = objects.iter().map(|runs| runs.edges(logged.height).map(f64::from)).collect();
        let own: Vec<&Detection> = detections.iter().copied().filter(|it| it.category == i64::from(category)).collect();
        let overlaps = |detection: &&Detection| match (&detection.mask, &detection.edges) {
            (Some(mask), _) => objects.iter().map(|runs| mask.runs.iou(runs)).collect(),
            (None, Some(found)) => edges.iter().map(|truth| boxes::iou(found, truth)).collect(),
            (None, None) => vec![0.0; objects.len()],
        };
        let image = ImageDetections {
            scores: own.iter().map(|detection| detection.score).collect(),
            overlaps: own.iter().map(overlaps).collect(),
            objects: objects.len(),
        };
        FrameDetections {
            category,
            found: image.ranked(group as u32),
            objects: objects.len() as u64,
            overlaps: image.best_overlaps(),
        }
    };
    categories.iter().copied().map(of_category).filter(|it| it.objects > 0 || !it.found.is_empty()).collect()
}

/// Counts of one class, by kind.
#[derive(Clone, Default)]
struct OfClass {
    found: Vec<Ranked>,
    /// Objects and sum of their best overlaps, by group.
    objects: Vec<(u64, f64)>,
}

/// Everything that is counted while frames are read: row per kind, column per class.
pub struct DetectionTallies {
    counted: Vec<Vec<OfClass>>,
}

impl DetectionTallies {
    /// Nothing counted yet.
    pub fn new(kinds: usize, groups: usize) -> Self {
        let empty = OfClass { found: vec![], objects: vec![(0, 0.0); groups] };
        Self { counted: vec![vec![empty; SemanticLabel::ALL.len()]; kinds + 1] }
    }

    /// Counts a frame.
    pub fn add(&mut self, kinds: &[usize], group: usize, frame: &[FrameDetections]) {
        for kind in [0].into_iter().chain(kinds.iter().map(|kind| kind + 1)) {
            for class in frame {
                let sum = &mut self.counted[kind][usize::from(class.category)];
                sum.found.extend_from_slice(&class.found);
                let (objects, overlaps) = sum.objects[group];
                sum.objects[group] = (objects + class.objects, overlaps + class.overlaps);
            }
        }
    }

    /// Ranks everything.
    pub fn ranked(self) -> RankedDetections {
        let ranked = |class: OfClass| {
            let objects = class.objects.iter().map(|(objects, _)| *objects).collect();
            (Ranking::new(class.found, objects), class.objects)
        };
        let kinds = self.counted.into_iter().map(|classes| classes.into_iter().map(ranked).collect());
        RankedDetections { kinds: kinds.collect() }
    }
}

/// A class's ranking, and by group its objects and the sum of their overlaps.
type RankedClass = (Ranking, Vec<(u64, f64)>);

/// Counts of all classes: row per kind, column per class.
pub struct RankedDetections {
    kinds: Vec<Vec<RankedClass>>,
}

impl RankedDetections {
    /// AP50, AP75, AP and mean overlap of a class; `None` without objects.
    fn class(&self, kind: usize, class: usize, times: &dyn Fn(usize) -> u64) -> Option<[f64; 4]> {
        let (ranking, objects) = &self.kinds[kind][class];
        let precision = ranking.precision(times)?;
        let (mut count, mut sum) = (0, 0.0);
        for (group, (objects, overlaps)) in objects.iter().enumerate() {
            let times = times(group);
            count += times * objects;
            sum += times as f64 * overlaps;
        }
        Some([precision.ap50, precision.ap75, precision.ap, sum / count.max(1) as f64])
    }

    /// Every class that is there.
    pub fn classes(&self) -> Vec<ClassReport> {
        let report = |(place, label): (usize, &SemanticLabel)| {
            let scores = self.class(0, place, &|_| 1)?;
            let truth = self.kinds[0][place].1.iter().map(|(objects, _)| objects).sum();
            let named = OF_DETECTIONS.iter().map(|metric| metric.key).zip(scores).collect();
            Some(ClassReport { id: label.id(), name: label.name(), truth, scores: named })
        };
        SemanticLabel::ALL.iter().enumerate().filter_map(report).collect()
    }
}

impl Counted for RankedDetections {
    fn metrics(&self) -> &'static [Metric] {
        &OF_DETECTIONS
    }

    fn means(&self, kind: usize, times: &dyn Fn(usize) -> u64) -> Vec<Option<f64>> {
        let scores: Vec<[f64; 4]> =
            (0..self.kinds[kind].len()).filter_map(|class| self.class(kind, class, times)).collect();
        let mean = |metric: usize| scores.iter().map(|it| it[metric]).sum::<f64>() / scores.len() as f64;
        (0..4).map(|metric| (!scores.is_empty()).then(|| mean(metric))).collect()
    }
}
