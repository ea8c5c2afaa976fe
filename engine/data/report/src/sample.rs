//! Flights that are drawn: a sample by the hashes of their ids, and the worst ones. Both depend on the flights alone, not on
//! their order or on how parts were merged, and few more flights change few of them.

use crate::name_hash::hash;
use crate::sketch::FlightSketch;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// Flights of each of the first towns.
const OF_TOWN: usize = 100;
/// Towns, in the order of their names, that have flights of their own in the sample.
pub const TOWNS: usize = 20;
/// Flights of all towns together.
const OF_ALL: usize = 200;

/// A sample of flights; files hold the flights alone.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(from = "Vec<FlightSketch>", into = "Vec<FlightSketch>")]
pub struct Sample {
    flights: BTreeMap<u64, FlightSketch>,
    /// Flights after the last cut: cuts are seldom.
    cut_to: usize,
}

impl PartialEq for Sample {
    fn eq(&self, other: &Self) -> bool {
        self.flights() == other.flights()
    }
}

impl From<Vec<FlightSketch>> for Sample {
    fn from(flights: Vec<FlightSketch>) -> Self {
        let flights: BTreeMap<u64, FlightSketch> = flights.into_iter().map(|it| (it.number, it)).collect();
        Self { cut_to: flights.len(), flights }
    }
}

impl From<Sample> for Vec<FlightSketch> {
    fn from(mut sample: Sample) -> Self {
        sample.cut();
        sample.flights.into_values().collect()
    }
}

impl Sample {
    /// Adds a flight.
    pub fn add(&mut self, flight: FlightSketch) {
        self.flights.insert(flight.number, flight);
        if self.flights.len() > 2 * self.cut_to.max(OF_ALL) {
            self.cut();
        }
    }

    /// Adds the flights of another sample.
    pub fn merge(&mut self, other: Self) {
        self.flights.extend(other.flights);
        self.cut();
    }

    /// The flights in their order.
    pub fn flights(&self) -> Vec<&FlightSketch> {
        let kept = self.kept();
        self.flights.values().filter(|it| kept.contains(&it.number)).collect()
    }

    fn cut(&mut self) {
        let kept = self.kept();
        self.flights.retain(|number, _| kept.contains(number));
        self.cut_to = self.flights.len();
    }

    /// Numbers of the flights that belong to the sample: those with the smallest hashes.
    fn kept(&self) -> BTreeSet<u64> {
        let mut of_town: BTreeMap<&str, Vec<(u64, u64)>> = BTreeMap::new();
        let mut of_all: Vec<(u64, u64)> = vec![];
        for flight in self.flights.values() {
            let key = (hash(&[&flight.id]), flight.number);
            of_town.entry(&flight.town).or_default().push(key);
            of_all.push(key);
        }
        let mut kept = BTreeSet::new();
        let limits = of_town.into_values().take(TOWNS).map(|keys| (keys, OF_TOWN));
        for (mut keys, limit) in limits.chain([(of_all, OF_ALL)]) {
            keys.sort_unstable();
            kept.extend(keys.into_iter().take(limit).map(|(_, number)| number));
        }
        kept
    }
}

/// The worst flights of each property, by a rank: the smaller, the worse.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// Least visible experts.
    pub hidden_experts: Ranked,
    /// Least visible perturbed flight.
    pub hidden_perturbed: Ranked,
    /// Expert nearest to an obstacle.
    pub nearest: Ranked,
    /// Expert with the largest jerk.
    pub roughest: Ranked,
}

/// Experts that are named for their visibility.
pub const HIDDEN: usize = 3;

/// Flights with their ranks, in ascending order.
pub type Ranked = Vec<(u64, FlightSketch)>;

impl Worst {
    /// Adds a flight.
    pub fn add(&mut self, flight: &FlightSketch) {
        let nearest_m = flight.clearance_m.iter().copied().fold(f32::INFINITY, f32::min);
        let visible = flight.mean_visible();
        let one = |value: f64| vec![(rank(value), flight.clone())];
        self.merge(if flight.is_perturbed {
            Self { hidden_perturbed: one(visible), ..Self::default() }
        } else {
            Self {
                hidden_experts: one(visible),
                nearest: one(f64::from(nearest_m)),
                roughest: one(-flight.max_jerk_mps3),
                ..Self::default()
            }
        });
    }

    /// Adds the flights of another part.
    pub fn merge(&mut self, other: Self) {
        for (own, more, limit) in [
            (&mut self.hidden_experts, other.hidden_experts, HIDDEN),
            (&mut self.hidden_perturbed, other.hidden_perturbed, 1),
            (&mut self.nearest, other.nearest, 1),
            (&mut self.roughest, other.roughest, 1),
        ] {
            own.extend(more);
            own.sort_by_key(|(rank, flight)| (*rank, flight.number));
            own.truncate(limit);
        }
    }
}

/// Rank of a number among all: in the order of `total_cmp`.
fn rank(value: f64) -> u64 {
    let bits = value.to_bits();
    if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
}
