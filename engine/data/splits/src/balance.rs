//! Shares asked for and shares reached, with the reasons for differences.

use super::facts::FlightFacts;
use cosfly_diagnose::{Diagnostic, Fault, counted};
use cosfly_schema::Split;
use cosfly_schema::config::{SplitBy, SplitShares};
use std::collections::{BTreeMap, BTreeSet};

/// A group with more than this share of all walks is said to chain.
const LARGE_GROUP: f64 = 0.25;
/// Fewer walks say nothing about shares.
const ENOUGH_WALKS: usize = 20;
/// Differences within this many standard deviations of draws of single walks are chance.
const CHANCE: f64 = 3.0;
/// Differences of shares below this are never reported.
const SMALL_DIFFERENCE: f64 = 0.02;

/// Shares of a dataset's splits.
#[derive(Clone, Debug, PartialEq)]
pub struct Balance {
    /// Shares asked for: train, val, test.
    pub asked: [f64; 3],
    /// Shares of flights reached: train, val, test.
    pub reached: [f64; 3],
    /// Number of flights.
    pub flights: usize,
    /// Number of walks: pedestrians of a place.
    pub walks: usize,
    /// Number of groups that stay together.
    pub groups: usize,
    /// Largest group, and its share of the walks.
    pub largest: (String, f64),
    /// Flights left out because no area holds their walk.
    pub left_out: usize,
    by: SplitBy,
    /// Flights in towns that the recipe gives a split.
    named: usize,
}

impl Balance {
    /// Counts the flights, whose splits and groups are known; `left_out` others were left out.
    pub fn of(facts: &[FlightFacts], shares: &SplitShares, left_out: usize) -> Self {
        let flights = facts.len();
        let in_split = |split: Split| facts.iter().filter(|it| it.split == split.name()).count();
        let walks: BTreeSet<(&str, &str, &str)> =
            facts.iter().map(|it| (group(it), it.layout.digest.as_str(), it.pedestrian_id.as_str())).collect();
        let mut groups: BTreeMap<&str, usize> = BTreeMap::new();
        walks.iter().for_each(|walk| *groups.entry(walk.0).or_default() += 1);
        // The first of the largest.
        let largest = groups.iter().rev().max_by_key(|(_, count)| **count);
        let share = |count: usize, of: usize| count as f64 / of.max(1) as f64;
        Self {
            asked: shares.asked(),
            reached: Split::ALL.map(|split| share(in_split(split), flights)),
            flights,
            walks: walks.len(),
            groups: groups.len(),
            largest: largest
                .map_or_else(Default::default, |(name, count)| ((*name).to_owned(), share(*count, walks.len()))),
            left_out,
            by: shares.by,
            named: facts.iter().filter(|it| shares.towns.contains_key(&it.town)).count(),
        }
    }

    /// Warnings for a user before training, one sentence each: walks that chain, shares that were missed by more than
    /// chance and why, flights left out.
    pub fn warnings(&self) -> Vec<String> {
        let mut said = vec![];
        let is_chained = self.by == SplitBy::Pedestrian && self.largest.1 > LARGE_GROUP && self.walks >= ENOUGH_WALKS;
        if is_chained {
            said.push(format!(
                "walks overlap so much that {} of {} walks are one group, `{}`, and go to one split; split by area \
                 (`splits.by = \"area\"`), by town, or raise `splits.max_route_overlap`",
                percent(self.largest.1),
                self.walks,
                self.largest.0
            ));
        }
        if self.left_out > 0 {
            said.push(format!(
                "{} of {} flights were left out: their walks enter the guard bands between areas; table `rejected` names \
                 them",
                self.left_out,
                self.left_out + self.flights
            ));
        }
        for (at, split) in Split::ALL.into_iter().enumerate() {
            let (asked, reached) = (self.asked[at], self.reached[at]);
            let difference = (asked - reached).abs();
            let chance = CHANCE * (asked * (1.0 - asked) / self.walks.max(1) as f64).sqrt();
            let is_missed = self.walks >= ENOUGH_WALKS && difference > chance.max(SMALL_DIFFERENCE);
            let is_empty = reached == 0.0 && asked * self.walks as f64 >= 5.0;
            if is_missed || is_empty {
                let (name, reason) = (split.name(), self.reason());
                said.push(format!(
                    "split `{name}` has {} of the flights, not {}: {reason}",
                    percent(reached),
                    percent(asked)
                ));
            }
        }
        said
    }

    /// Why shares are missed.
    fn reason(&self) -> String {
        let largest =
            format!("the largest of {} has {} of the walks", counted(self.groups, "group"), percent(self.largest.1));
        match self.by {
            _ if 2 * self.named > self.flights => {
                format!("`splits.towns` names the split of {} of {}", self.named, counted(self.flights, "flight"))
            }
            SplitBy::Area => "no lines with guard bands give these shares for the walks of all towns".to_owned(),
            SplitBy::Town => format!("whole towns are drawn; {largest}"),
            SplitBy::Kind => format!("all towns of a kind go together; {largest}"),
            SplitBy::Pedestrian => format!("whole groups are drawn; {largest}"),
        }
    }

    /// Shares asked for and reached, in one line.
    pub fn told(&self) -> String {
        let of = |at: usize| {
            format!("{} of {} in `{}`", percent(self.reached[at]), percent(self.asked[at]), Split::ALL[at].name())
        };
        let (groups, walks) = (counted(self.groups, "group"), counted(self.walks, "walk"));
        format!("shares reached: {}, {}, {}; {groups} of {walks}", of(0), of(1), of(2))
    }

    /// Refuses to publish where a share is missed by more than `splits.max_share_error`.
    pub fn refusal(&self, shares: &SplitShares) -> Option<Box<Diagnostic>> {
        let at = (0..3).find(|at| (self.asked[*at] - self.reached[*at]).abs() > shares.max_share_error)?;
        let message = format!(
            "split `{}` has {} of the flights, not {}; `splits.max_share_error` allows a difference of {}",
            Split::ALL[at].name(),
            percent(self.reached[at]),
            percent(self.asked[at]),
            percent(shares.max_share_error)
        );
        let refusal = Diagnostic::new("dataset-shares", Fault::Recipe, message).because(self.reason());
        Some(refusal.hint(
            "split by area (`splits.by = \"area\"`) or by town, raise `splits.max_route_overlap`, or raise \
             `splits.max_share_error`",
        ))
    }
}

/// Name of the group of a flight; datasets from before groups were stored have the pedestrian only.
fn group(it: &FlightFacts) -> &str {
    if it.group.is_empty() { &it.pedestrian_id } else { &it.group }
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assign::assign;
    use crate::facts::fixture::behind;
    use cosfly_frames::DVec3;

    fn walks(count: usize, street_m: f64, step_m: f64) -> Vec<FlightFacts> {
        let walk = |id: usize| {
            let from = DVec3::new(step_m * id as f64, street_m * id as f64, 0.0);
            let feet: Vec<DVec3> = (0..60).map(|k| from + DVec3::X * f64::from(k)).collect();
            behind(id, &feet)
        };
        (0..count).map(walk).collect()
    }

    fn balance(facts: &[FlightFacts], shares: &SplitShares) -> Balance {
        let assignment = assign(facts, shares);
        let mut facts = facts.to_vec();
        for ((it, split), group) in facts.iter_mut().zip(assignment.splits).zip(assignment.groups) {
            (it.split, it.group) = (split.name().to_owned(), group);
        }
        Balance::of(&facts, shares, 0)
    }

    #[test]
    fn walks_apart_are_nothing_to_report() {
        let found = balance(&walks(300, 40.0, 0.0), &SplitShares::default());
        assert_eq!((found.walks, found.groups, found.warnings()), (300, 300, vec![]));
        assert!(found.refusal(&SplitShares::default()).is_none());
    }

    #[test]
    fn walks_that_chain_and_the_shares_that_they_miss_are_told_with_figures() {
        // One street: each walk repeats half of the next one and more.
        let facts = walks(300, 0.0, 20.0);
        let found = balance(&facts, &SplitShares::default());
        let said = found.warnings().join("\n");
        assert!(said.contains("100.0 % of 300 walks are one group") && said.contains("not 80.0 %"), "{said}");
        let strict = SplitShares { max_share_error: 0.05, ..SplitShares::default() };
        let refused = found.refusal(&strict).expect("the shares are missed");
        assert_eq!(refused.code, "dataset-shares");
        let by_area = SplitShares { by: SplitBy::Area, ..SplitShares::default() };
        let found = balance(&facts, &by_area);
        assert!(found.refusal(&strict).is_none(), "{found:?}");
    }
}
