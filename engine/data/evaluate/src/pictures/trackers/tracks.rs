//! Tracks of many bodies, counted by class.

use super::lines::FoundBox;
use super::sequences::TrackedSequence;
use crate::pictures::report::ClassReport;
use crate::pictures::tallies::Counted;
use crate::windows::Flights;
use cosfly_diagnose::Result;
use cosfly_domain::TARGET_INSTANCE;
use cosfly_metrics::scores::OF_TRACKS;
use cosfly_metrics::tracking::{TrackTally, TrackedFrame};
use cosfly_metrics::{Metric, boxes};
use cosfly_read::{PublishedDataset, SightingReader};
use cosfly_schema::mot_class::{COUNTED, DISTRACTOR, mot_class};
use cosfly_schema::tables::Edges;
use std::collections::BTreeMap;

/// A true box.
pub struct TrueBox {
    id: u32,
    class: u8,
    edges: [f64; 4],
}

/// True boxes by picture.
///
/// # Errors
/// Damage of the dataset.
pub fn truth(
    dataset: &PublishedDataset,
    flights: &Flights,
    bodies: &mut SightingReader,
    sequence: &TrackedSequence,
) -> Result<Vec<Vec<TrueBox>>> {
    // As in exports, the top-left pixel is (1, 1).
    let edges = |edges: Edges| edges.map(|edge| f64::from(edge) + 1.0);
    let target = mot_class(flights.rows[sequence.flight].target_kind.as_deref().unwrap_or_default());
    let of_target = |frame: usize| flights.track(sequence.flight).boxes[frame];
    let mut found: Vec<Vec<TrueBox>> = sequence
        .frames()
        .map(|frame| of_target(frame).map(|it| TrueBox { id: TARGET_INSTANCE, class: target, edges: edges(it) }))
        .map(|target| target.into_iter().collect())
        .collect();
    for body in bodies.at(dataset, sequence.flight)? {
        if let Some(picture) = sequence.picture(body.frame as usize) {
            let (id, class) = (body.instance, mot_class(&body.kind));
            found[picture].push(TrueBox { id, class, edges: edges(body.visible_box_px) });
        }
    }
    Ok(found)
}

/// Counts of a sequence in each of the classes that count. Boxes without a class are of pedestrians.
pub fn tallies(truth: &[Vec<TrueBox>], found: &[Vec<FoundBox>]) -> [TrackTally; COUNTED.len()] {
    COUNTED.map(|(class, _)| {
        let of_class = |found: &&FoundBox| found.class.unwrap_or(COUNTED[0].0) == class;
        let frame = |(truth, found): (&Vec<TrueBox>, &Vec<FoundBox>)| {
            let found: Vec<&FoundBox> = found.iter().filter(of_class).collect();
            let overlaps =
                |body: &TrueBox| found.iter().map(|found| boxes::iou(&body.edges, &found.edges)).collect::<Vec<_>>();
            let frame = TrackedFrame {
                truth: truth.iter().map(|body| u64::from(body.id)).collect(),
                found: found.iter().map(|found| found.id).collect(),
                overlaps: truth.iter().map(overlaps).collect(),
            };
            let [is_distractor, counted] =
                [DISTRACTOR, class].map(|class| truth.iter().map(|body| body.class == class).collect::<Vec<_>>());
            frame.scored(&is_distractor, &counted)
        };
        TrackTally::of(&truth.iter().zip(found).map(frame).collect::<Vec<_>>())
    })
}

/// Scores by the keys of metrics; `None` without true boxes.
pub fn named(tally: &TrackTally) -> Option<BTreeMap<&'static str, f64>> {
    Some(OF_TRACKS.iter().map(|metric| metric.key).zip(tally.scores()?).collect())
}

/// Everything that is counted: row per kind, column per class, then what there is of groups.
pub struct TrackTallies {
    counted: Vec<Vec<BTreeMap<usize, TrackTally>>>,
    /// Number of classes that are scored, from the first on.
    pub classes: usize,
}

impl TrackTallies {
    /// Nothing counted yet.
    pub fn new(kinds: usize) -> Self {
        Self { counted: vec![vec![BTreeMap::new(); COUNTED.len()]; kinds + 1], classes: 1 }
    }

    /// Counts a sequence of kinds and a group.
    pub fn add(&mut self, kinds: &[usize], group: usize, sequence: &[TrackTally; COUNTED.len()]) {
        for kind in [0].into_iter().chain(kinds.iter().map(|kind| kind + 1)) {
            let classes = self.counted[kind].iter_mut().zip(sequence);
            for (class, tally) in classes.filter(|(_, tally)| **tally != TrackTally::default()) {
                class.entry(group).or_default().add_times(tally, 1.0);
            }
        }
    }

    fn total(&self, kind: usize, class: usize, times: &dyn Fn(usize) -> u64) -> TrackTally {
        let mut total = TrackTally::default();
        for (group, tally) in self.counted[kind][class].iter().filter(|(group, _)| times(**group) > 0) {
            total.add_times(tally, times(*group) as f64);
        }
        total
    }

    /// True boxes of classes that are not scored.
    pub fn passed_over(&self) -> u64 {
        (self.classes..COUNTED.len()).map(|class| self.total(0, class, &|_| 1).identity.truth as u64).sum()
    }

    /// Every class that is scored and has true boxes.
    pub fn classes(&self) -> Vec<ClassReport> {
        let report = |(place, (id, name)): (usize, &(u8, &'static str))| {
            let total = self.total(0, place, &|_| 1);
            Some(ClassReport { id: *id, name, truth: total.identity.truth as u64, scores: named(&total)? })
        };
        COUNTED.iter().enumerate().take(self.classes).filter_map(report).collect()
    }
}

impl Counted for TrackTallies {
    fn metrics(&self) -> &'static [Metric] {
        &OF_TRACKS
    }

    fn means(&self, kind: usize, times: &dyn Fn(usize) -> u64) -> Vec<Option<f64>> {
        let scores: Vec<[f64; OF_TRACKS.len()]> =
            (0..self.classes).filter_map(|class| self.total(kind, class, times).scores()).collect();
        let mean = |metric: usize| scores.iter().map(|it| it[metric]).sum::<f64>() / scores.len() as f64;
        (0..OF_TRACKS.len()).map(|metric| (!scores.is_empty()).then(|| mean(metric))).collect()
    }
}
