//! Shortcuts: signs by which a model may tell the target from others without following it, the middle of the picture and the
//! clothes.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Left, top, right and bottom edge of a box, pixels.
pub type Edges = [f64; 4];

/// Counts over frames and people; [`Self::figures`] are their figures.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Shortcuts {
    frames: u64,
    nearest: u64,
    rank_sum: u64,
    /// Frames with others, and over them the sums of the shares of others who are farther from the middle, and who are less
    /// high, in millionths: whole numbers, so that the order of merging does not matter.
    accompanied: u64,
    farther_sum: u64,
    lower_sum: u64,
    targets: BTreeMap<String, [f64; 3]>,
    others: BTreeMap<String, [f64; 3]>,
}

/// Figures of a dataset.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ShortcutFigures {
    /// Expert frames in which the target is seen.
    pub frames: u64,
    /// Share of them in which nobody else who is seen is nearer to the middle of the picture; null without frames.
    pub target_nearest_the_centre: Option<f64>,
    /// Mean number of people who are nearer to the middle of the picture than the target.
    pub mean_people_nearer: Option<f64>,
    /// Probability that a random other person in the frame is farther from its middle: 0.5 where the place tells nothing; null
    /// without others.
    pub place_auc: Option<f64>,
    /// Probability that a random other person in the frame is less high in pixels, equal ones counted half.
    pub height_auc: Option<f64>,
    /// Number of different targets.
    pub targets: usize,
    /// Number of different bystanders who are seen.
    pub others: usize,
    /// Probability that the top of a random target is more colourful than that of a random bystander: 0.5 where colour
    /// tells nothing; null without both.
    pub clothes_auc_colourfulness: Option<f64>,
    /// The same of brightness.
    pub clothes_auc_brightness: Option<f64>,
    /// Standard error of both where colour tells nothing: few targets leave much to chance.
    pub clothes_auc_standard_error: Option<f64>,
}

impl Shortcuts {
    /// Adds an expert's frame of `image_px` pixels with the visible boxes of target and others.
    pub fn add_frame(&mut self, image_px: [f64; 2], target: Edges, others: impl Iterator<Item = Edges>) {
        let own = [from_middle(image_px, target), height_px(target)];
        let (mut count, mut nearer, mut above) = (0_u64, 0_u64, [0.0; 2]);
        for edges in others {
            let other = [from_middle(image_px, edges), height_px(edges)];
            count += 1;
            nearer += u64::from(other[0] < own[0]);
            above[0] += share_above(other[0], own[0]);
            above[1] += share_above(own[1], other[1]);
        }
        self.frames += 1;
        self.nearest += u64::from(nearer == 0);
        self.rank_sum += nearer;
        if count > 0 {
            self.accompanied += 1;
            let millionths = |sum: f64| (1e6 * sum / count as f64).round() as u64;
            self.farther_sum += millionths(above[0]);
            self.lower_sum += millionths(above[1]);
        }
    }

    /// Adds somebody who is followed, with the colour of the top, linear RGB.
    pub fn add_target(&mut self, id: &str, top: [f64; 3]) {
        self.targets.insert(id.to_owned(), top);
    }

    /// Adds a bystander who is seen.
    pub fn add_other(&mut self, id: &str, top: [f64; 3]) {
        self.others.insert(id.to_owned(), top);
    }

    /// Adds the counts of other frames and people.
    pub fn merge(&mut self, other: Self) {
        self.frames += other.frames;
        self.nearest += other.nearest;
        self.rank_sum += other.rank_sum;
        self.accompanied += other.accompanied;
        self.farther_sum += other.farther_sum;
        self.lower_sum += other.lower_sum;
        self.targets.extend(other.targets);
        self.others.extend(other.others);
    }

    /// The figures.
    pub fn figures(&self) -> ShortcutFigures {
        let per_frame = |sum: u64| (self.frames > 0).then(|| sum as f64 / self.frames as f64);
        let per_pair = |sum: u64| (self.accompanied > 0).then(|| 1e-6 * sum as f64 / self.accompanied as f64);
        let of = |people: &BTreeMap<String, [f64; 3]>, feature: fn(&[f64; 3]) -> f64| -> Vec<f64> {
            people.values().map(feature).collect()
        };
        let auc_of = |feature| auc(&of(&self.targets, feature), &of(&self.others, feature));
        let (targets, others) = (self.targets.len() as f64, self.others.len() as f64);
        let error = ((targets + others + 1.0) / (12.0 * targets * others)).sqrt();
        ShortcutFigures {
            frames: self.frames,
            target_nearest_the_centre: per_frame(self.nearest),
            mean_people_nearer: per_frame(self.rank_sum),
            place_auc: per_pair(self.farther_sum),
            height_auc: per_pair(self.lower_sum),
            targets: self.targets.len(),
            others: self.others.len(),
            clothes_auc_colourfulness: auc_of(colourfulness),
            clothes_auc_brightness: auc_of(brightness),
            clothes_auc_standard_error: Some(error).filter(|error| error.is_finite()),
        }
    }
}

fn from_middle([width, height]: [f64; 2], [left, top, right, bottom]: Edges) -> f64 {
    let (across, down) = (0.5 * (left + right - width), 0.5 * (top + bottom - height));
    across * across + down * down
}

fn height_px([_, top, _, bottom]: Edges) -> f64 {
    bottom - top
}

/// 1 where the first is above the second, a half where both are equal.
fn share_above(first: f64, second: f64) -> f64 {
    f64::from(u8::from(first > second)) + 0.5 * f64::from(u8::from(first == second))
}

fn colourfulness(rgb: &[f64; 3]) -> f64 {
    rgb.iter().copied().fold(f64::MIN, f64::max) - rgb.iter().copied().fold(f64::MAX, f64::min)
}

fn brightness([red, green, blue]: &[f64; 3]) -> f64 {
    0.2126 * red + 0.7152 * green + 0.0722 * blue
}

/// Probability that a random value of `positives` is above one of `negatives`, equal ones counted half (Mann-Whitney);
/// `None` where one of the lists is empty.
pub fn auc(positives: &[f64], negatives: &[f64]) -> Option<f64> {
    let pairs = positives.len() as f64 * negatives.len() as f64;
    let mut sorted = negatives.to_vec();
    sorted.sort_by(f64::total_cmp);
    let wins = |value: &f64| {
        let below = sorted.partition_point(|other| other < value);
        let up_to = sorted.partition_point(|other| other <= value);
        0.5 * (below + up_to) as f64
    };
    (pairs > 0.0).then(|| positives.iter().map(wins).sum::<f64>() / pairs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_area_is_the_share_of_pairs_in_order() {
        assert_eq!(auc(&[3.0, 1.0], &[2.0, 0.0]), Some(0.75));
        assert_eq!(auc(&[1.0, 1.0], &[1.0]), Some(0.5));
        assert_eq!(auc(&[], &[1.0]), None);
    }

    #[test]
    fn people_nearer_to_the_middle_are_counted() {
        let mut shortcuts = Shortcuts::default();
        let at = |x: f64| [x - 1.0, 49.0, x + 1.0, 51.0];
        shortcuts.add_frame([100.0, 100.0], at(50.0), [at(10.0), at(70.0)].into_iter());
        shortcuts.add_frame([100.0, 100.0], at(30.0), [at(45.0), at(60.0), at(99.0)].into_iter());
        shortcuts.add_target("p1", [0.9, 0.1, 0.1]);
        shortcuts.add_other("p2", [0.2, 0.2, 0.2]);
        shortcuts.add_other("p2", [0.2, 0.2, 0.2]);
        let figures = shortcuts.figures();
        let place = figures.place_auc.expect("others");
        assert!((place - 0.5 * (1.0 + 1.0 / 3.0)).abs() < 1e-6, "{place}");
        assert_eq!(figures.height_auc, Some(0.5));
        assert_eq!((figures.target_nearest_the_centre, figures.mean_people_nearer), (Some(0.5), Some(1.0)));
        assert_eq!((figures.targets, figures.others, figures.clothes_auc_colourfulness), (1, 1, Some(1.0)));
        assert_eq!(Shortcuts::default().figures().clothes_auc_standard_error, None);
    }
}
