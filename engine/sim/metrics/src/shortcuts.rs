//! Shortcuts: signs by which a model may tell the target from others without following it: its place and size in the picture,
//! and its looks.

use cosfly_frames::real;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Left, top, right and bottom edge of a box, pixels.
pub type BoxEdges = [f64; 4];

/// Others who are compared with a target of the same size in the picture: at its distance, up to this share of it, ...
const SAME_DISTANCE: f64 = 0.1;
/// ... as far from the middle of the picture, up to this share of the picture's height, ...
const SAME_PLACE: f64 = 0.1;
/// ... and, like the target, seen from feet to head, up to this share of the height at each end.
const HIDDEN: f64 = 0.1;

/// Twice the standard error above which a figure cannot tell a shortcut from chance.
const WIDE: f64 = 0.05;

/// Somebody in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Around the visible pixels.
    pub edges_px: BoxEdges,
    /// Rows of the picture in which crown and feet are, hidden or not; `None` for who has no such place in the picture.
    pub crown_and_feet_px: Option<[f64; 2]>,
    /// Distance from the camera to the feet, metres.
    pub distance_m: f64,
    /// Body height, metres.
    pub height_m: f64,
}

/// Looks of a person that can be seen wherever they are in a picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Looks {
    /// Colour of the top, linear RGB.
    pub top: [f64; 3],
    /// Body height, metres.
    pub height_m: f64,
    /// Whether the person carries a bag.
    pub bag: bool,
    /// Build and steps: 0 slim or short, 1 medium, 2 stout or long.
    pub build_and_steps: [u8; 2],
}

/// Counts over frames and people; [`Self::figures`] are their figures.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Shortcuts {
    frames: u64,
    nearest: u64,
    rank_sum: u64,
    farther: Shares,
    lower: Shares,
    smaller_in_the_same_place: Shares,
    targets: BTreeMap<String, Looks>,
    others: BTreeMap<String, Looks>,
}

/// A share that every frame with others has, between 0 and 1, summed over flights. Whole numbers, so that the order of merging
/// does not matter: shares are counted in thousandths of a flight's sum.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Shares {
    flights: u64,
    frames: u64,
    sum: u64,
    /// Sums over flights of products: sum x sum, sum x frames, frames x frames.
    products: [u64; 3],
}

/// The area under the curve of one sign: 0.5 where it tells nothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Probe {
    /// Mean over the frames of the share of others who have less of the sign than the target.
    pub auc: f64,
    /// Standard error over flights, whose frames resemble each other; null for a single flight.
    pub standard_error: Option<f64>,
    /// Number of flights and frames with others to compare with.
    pub flights: u64,
    /// Frames.
    pub frames: u64,
}

/// Probabilities that a random target has more of a property than a random bystander.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LooksProbe {
    /// Colourfulness of the top.
    pub colourfulness: f64,
    /// Brightness of the top.
    pub brightness: f64,
    /// Body height in metres.
    pub height: f64,
    /// A bag.
    pub bag: f64,
    /// Build, from slim to stout.
    pub build: f64,
    /// Steps, from short to long.
    pub steps: f64,
    /// Standard error of all where they tell nothing: few targets leave much to chance.
    pub standard_error: f64,
}

/// Figures of a dataset.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ShortcutFigures {
    /// Expert frames in which the target is seen.
    pub frames: u64,
    /// Share of them in which nobody else who is seen is nearer to the middle of the picture; null without frames.
    pub target_nearest_the_centre: Option<f64>,
    /// Mean number of others who are nearer to the middle of the picture than the target.
    pub mean_people_nearer: Option<f64>,
    /// Nearness to the middle of the picture, against others in the frame; null without others.
    pub place: Option<Probe>,
    /// Height in pixels, against others in the frame.
    pub height: Option<Probe>,
    /// Height in the picture against people who are as far away and as far from the middle, both seen from feet to head.
    pub height_in_the_same_place: Option<Probe>,
    /// Number of different people who are followed.
    pub targets: usize,
    /// Number of different bystanders on foot who are seen.
    pub others: usize,
    /// Looks of people who are followed, against those of bystanders; null without both.
    pub looks: Option<LooksProbe>,
}

impl Shortcuts {
    /// Adds an expert's flight: of each frame in which the target is seen, the target and the others of its kind, in pictures of
    /// `image_px` pixels.
    pub fn add_flight(&mut self, image_px: [f64; 2], frames: impl Iterator<Item = (Seen, Vec<Seen>)>) {
        let [mut farther, mut lower, mut smaller] = [(0_u64, 0.0); 3];
        let count = |sum: &mut (u64, f64), share: Option<f64>| {
            if let Some(share) = share {
                *sum = (sum.0 + 1, sum.1 + share);
            }
        };
        for (target, others) in frames {
            let from_middle = |it: &Seen| from_middle_px(image_px, it.edges_px);
            let nearer = others.iter().filter(|other| from_middle(other) < from_middle(&target)).count() as u64;
            self.frames += 1;
            self.nearest += u64::from(nearer == 0);
            self.rank_sum += nearer;
            count(&mut farther, mean(others.iter().map(|it| share_above(from_middle(it), from_middle(&target)))));
            count(&mut lower, mean(others.iter().map(|it| share_above(height_px(&target), height_px(it)))));
            let own = read_height_m(&target);
            let alike = others.iter().filter(|other| are_in_the_same_place(image_px, &target, other));
            let heights = alike.filter_map(|other| Some(share_above(own?, read_height_m(other)?)));
            count(&mut smaller, mean(heights));
        }
        self.farther.add(farther);
        self.lower.add(lower);
        self.smaller_in_the_same_place.add(smaller);
    }

    /// Adds a person who is followed.
    pub fn add_target(&mut self, id: &str, looks: Looks) {
        self.targets.insert(id.to_owned(), looks);
    }

    /// Adds a bystander who is seen.
    pub fn add_other(&mut self, id: &str, looks: Looks) {
        self.others.insert(id.to_owned(), looks);
    }

    /// Adds the counts of other flights and people.
    pub fn merge(&mut self, other: Self) {
        self.frames += other.frames;
        self.nearest += other.nearest;
        self.rank_sum += other.rank_sum;
        self.farther.merge(other.farther);
        self.lower.merge(other.lower);
        self.smaller_in_the_same_place.merge(other.smaller_in_the_same_place);
        self.targets.extend(other.targets);
        self.others.extend(other.others);
    }

    /// The figures.
    pub fn figures(&self) -> ShortcutFigures {
        let per_frame = |sum: u64| (self.frames > 0).then(|| sum as f64 / self.frames as f64);
        ShortcutFigures {
            frames: self.frames,
            target_nearest_the_centre: per_frame(self.nearest),
            mean_people_nearer: per_frame(self.rank_sum),
            place: self.farther.probe(),
            height: self.lower.probe(),
            height_in_the_same_place: self.smaller_in_the_same_place.probe(),
            targets: self.targets.len(),
            others: self.others.len(),
            looks: self.looks(),
        }
    }

    fn looks(&self) -> Option<LooksProbe> {
        let of = |people: &BTreeMap<String, Looks>, sign: fn(&Looks) -> f64| -> Vec<f64> {
            people.values().map(sign).collect()
        };
        let auc_of = |sign| auc(&of(&self.targets, sign), &of(&self.others, sign));
        let (targets, others) = (self.targets.len() as f64, self.others.len() as f64);
        Some(LooksProbe {
            colourfulness: auc_of(|it| colourfulness(&it.top))?,
            brightness: auc_of(|it| brightness(&it.top))?,
            height: auc_of(|it| it.height_m)?,
            bag: auc_of(|it| f64::from(u8::from(it.bag)))?,
            build: auc_of(|it| f64::from(it.build_and_steps[0]))?,
            steps: auc_of(|it| f64::from(it.build_and_steps[1]))?,
            standard_error: ((targets + others + 1.0) / (12.0 * targets * others)).sqrt(),
        })
    }
}

impl Looks {
    /// Looks from the words of the tables.
    pub fn of_words(top: [f64; 3], height_m: f64, [bag, build, steps]: [&str; 3]) -> Self {
        let place = |word: &str, words: [&str; 2]| match word {
            word if word == words[0] => 0,
            word if word == words[1] => 2,
            _ => 1,
        };
        let build_and_steps = [place(build, ["slim", "stout"]), place(steps, ["short", "long"])];
        Self { top, height_m, bag: bag != "none", build_and_steps }
    }
}

impl ShortcutFigures {
    /// Whether a figure with this standard error tells a shortcut of 0.05 from chance.
    pub fn is_telling(standard_error: f64) -> bool {
        2.0 * standard_error <= WIDE
    }
}

impl Shares {
    /// Adds a flight: frames, and the sum of their shares.
    fn add(&mut self, (frames, sum): (u64, f64)) {
        let sum = (1e3 * sum).round() as u64;
        let one = Self { flights: 1, frames, sum, products: [sum * sum, sum * frames, frames * frames] };
        self.merge(if frames > 0 { one } else { Self::default() });
    }

    fn merge(&mut self, other: Self) {
        self.flights += other.flights;
        self.frames += other.frames;
        self.sum += other.sum;
        (0..3).for_each(|at| self.products[at] += other.products[at]);
    }

    /// The mean over frames, with the error of a mean over flights of different lengths.
    fn probe(&self) -> Option<Probe> {
        let frames = self.frames as f64;
        let auc = 1e-3 * self.sum as f64 / frames;
        let [sums, sums_frames, squared_frames] = self.products.map(|product| product as f64);
        let squares = (1e-6 * sums - 2e-3 * auc * sums_frames + auc * auc * squared_frames).max(0.0);
        let flights = self.flights as f64;
        let error = || (squares * flights / (flights - 1.0)).sqrt() / frames;
        let standard_error = (self.flights > 1).then(error);
        (self.frames > 0).then_some(Probe { auc, standard_error, flights: self.flights, frames: self.frames })
    }
}

/// Whether somebody is as far from the camera as the target and as far from the middle of the picture, and both are seen from
/// feet to head.
fn are_in_the_same_place(image_px: [f64; 2], target: &Seen, other: &Seen) -> bool {
    let apart_px = from_middle_px(image_px, target.edges_px) - from_middle_px(image_px, other.edges_px);
    let ratio = other.distance_m / target.distance_m;
    real::ln(ratio).abs() <= real::ln(1.0 + SAME_DISTANCE) && apart_px.abs() <= SAME_PLACE * image_px[1]
}

/// Height of a body as its box in the picture says, metres; `None` where feet or head are hidden.
fn read_height_m(seen: &Seen) -> Option<f64> {
    let [crown, feet] = seen.crown_and_feet_px?;
    let most = HIDDEN * (feet - crown);
    let is_whole = seen.edges_px[1] <= crown + most && seen.edges_px[3] >= feet - most;
    (is_whole && feet > crown).then(|| seen.height_m * height_px(seen) / (feet - crown))
}

fn from_middle_px([width, height]: [f64; 2], [left, top, right, bottom]: BoxEdges) -> f64 {
    let (across, down) = (0.5 * (left + right - width), 0.5 * (top + bottom - height));
    (across * across + down * down).sqrt()
}

fn height_px(seen: &Seen) -> f64 {
    seen.edges_px[3] - seen.edges_px[1]
}

/// The mean; `None` of nothing.
fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (count, sum) = values.fold((0_u32, 0.0), |(count, sum), value| (count + 1, sum + value));
    (count > 0).then(|| sum / f64::from(count))
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

    /// Somebody whose whole body is seen, 20 pixels high, in the middle of the picture's height.
    fn at(x: f64) -> Seen {
        Seen {
            edges_px: [x - 1.0, 40.0, x + 1.0, 60.0],
            crown_and_feet_px: Some([40.0, 60.0]),
            distance_m: 20.0,
            height_m: 1.7,
        }
    }

    fn looks(top: [f64; 3]) -> Looks {
        Looks::of_words(top, 1.7, ["none", "stout", "short"])
    }

    #[test]
    fn people_nearer_to_the_middle_are_counted() {
        let mut shortcuts = Shortcuts::default();
        let frames = [(at(50.0), vec![at(10.0), at(70.0)]), (at(30.0), vec![at(45.0), at(60.0), at(99.0)])];
        shortcuts.add_flight([100.0, 100.0], frames.into_iter());
        shortcuts.add_target("p1", looks([0.9, 0.1, 0.1]));
        shortcuts.add_other("p2", looks([0.2, 0.2, 0.2]));
        shortcuts.add_other("p2", looks([0.2, 0.2, 0.2]));
        let figures = shortcuts.figures();
        let place = figures.place.expect("others");
        assert!((place.auc - 0.5 * (1.0 + 1.0 / 3.0)).abs() < 1e-3, "{place:?}");
        assert_eq!((place.standard_error, place.flights, place.frames), (None, 1, 2));
        assert_eq!(figures.height.map(|it| it.auc), Some(0.5));
        assert_eq!((figures.target_nearest_the_centre, figures.mean_people_nearer), (Some(0.5), Some(1.0)));
        let found = figures.looks.expect("both");
        assert_eq!((figures.targets, figures.others, found.colourfulness), (1, 1, 1.0));
        assert_eq!((found.height, found.build, found.bag), (0.5, 0.5, 0.5));
        assert_eq!(Shortcuts::default().figures().looks, None);
    }

    #[test]
    fn only_whole_people_in_the_same_place_are_compared_by_size() {
        let compared = |other: Seen| {
            let mut shortcuts = Shortcuts::default();
            shortcuts.add_flight([100.0, 100.0], [(at(30.0), vec![other])].into_iter());
            shortcuts.figures().height_in_the_same_place.map(|it| it.auc)
        };
        let small = Seen { crown_and_feet_px: Some([40.0, 61.0]), height_m: 1.6, ..at(70.0) };
        assert_eq!((compared(at(70.0)), compared(small)), (Some(0.5), Some(1.0)));
        assert_eq!(compared(Seen { distance_m: 23.0, ..at(70.0) }), None, "farther away");
        assert_eq!(compared(at(85.0)), None, "farther from the middle");
        assert_eq!(compared(Seen { crown_and_feet_px: Some([40.0, 65.0]), ..at(70.0) }), None, "feet are hidden");
        assert_eq!(compared(Seen { crown_and_feet_px: None, ..at(70.0) }), None);
    }

    #[test]
    fn the_error_is_that_of_a_mean_over_flights_in_any_order() {
        // Shares 1, 1, 0 of flights with one frame each: mean 2/3, and the error of three draws.
        let flight = |target: f64, other: f64| {
            let mut shortcuts = Shortcuts::default();
            shortcuts.add_flight([100.0, 100.0], [(at(target), vec![at(other)])].into_iter());
            shortcuts
        };
        let of = |order: [usize; 3]| {
            let flights = [flight(50.0, 20.0), flight(60.0, 5.0), flight(10.0, 50.0)];
            let mut all = Shortcuts::default();
            order.iter().for_each(|at| all.merge(flights[*at].clone()));
            all
        };
        let place = of([0, 1, 2]).figures().place.expect("others");
        let error = (2.0_f64 / 9.0 / 2.0).sqrt();
        assert!((place.auc - 2.0 / 3.0).abs() < 1e-3 && (place.standard_error.unwrap() - error).abs() < 1e-3);
        assert_eq!(of([0, 1, 2]), of([2, 0, 1]));
        assert!(ShortcutFigures::is_telling(0.02) && !ShortcutFigures::is_telling(0.1));
    }
}
