//! HOTA: detection and association together (Luiten et al., "HOTA", 2020).

use super::assignment::best_pairs;
use super::frame::TrackedFrame;
use std::collections::BTreeMap;

/// Number of overlaps that HOTA is a mean over: 0.05, 0.1 ... 0.95.
pub const OVERLAPS: usize = 19;

/// Counts of sequences at each overlap.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HotaTally {
    /// Matched boxes.
    pub matched: [f64; OVERLAPS],
    /// Sum over matched boxes of the Jaccard index of their two tracks.
    pub associated: [f64; OVERLAPS],
    /// True boxes without a match.
    pub missed: [f64; OVERLAPS],
    /// Found boxes without a match.
    pub extra: [f64; OVERLAPS],
}

/// HOTA and its two parts, means over the overlaps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hota {
    /// Mean of the geometric means of detection and association.
    pub hota: f64,
    /// Detection accuracy.
    pub detection: f64,
    /// Association accuracy.
    pub association: f64,
}

fn overlap(place: usize) -> f64 {
    0.05 + place as f64 * 0.05
}

impl HotaTally {
    /// Counts of a sequence.
    pub fn of(frames: &[TrackedFrame]) -> Self {
        let tracks = Tracks::of(frames);
        let mut matches: BTreeMap<(u64, u64), [f64; OVERLAPS]> = BTreeMap::new();
        let mut sum = Self::default();
        for frame in frames {
            let aligned = |(truth, row): (&u64, &Vec<f64>)| -> Vec<f64> {
                row.iter()
                    .zip(&frame.found)
                    .map(|(overlap, found)| overlap * tracks.alignment(*truth, *found))
                    .collect()
            };
            let scores: Vec<Vec<f64>> = frame.truth.iter().zip(&frame.overlaps).map(aligned).collect();
            let pairs = best_pairs(&scores);
            for place in 0..OVERLAPS {
                let least = overlap(place) - f64::EPSILON;
                let mut matched = 0.0;
                for (row, column) in pairs.iter().filter(|(row, column)| frame.overlaps[*row][*column] >= least) {
                    matched += 1.0;
                    matches.entry((frame.truth[*row], frame.found[*column])).or_default()[place] += 1.0;
                }
                sum.matched[place] += matched;
                sum.missed[place] += frame.truth.len() as f64 - matched;
                sum.extra[place] += frame.found.len() as f64 - matched;
            }
        }
        for ((truth, found), matched) in matches {
            let boxes = tracks.boxes(truth, found);
            for (sum, matched) in sum.associated.iter_mut().zip(matched) {
                *sum += matched * matched / (boxes - matched).max(1.0);
            }
        }
        sum
    }

    /// Adds other counts `times` times.
    pub fn add_times(&mut self, other: &Self, times: f64) {
        let add = |sum: &mut [f64; OVERLAPS], more: &[f64; OVERLAPS]| {
            sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += times * more);
        };
        add(&mut self.matched, &other.matched);
        add(&mut self.associated, &other.associated);
        add(&mut self.missed, &other.missed);
        add(&mut self.extra, &other.extra);
    }

    /// The scores.
    pub fn scores(&self) -> Hota {
        let detection = |place: usize| {
            let matched = self.matched[place];
            matched / (matched + self.missed[place] + self.extra[place]).max(1.0)
        };
        let association = |place: usize| self.associated[place] / self.matched[place].max(1.0);
        let mean = |of: &dyn Fn(usize) -> f64| (0..OVERLAPS).map(of).sum::<f64>() / OVERLAPS as f64;
        Hota {
            hota: mean(&|place| (detection(place) * association(place)).sqrt()),
            detection: mean(&detection),
            association: mean(&association),
        }
    }
}

/// Boxes of each track of a sequence, and how far true and found tracks run together.
#[derive(Default)]
struct Tracks {
    truth: BTreeMap<u64, f64>,
    found: BTreeMap<u64, f64>,
    together: BTreeMap<(u64, u64), f64>,
}

impl Tracks {
    fn of(frames: &[TrackedFrame]) -> Self {
        let mut tracks = Self::default();
        for frame in frames {
            let mut of_found = vec![0.0; frame.found.len()];
            frame.overlaps.iter().for_each(|row| of_found.iter_mut().zip(row).for_each(|(sum, more)| *sum += more));
            for (truth, row) in frame.truth.iter().zip(&frame.overlaps) {
                let of_truth: f64 = row.iter().sum();
                for ((found, overlap), of_found) in frame.found.iter().zip(row).zip(&of_found) {
                    let all = of_found + of_truth - overlap;
                    if *overlap > 0.0 && all > f64::EPSILON {
                        *tracks.together.entry((*truth, *found)).or_default() += overlap / all;
                    }
                }
            }
            frame.truth.iter().for_each(|id| *tracks.truth.entry(*id).or_default() += 1.0);
            frame.found.iter().for_each(|id| *tracks.found.entry(*id).or_default() += 1.0);
        }
        tracks
    }

    /// Boxes of a true and a found track.
    fn boxes(&self, truth: u64, found: u64) -> f64 {
        self.truth[&truth] + self.found[&found]
    }

    /// Jaccard index of two tracks before any match, by overlaps.
    fn alignment(&self, truth: u64, found: u64) -> f64 {
        self.together.get(&(truth, found)).map_or(0.0, |shared| shared / (self.boxes(truth, found) - shared))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A body that is found in every one of `frames` pictures, by tracks of the ids that `id` gives.
    fn followed(frames: u64, id: impl Fn(u64) -> u64) -> HotaTally {
        let frame = |at| TrackedFrame { truth: vec![1], found: vec![id(at)], overlaps: vec![vec![1.0]] };
        HotaTally::of(&(0..frames).map(frame).collect::<Vec<_>>())
    }

    #[test]
    fn a_true_track_scores_one_and_half_a_track_half_the_association() {
        assert_eq!(followed(10, |_| 5).scores(), Hota { hota: 1.0, detection: 1.0, association: 1.0 });
        let halves = followed(10, |at| at / 5).scores();
        assert!((halves.association - 0.5).abs() < 1e-12 && halves.detection == 1.0);
        assert!((halves.hota - 0.5_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn nothing_found_scores_nothing() {
        let frame = TrackedFrame { truth: vec![1, 2], found: vec![], overlaps: vec![vec![], vec![]] };
        let tally = HotaTally::of(&[frame]);
        assert_eq!((tally.missed[0], tally.scores().hota), (2.0, 0.0));
    }
}
