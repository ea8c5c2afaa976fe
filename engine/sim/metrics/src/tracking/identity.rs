//! IDF1: boxes under the right identity for the whole sequence (Ristani et al., 2016).

use super::assignment::best_pairs;
use super::frame::{MATCH, TrackedFrame};
use std::collections::{BTreeMap, BTreeSet};

/// Counts of sequences.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct IdentityTally {
    /// Boxes of the tracks that are paired.
    pub matched: f64,
    /// True boxes in all.
    pub truth: f64,
    /// Found boxes in all.
    pub found: f64,
}

impl IdentityTally {
    /// Counts of a sequence, for the pairs of true and found tracks with the most boxes in common.
    pub fn of(frames: &[TrackedFrame]) -> Self {
        let mut together: BTreeMap<(u64, u64), f64> = BTreeMap::new();
        let mut sum = Self::default();
        for frame in frames {
            for (truth, row) in frame.truth.iter().zip(&frame.overlaps) {
                for (found, _) in frame.found.iter().zip(row).filter(|(_, overlap)| **overlap >= MATCH) {
                    *together.entry((*truth, *found)).or_default() += 1.0;
                }
            }
            sum.truth += frame.truth.len() as f64;
            sum.found += frame.found.len() as f64;
        }
        // Added to 0: the sum of no numbers is -0.
        let matched =
            groups(&together).iter().map(|(truth, found)| most_in_common(truth, found, &together)).sum::<f64>();
        sum.matched += matched;
        sum
    }

    /// Adds other counts `times` times.
    pub fn add_times(&mut self, other: &Self, times: f64) {
        self.matched += times * other.matched;
        self.truth += times * other.truth;
        self.found += times * other.found;
    }

    /// IDF1.
    pub fn f1(&self) -> f64 {
        self.matched / (0.5 * (self.truth + self.found)).max(1.0)
    }
}

/// True and found tracks that have to do with each other, directly or through others: pairs are within a group.
fn groups(together: &BTreeMap<(u64, u64), f64>) -> Vec<(BTreeSet<u64>, BTreeSet<u64>)> {
    let mut groups: Vec<(BTreeSet<u64>, BTreeSet<u64>)> = vec![];
    let (mut of_truth, mut of_found): (BTreeMap<u64, BTreeSet<u64>>, BTreeMap<u64, BTreeSet<u64>>) = Default::default();
    for (truth, found) in together.keys() {
        of_truth.entry(*truth).or_default().insert(*found);
        of_found.entry(*found).or_default().insert(*truth);
    }
    while let Some((first, _)) = of_truth.first_key_value() {
        let (mut group, mut open) = ((BTreeSet::new(), BTreeSet::new()), vec![*first]);
        while let Some(truth) = open.pop() {
            for found in of_truth.remove(&truth).unwrap_or_default() {
                if group.1.insert(found) {
                    open.extend(of_found.remove(&found).unwrap_or_default());
                }
            }
            group.0.insert(truth);
        }
        groups.push(group);
    }
    groups
}

fn most_in_common(truth: &BTreeSet<u64>, found: &BTreeSet<u64>, together: &BTreeMap<(u64, u64), f64>) -> f64 {
    let boxes = |truth: &u64, found: &u64| together.get(&(*truth, *found)).copied().unwrap_or(0.0);
    let scores: Vec<Vec<f64>> =
        truth.iter().map(|truth| found.iter().map(|found| boxes(truth, found)).collect()).collect();
    best_pairs(&scores).into_iter().map(|(row, column)| scores[row][column]).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(found: [u64; 2], overlap: f64) -> TrackedFrame {
        TrackedFrame { truth: vec![1, 2], found: found.into(), overlaps: vec![vec![overlap, 0.0], vec![0.0, overlap]] }
    }

    #[test]
    fn an_exchange_in_the_middle_costs_half_and_loose_boxes_all() {
        let exchange: Vec<_> = (0..10).map(|at| frame(if at < 5 { [1, 2] } else { [2, 1] }, 0.9)).collect();
        assert_eq!(IdentityTally::of(&exchange).f1(), 0.5);
        let loose: Vec<_> = (0..10).map(|_| frame([1, 2], 0.4)).collect();
        assert!(IdentityTally::of(&loose).f1() == 0.0 && IdentityTally::of(&loose).f1().is_sign_positive());
        // Each is its own group, and both count.
        let right: Vec<_> = (0..10).map(|_| frame([5, 6], 0.5)).collect();
        assert_eq!(IdentityTally::of(&right), IdentityTally { matched: 20.0, truth: 20.0, found: 20.0 });
    }
}
