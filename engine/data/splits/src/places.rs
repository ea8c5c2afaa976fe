//! Places of flights: towns by their ground plans, whatever their names.

use super::disjoint_sets::DisjointSets;
use super::facts::FlightFacts;
use cosfly_schema::Split;
use cosfly_schema::TownLayout;
use cosfly_schema::config::{SplitBy, SplitShares};
use std::collections::{BTreeMap, BTreeSet};

/// A place with flights, under one or several names.
pub struct FlightPlace {
    /// Start of the digest of its ground plan, the smallest where copies of it differ.
    pub name: String,
    /// Whether all flights of the place go to one split.
    pub is_whole: bool,
    /// Split that the recipe gives the place.
    pub split: Option<Split>,
}

/// All places, and the place of each flight.
pub struct Places {
    /// Places, of which some have no flights.
    pub all: Vec<FlightPlace>,
    /// Number of the place of each flight.
    pub of_flight: Vec<usize>,
}

impl Places {
    /// Places of the flights.
    pub fn of(facts: &[FlightFacts], shares: &SplitShares) -> Self {
        let layouts: BTreeMap<&str, &TownLayout> =
            facts.iter().map(|it| (it.layout.digest.as_str(), &*it.layout)).collect();
        let layouts: Vec<&TownLayout> = layouts.into_values().collect();
        let mut same = DisjointSets::new(layouts.len());
        for (at, layout) in layouts.iter().enumerate() {
            for other in (0..at).filter(|other| layouts[*other].is_same_place(layout)) {
                same.join(at, other);
            }
        }
        let layout_of = |it: &FlightFacts| layouts.partition_point(|known| known.digest < it.layout.digest);
        let of_flight: Vec<usize> = facts.iter().map(|it| same.smallest(layout_of(it))).collect();
        let mut towns: Vec<BTreeSet<&str>> = vec![BTreeSet::new(); layouts.len()];
        for (it, place) in facts.iter().zip(&of_flight) {
            towns[*place].insert(&it.town);
        }
        let place = |(layout, towns): (&&TownLayout, &BTreeSet<&str>)| FlightPlace {
            name: layout.short().to_owned(),
            is_whole: shares.by == SplitBy::Town || towns.len() > 1,
            split: towns.iter().find_map(|town| shares.towns.get(*town).copied()),
        };
        Self { all: layouts.iter().zip(&towns).map(place).collect(), of_flight }
    }
}
