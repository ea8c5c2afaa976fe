//! Figures of the page over all flights, and sketches of a few. Parts can be merged, so that a page is made
//! from summaries of many files; memory is bounded by the number of towns, not of flights.

use crate::name_hash::hash;
use crate::sample::{Sample, Worst};
use crate::sketch::FlightSketch;
use cosfly_plot::distribution::Distribution;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::{BTreeMap, BTreeSet};

/// Most broken limits that are named.
const NAMED: usize = 5;
/// Number of planning costs of a flight whose stops are known.
const STOPS: usize = 3;

/// Figures over flights, and sketches of some of them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Figures {
    /// Numbers of expert and of perturbed flights.
    pub flights: [u64; 2],
    /// Number of frames.
    pub frames: u64,
    /// Time flown, seconds.
    pub duration_s: f64,
    /// Time between frames, seconds; 0 without flights.
    pub dt_s: f64,
    /// Different walks, by hashes of town and pedestrian.
    pub walks: BTreeSet<u64>,
    /// Flights by split, town and weather.
    pub groups: [BTreeMap<String, Group>; 3],
    /// Mean visibility of each expert flight.
    #[serde(with = "parts")]
    pub visible_by_expert: Distribution,
    /// Distributions over experts and over perturbed flights.
    pub numbers: BTreeMap<DrawnQuantity, [Numbers; 2]>,
    /// Weighted cost of each term over all published flights.
    pub term_costs: BTreeMap<String, f64>,
    /// Number of flights with costs of planning, and of those with the costs of three stops.
    pub planned: [u64; 2],
    /// Limits of experts.
    pub limits: LimitFigures,
    /// Frames of the longest flight.
    pub longest: usize,
    /// Flights that are drawn.
    pub sample: Sample,
    /// The worst flights.
    pub worst: Worst,
}

/// Flights of a split, a town or a weather.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Group {
    /// Numbers of expert and of perturbed flights.
    pub flights: [u64; 2],
    /// Number of frames.
    pub frames: u64,
    /// Sums of the mean visibilities of expert and of perturbed flights.
    pub visible: [f64; 2],
}

/// A quantity whose distribution is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum DrawnQuantity {
    /// Share of the body that is visible, per frame.
    Visible,
    /// Seconds with less than half visible.
    Losses,
    /// Distance to the target's feet, metres, per frame.
    Distance,
    /// Height above the target's feet, metres, per frame.
    Height,
    /// Distance to the nearest obstacle, metres, per frame.
    Clearance,
    /// Speed of the drone, m/s.
    Speed,
    /// Speed of the target, m/s.
    TargetSpeed,
    /// Height of the target's box, pixels, per frame.
    BoxHeight,
}

/// A distribution that a file holds as its parts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Numbers(#[serde(with = "parts")] pub Distribution);

/// How experts keep their limits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LimitFigures {
    /// Number of experts that keep all limits.
    pub sound: u64,
    /// Smallest distance to an obstacle, metres; `None` without frames.
    pub nearest_m: Option<f32>,
    /// Largest speed, m/s.
    pub fastest_mps: f32,
    /// Largest jerk, m/s^3.
    pub jerk_mps3: f64,
    /// The first broken limits, by the numbers of flight and limit.
    pub broken: Vec<(u64, usize, String)>,
}

impl Figures {
    /// Adds a flight; each has a [`FlightSketch::number`] of its own.
    pub fn add(&mut self, flight: FlightSketch) {
        let kind = usize::from(flight.is_perturbed);
        let visible = flight.mean_visible();
        self.flights[kind] += 1;
        self.frames += flight.len() as u64;
        self.duration_s += flight.duration_s();
        self.dt_s = self.dt_s.max(flight.dt_s);
        self.longest = self.longest.max(flight.len());
        self.walks.insert(hash(&[&flight.town, &flight.pedestrian]));
        for (groups, name) in self.groups.iter_mut().zip([&flight.split, &flight.town, &flight.weather]) {
            let group = groups.entry(name.clone()).or_default();
            group.flights[kind] += 1;
            group.frames += flight.len() as u64;
            group.visible[kind] += visible;
        }
        for (name, cost) in &flight.term_costs {
            *self.term_costs.entry(name.clone()).or_default() += cost;
        }
        if flight.is_planned() {
            self.planned[0] += 1;
            self.planned[1] += u64::from(flight.convergence.len() == STOPS);
        }
        for (quantity, values) in quantities(&flight) {
            let numbers = &mut self.numbers.entry(quantity).or_default()[kind].0;
            values.into_iter().for_each(|value| numbers.add(value));
        }
        if !flight.is_perturbed {
            self.visible_by_expert.add(visible as f32);
            self.limits.add(&flight);
        }
        self.worst.add(&flight);
        self.sample.add(flight);
    }

    /// Adds the flights of another part of the dataset.
    pub fn merge(&mut self, other: Self) {
        for kind in 0..2 {
            self.flights[kind] += other.flights[kind];
            self.planned[kind] += other.planned[kind];
        }
        self.frames += other.frames;
        self.duration_s += other.duration_s;
        self.dt_s = self.dt_s.max(other.dt_s);
        self.longest = self.longest.max(other.longest);
        self.walks.extend(other.walks);
        for (groups, others) in self.groups.iter_mut().zip(other.groups) {
            for (name, more) in others {
                groups.entry(name).or_default().merge(&more);
            }
        }
        for (name, cost) in other.term_costs {
            *self.term_costs.entry(name).or_default() += cost;
        }
        for (quantity, more) in &other.numbers {
            let numbers = self.numbers.entry(*quantity).or_default();
            numbers.iter_mut().zip(more).for_each(|(numbers, more)| numbers.0.merge(&more.0));
        }
        self.visible_by_expert.merge(&other.visible_by_expert);
        self.limits.merge(other.limits);
        self.worst.merge(other.worst);
        self.sample.merge(other.sample);
    }

    /// The flights that are drawn, in their order.
    pub fn drawn(&self) -> Vec<&FlightSketch> {
        self.sample.flights()
    }

    /// Number of all flights.
    pub fn all(&self) -> u64 {
        self.flights.iter().sum()
    }

    /// Mean visibility of the expert and of the perturbed flights; `None` where there are none.
    pub fn mean_visible(&self) -> [Option<f64>; 2] {
        let mut all = Group::default();
        for group in self.groups[0].values() {
            all.merge(group);
        }
        all.mean_visible()
    }

    /// Distributions of a quantity over experts and over perturbed flights.
    pub fn numbers(&self, quantity: DrawnQuantity) -> [&Distribution; 2] {
        static NONE: Distribution = Distribution::EMPTY;
        self.numbers.get(&quantity).map_or([&NONE; 2], |numbers| [&numbers[0].0, &numbers[1].0])
    }
}

impl Group {
    fn merge(&mut self, other: &Self) {
        for kind in 0..2 {
            self.flights[kind] += other.flights[kind];
            self.visible[kind] += other.visible[kind];
        }
        self.frames += other.frames;
    }

    /// Mean visibility of the expert and of the perturbed flights; `None` where there are none.
    pub fn mean_visible(&self) -> [Option<f64>; 2] {
        [0, 1].map(|kind| (self.flights[kind] > 0).then(|| self.visible[kind] / self.flights[kind] as f64))
    }
}

impl LimitFigures {
    fn add(&mut self, flight: &FlightSketch) {
        let broken = flight.violations.iter().enumerate();
        self.merge(Self {
            sound: u64::from(flight.holds),
            nearest_m: flight.clearance_m.iter().copied().reduce(f32::min),
            fastest_mps: flight.speeds_mps().into_iter().fold(0.0, f32::max),
            jerk_mps3: flight.max_jerk_mps3,
            broken: broken.map(|(at, text)| (flight.number, at, format!("{}: {text}", flight.id))).collect(),
        });
    }

    fn merge(&mut self, other: Self) {
        self.sound += other.sound;
        self.nearest_m = self.nearest_m.into_iter().chain(other.nearest_m).reduce(f32::min);
        self.fastest_mps = self.fastest_mps.max(other.fastest_mps);
        self.jerk_mps3 = self.jerk_mps3.max(other.jerk_mps3);
        self.broken.extend(other.broken);
        self.broken.sort();
        self.broken.truncate(NAMED);
    }
}

/// Values of all quantities of a flight.
fn quantities(flight: &FlightSketch) -> [(DrawnQuantity, Vec<f32>); 8] {
    let losses = flight.occlusions().into_iter().map(|it| (it.1 as f64 * flight.dt_s) as f32);
    let heights = flight.drone_m.iter().zip(&flight.feet_m).map(|(drone, feet)| drone[2] - feet[2]);
    [
        (DrawnQuantity::Visible, flight.visible.clone()),
        (DrawnQuantity::Losses, losses.collect()),
        (DrawnQuantity::Distance, flight.distances_m()),
        (DrawnQuantity::Height, heights.collect()),
        (DrawnQuantity::Clearance, flight.clearance_m.clone()),
        (DrawnQuantity::Speed, flight.speeds_mps()),
        (DrawnQuantity::TargetSpeed, flight.target_speeds_mps()),
        (DrawnQuantity::BoxHeight, (0..flight.len()).map(|frame| flight.box_height_px(frame)).collect()),
    ]
}

/// Distributions in files.
mod parts {
    use super::{Deserialize, Deserializer, Distribution, Serialize, Serializer};

    pub fn serialize<S: Serializer>(it: &Distribution, serializer: S) -> Result<S::Ok, S::Error> {
        it.to_parts().serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Distribution, D::Error> {
        Deserialize::deserialize(deserializer).map(Distribution::from_parts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flight(number: u64) -> FlightSketch {
        let frames = 3 + number as usize % 5;
        let at = |frame: usize| [frame as f32 * 0.7, number as f32, 12.0];
        FlightSketch {
            number,
            id: format!("f{number:05}"),
            is_perturbed: number % 2 == 1,
            pedestrian: format!("p{}", number / 2),
            town: format!("town{}", number / 2 % 3),
            weather: "ClearNoon".into(),
            split: "train".into(),
            dt_s: 0.5,
            drone_m: (0..frames).map(at).collect(),
            feet_m: (0..frames).map(|frame| [frame as f32, 0.0, 0.0]).collect(),
            visible: (0..frames).map(|frame| ((frame as u64 + number) % 7) as f32 / 6.0).collect(),
            clearance_m: (0..frames).map(|frame| 1.0 + (frame as u64 + number) as f32 / 100.0).collect(),
            holds: !number.is_multiple_of(4),
            violations: if number.is_multiple_of(4) { vec!["speed".into()] } else { vec![] },
            convergence: vec![3.0, 2.0, 1.0],
            term_costs: vec![("jerk".into(), 0.25)],
            ..FlightSketch::default()
        }
    }

    #[test]
    fn parts_merge_to_the_whole_and_memory_does_not_grow_with_flights() {
        let mut whole = Figures::default();
        (0..3000).for_each(|number| whole.add(flight(number)));
        let mut merged = Figures::default();
        for part in 0..10 {
            let mut figures = Figures::default();
            (0..3000).filter(|number| number % 10 == part).for_each(|number| figures.add(flight(number)));
            let text = serde_json::to_string(&figures).expect("numbers and texts always print");
            merged.merge(serde_json::from_str(&text).expect("it was printed"));
        }
        let whole_without_sums = Figures { groups: merged.groups.clone(), ..whole.clone() };
        assert!(whole_without_sums == merged);
        assert_eq!(whole.groups[1]["town1"].flights, merged.groups[1]["town1"].flights);
        assert_eq!((whole.all(), whole.walks.len(), whole.limits.broken.len()), (3000, 1500, 5));
        assert!(whole.drawn().len() <= 3 * 100 + 200, "{}", whole.drawn().len());
        assert!(whole.drawn().windows(2).all(|pair| pair[0].number < pair[1].number));
    }

    #[test]
    fn few_flights_are_all_drawn() {
        let mut figures = Figures::default();
        (0..150).rev().for_each(|number| figures.add(flight(number)));
        assert_eq!(figures.drawn().iter().map(|it| it.number).collect::<Vec<_>>(), (0..150).collect::<Vec<_>>());
    }
}
