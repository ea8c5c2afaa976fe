//! True and found boxes of a picture.

use super::assignment::best_pairs;

/// Boxes of a picture: whose they are, and how much they overlap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TrackedFrame {
    /// True id of each true box.
    pub truth: Vec<u64>,
    /// Tracker's id of each found box.
    pub found: Vec<u64>,
    /// Intersection over union: a row per true box, a column per found box.
    pub overlaps: Vec<Vec<f64>>,
}

/// Overlap that makes a match, for all but HOTA.
pub const MATCH: f64 = 0.5;

impl TrackedFrame {
    /// The frame for scoring: found boxes that match a distractor best are taken away, and true boxes that are not `counted`.
    ///
    /// `is_distractor` and `counted` have an entry per true box.
    #[must_use]
    pub fn scored(self, is_distractor: &[bool], counted: &[bool]) -> Self {
        let above = |overlap: &f64| if *overlap < MATCH - f64::EPSILON { 0.0 } else { *overlap };
        let scores: Vec<Vec<f64>> = self.overlaps.iter().map(|row| row.iter().map(above).collect()).collect();
        let mut kept = vec![true; self.found.len()];
        for (row, column) in best_pairs(&scores) {
            kept[column] = scores[row][column] <= f64::EPSILON || !is_distractor[row];
        }
        let of_found = |row: Vec<f64>| chosen(row, &kept);
        let overlaps = chosen(self.overlaps, counted).into_iter().map(of_found).collect();
        Self { truth: chosen(self.truth, counted), found: chosen(self.found, &kept), overlaps }
    }
}

fn chosen<T>(values: Vec<T>, kept: &[bool]) -> Vec<T> {
    values.into_iter().zip(kept).filter(|(_, kept)| **kept).map(|(value, _)| value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_follows_a_distractor_counts_neither_for_nor_against() {
        let frame = TrackedFrame {
            truth: vec![1, 2, 3],
            found: vec![7, 8],
            overlaps: vec![vec![0.9, 0.0], vec![0.0, 0.6], vec![0.0, 0.0]],
        };
        let scored = frame.scored(&[false, true, false], &[true, false, false]);
        assert_eq!(scored, TrackedFrame { truth: vec![1], found: vec![7], overlaps: vec![vec![0.9]] });
    }
}
