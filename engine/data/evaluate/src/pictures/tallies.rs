//! Counts of frames, by kind of frame and group of flights, and their scores with intervals.

use super::report::KindReport;
use crate::report::score::{Score, Scores};
use cosfly_metrics::{Metric, bootstrap};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Something that was counted by kind (0 is all frames, k + 1 the kind in place k) and group.
pub trait Counted: Sync {
    /// The metrics of [`Self::means`].
    fn metrics(&self) -> &'static [Metric];
    /// Means of the metrics over the frames of a kind, when group k counts `times(k)` times.
    fn means(&self, kind: usize, times: &dyn Fn(usize) -> u64) -> Vec<Option<f64>>;
}

/// Frames by kind and group.
pub struct FrameCounts {
    /// Row per kind, column per group.
    counts: Vec<Vec<u64>>,
}

impl FrameCounts {
    /// Nothing counted yet, for `kinds` kinds beside all frames.
    pub fn new(kinds: usize, groups: usize) -> Self {
        Self { counts: vec![vec![0; groups]; kinds + 1] }
    }

    /// Counts a frame.
    pub fn add(&mut self, kinds: &[usize], group: usize) {
        self.counts[0][group] += 1;
        kinds.iter().for_each(|kind| self.counts[kind + 1][group] += 1);
    }

    /// Counts frames of a kind, 0 for all.
    pub fn add_many(&mut self, kind: usize, group: usize, frames: u64) {
        self.counts[kind][group] += frames;
    }

    /// Frames of a kind, and the groups that have some.
    fn of(&self, kind: usize) -> (u64, Vec<usize>) {
        let groups = self.counts[kind].iter().enumerate().filter(|(_, frames)| **frames > 0);
        (self.counts[kind].iter().sum(), groups.map(|(group, _)| group).collect())
    }
}

/// Scores of all frames, and those of every kind that has frames.
pub fn reports(
    counted: &dyn Counted,
    counts: &FrameCounts,
    names: &[(&'static str, String)],
    resamples: usize,
    seed: u64,
) -> (Scores, BTreeMap<&'static str, BTreeMap<String, KindReport>>) {
    let mut all: Vec<KindReport> = (0..=names.len())
        .into_par_iter()
        .map(|kind| {
            let (frames, groups) = counts.of(kind);
            let scores = scores(counted, kind, &groups, resamples, seed);
            KindReport { frames: frames as usize, clusters: groups.len(), scores }
        })
        .collect();
    let overall = all.remove(0).scores;
    let mut kinds: BTreeMap<_, BTreeMap<_, _>> = BTreeMap::new();
    for ((kind, name), report) in names.iter().zip(all).filter(|(_, report)| report.frames > 0) {
        kinds.entry(*kind).or_default().insert(name.clone(), report);
    }
    (overall, kinds)
}

fn scores(counted: &dyn Counted, kind: usize, groups: &[usize], resamples: usize, seed: u64) -> Scores {
    let means = counted.means(kind, &|_| 1);
    let drawn = groups.len().min(bootstrap::MOST_CLUSTERS);
    // Group -> which of the drawn ones it goes with; more than are drawn are put together.
    let last = groups.last().map_or(0, |last| last + 1);
    let mut place = vec![usize::MAX; last];
    groups.iter().enumerate().for_each(|(number, group)| place[*group] = number % drawn.max(1));
    let intervals = bootstrap::resampled(drawn, resamples, seed, means.len(), &mut |times| {
        counted.means(kind, &|group| {
            let drawn = place.get(group).and_then(|place| times.get(*place));
            drawn.map_or(0, |times| u64::from(*times))
        })
    });
    let named = counted.metrics().iter().zip(means.into_iter().zip(intervals));
    named
        .filter_map(|(metric, (mean, interval))| {
            let score = Score { value: mean?, low: interval.map(|it| it.0), high: interval.map(|it| it.1) };
            Some((metric.key, score))
        })
        .collect()
}
