//! Boxes of the target alone, counted by picture, then by sequence.

use super::sequences::TrackedSequence;
use crate::pictures::kinds::FrameKinds;
use crate::pictures::tallies::{Counted, FrameCounts};
use crate::windows::Flights;
use cosfly_metrics::Metric;
use cosfly_metrics::scores::OF_TARGETS;
use cosfly_metrics::single_target;
use std::collections::BTreeMap;

/// Number of metrics.
const METRICS: usize = OF_TARGETS.len();

/// Sums of scores of pictures, and their number.
type Sum = ([f64; METRICS], u64);

/// Scores of a sequence, by kind.
pub struct TargetScores {
    /// Sum of all pictures, and of those of each kind: kind k is in place k + 1.
    sums: BTreeMap<usize, Sum>,
}

impl TargetScores {
    /// Scores of `found`, a box per picture, where the target is seen. The first picture gives the tracker its box: whatever the file has
    /// there counts as the true one.
    pub fn of(flights: &Flights, kinds: &FrameKinds, sequence: &TrackedSequence, found: &[[f64; 4]]) -> Self {
        let mut sums: BTreeMap<usize, Sum> = BTreeMap::new();
        for ((frame, found), picture) in sequence.frames().zip(found).zip(0..) {
            let Some(edges) = flights.track(sequence.flight).boxes[frame] else { continue };
            let [left, top, right, bottom] = edges.map(f64::from);
            let truth = [left + 1.0, top + 1.0, right - left, bottom - top];
            let scores = single_target::scores(if picture == 0 { &truth } else { found }, &truth);
            let of_frame = kinds.of(flights, sequence.flight, frame);
            for kind in [0].into_iter().chain(of_frame.iter().map(|kind| kind + 1)) {
                let (sum, pictures) = sums.entry(kind).or_default();
                sum.iter_mut().zip(scores).for_each(|(sum, score)| *sum += score);
                *pictures += 1;
            }
        }
        Self { sums }
    }

    /// Pictures that show the target.
    pub fn seen(&self) -> u64 {
        self.sums.get(&0).map_or(0, |(_, pictures)| *pictures)
    }

    /// Scores by the keys of metrics.
    pub fn named(&self) -> BTreeMap<&'static str, f64> {
        let mean = self.sums.get(&0).map_or([0.0; METRICS], mean);
        OF_TARGETS.iter().map(|metric| metric.key).zip(mean).collect()
    }
}

fn mean((sum, pictures): &Sum) -> [f64; METRICS] {
    sum.map(|sum| sum / *pictures as f64)
}

/// Means of sequences: row per kind, column per group.
pub struct TargetTallies {
    sequences: Vec<Vec<Sum>>,
}

impl TargetTallies {
    /// Nothing counted yet.
    pub fn new(kinds: usize, groups: usize) -> Self {
        Self { sequences: vec![vec![Sum::default(); groups]; kinds + 1] }
    }

    /// Counts a sequence, and its pictures in `counts`.
    pub fn add(&mut self, group: usize, scores: &TargetScores, counts: &mut FrameCounts) {
        for (kind, sum) in &scores.sums {
            let (total, sequences) = &mut self.sequences[*kind][group];
            total.iter_mut().zip(mean(sum)).for_each(|(total, mean)| *total += mean);
            *sequences += 1;
            counts.add_many(*kind, group, sum.1);
        }
    }
}

impl Counted for TargetTallies {
    fn metrics(&self) -> &'static [Metric] {
        &OF_TARGETS
    }

    fn means(&self, kind: usize, times: &dyn Fn(usize) -> u64) -> Vec<Option<f64>> {
        let (mut total, mut sequences) = ([0.0; METRICS], 0);
        for (group, (sum, number)) in self.sequences[kind].iter().enumerate() {
            let times = times(group);
            total.iter_mut().zip(sum).for_each(|(total, sum)| *total += times as f64 * sum);
            sequences += times * number;
        }
        total.iter().map(|sum| (sequences > 0).then(|| sum / sequences as f64)).collect()
    }
}
