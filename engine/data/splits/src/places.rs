//! Places of flights: towns by their ground plans, whatever their names.

use super::facts::FlightFacts;
use cosfly_disjoint_sets::DisjointSets;
use cosfly_schema::Split;
use cosfly_schema::TownLayout;
use cosfly_schema::config::{SplitBy, SplitShares};
use std::collections::{BTreeMap, BTreeSet};

/// A place with flights, under one or several names; all towns of a kind where the kind goes to one split.
pub struct FlightPlace {
    /// Start of the digest of its ground plan, the smallest where copies of it differ; the kind where that goes to one split.
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
        if shares.by == SplitBy::Kind {
            join_kinds(facts, &layouts, &mut same);
        }
        let layout_of = |it: &FlightFacts| layouts.partition_point(|known| known.digest < it.layout.digest);
        let of_flight: Vec<usize> = facts.iter().map(|it| same.smallest(layout_of(it))).collect();
        let mut towns: Vec<BTreeSet<&str>> = vec![BTreeSet::new(); layouts.len()];
        for (it, place) in facts.iter().zip(&of_flight) {
            towns[*place].insert(&it.town);
        }
        let place = |(layout, towns): (&&TownLayout, &BTreeSet<&str>)| FlightPlace {
            name: match towns.first() {
                Some(town) if shares.by == SplitBy::Kind => kind_of(town).to_owned(),
                _ => layout.short().to_owned(),
            },
            is_whole: matches!(shares.by, SplitBy::Town | SplitBy::Kind) || towns.len() > 1,
            split: towns.iter().find_map(|town| shares.towns.get(*town).copied()),
        };
        Self { all: layouts.iter().zip(&towns).map(place).collect(), of_flight }
    }
}

/// Towns of one kind are one place.
fn join_kinds(facts: &[FlightFacts], layouts: &[&TownLayout], same: &mut DisjointSets) {
    let mut first: BTreeMap<&str, usize> = BTreeMap::new();
    for it in facts {
        let layout = layouts.partition_point(|known| known.digest < it.layout.digest);
        same.join(*first.entry(kind_of(&it.town)).or_insert(layout), layout);
    }
}

/// Kind of a town: its name without the number at its end.
pub(crate) fn kind_of(town: &str) -> &str {
    let kind = town.trim_end_matches(|letter: char| letter.is_ascii_digit()).trim_end_matches(['_', '-', '.', ' ']);
    if kind.is_empty() { town } else { kind }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_names_without_the_number_at_their_end() {
        for (town, kind) in [("village_1", "village"), ("old_town", "old_town"), ("Town03", "Town"), ("12", "12")] {
            assert_eq!(kind_of(town), kind);
        }
    }
}
