//! MOTA: misses, false boxes and changes of identity (Bernardin and Stiefelhagen, "CLEAR MOT", 2008).

use super::assignment::best_pairs;
use super::frame::{MATCH, TrackedFrame};
use std::collections::BTreeMap;

/// Counts of sequences.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ClearTally {
    /// Matched boxes.
    pub matched: f64,
    /// True boxes without a match.
    pub missed: f64,
    /// Found boxes without a match.
    pub extra: f64,
    /// Matches with another track than the last one of the body.
    pub switches: f64,
}

/// Score of a pair that goes on, so that it outweighs every sum of overlaps.
const GOES_ON: f64 = 1000.0;

impl ClearTally {
    /// Counts of a sequence.
    pub fn of(frames: &[TrackedFrame]) -> Self {
        let mut sum = Self::default();
        // Tracks of bodies: the last one of each, and those of the last picture that had true and found boxes.
        let (mut last, mut before): (BTreeMap<u64, u64>, BTreeMap<u64, u64>) = Default::default();
        for frame in frames {
            let matches = matches(frame, &before);
            sum.matched += matches.len() as f64;
            sum.missed += (frame.truth.len() - matches.len()) as f64;
            sum.extra += (frame.found.len() - matches.len()) as f64;
            if frame.truth.is_empty() || frame.found.is_empty() {
                continue;
            }
            for (truth, found) in &matches {
                let previous = last.insert(*truth, *found);
                sum.switches += f64::from(u8::from(previous.is_some_and(|previous| previous != *found)));
            }
            before = matches;
        }
        sum
    }

    /// Adds other counts `times` times.
    pub fn add_times(&mut self, other: &Self, times: f64) {
        self.matched += times * other.matched;
        self.missed += times * other.missed;
        self.extra += times * other.extra;
        self.switches += times * other.switches;
    }

    /// MOTA: below 0 for more false boxes than matches.
    pub fn accuracy(&self) -> f64 {
        (self.matched - self.extra - self.switches) / (self.matched + self.missed).max(1.0)
    }
}

/// True and found ids of a picture that match; tracks that go on come first, larger overlaps second.
fn matches(frame: &TrackedFrame, before: &BTreeMap<u64, u64>) -> BTreeMap<u64, u64> {
    let score = |truth: &u64, found: &u64, overlap: &f64| match () {
        () if *overlap < MATCH - f64::EPSILON => 0.0,
        () if before.get(truth) == Some(found) => GOES_ON + overlap,
        () => *overlap,
    };
    let of_row = |(truth, row): (&u64, &Vec<f64>)| -> Vec<f64> {
        frame.found.iter().zip(row).map(|(found, overlap)| score(truth, found, overlap)).collect()
    };
    let scores: Vec<Vec<f64>> = frame.truth.iter().zip(&frame.overlaps).map(of_row).collect();
    let pairs = best_pairs(&scores).into_iter().filter(|(row, column)| scores[*row][*column] > f64::EPSILON);
    pairs.map(|(row, column)| (frame.truth[row], frame.found[column])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_track_goes_on_though_another_overlaps_more_and_a_change_costs_one() {
        let frame = |found: &[u64], overlaps: &[f64]| TrackedFrame {
            truth: vec![1],
            found: found.into(),
            overlaps: vec![overlaps.into()],
        };
        let frames = [frame(&[7], &[0.9]), frame(&[7, 8], &[0.6, 0.9]), frame(&[], &[]), frame(&[8], &[0.9])];
        let found = ClearTally::of(&frames);
        assert_eq!(found, ClearTally { matched: 3.0, missed: 1.0, extra: 1.0, switches: 1.0 });
        assert_eq!(found.accuracy(), 0.25);
    }
}
