//! [`Board`]: entries by what they flew, ranked within what was verified.

use super::alike::alike;
use super::entry::{Entry, Proof};
use crate::compare::{MetricDifference, difference, pairs};
use crate::flight::Row;
use crate::results::{METRICS, MetricSummary, SuiteCard, strata, summary};
use serde_json::Value;
use std::collections::BTreeMap;

/// All entries of a folder.
#[derive(Clone, Debug, PartialEq)]
pub struct Board {
    /// Entries that flew the same episodes in the same air with the same drone.
    pub contests: Vec<Contest>,
    /// Files that are no entries.
    pub refused: Vec<Refused>,
    /// Number of entries that were flown again by this call.
    pub flown: usize,
}

/// A file that is no entry.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refused {
    /// Its name, without the ending.
    pub file: String,
    /// Why.
    pub reason: String,
}

/// Entries that flew the same episodes in the same air with the same drone.
#[derive(Clone, Debug, PartialEq)]
pub struct Contest {
    /// Suite.
    pub suite: SuiteCard,
    /// Settings that all have in common.
    pub ground: Value,
    /// Entries whose policies were run again, by what they see.
    pub rerun: Vec<Class>,
    /// Entries whose actions alone were verified, the highest tracking rate first.
    pub ranked: Vec<Standing>,
    /// Verified entries that know the world: no rank among the others.
    pub world: Vec<Standing>,
    /// Entries whose scores are a claim.
    pub claimed: Vec<Standing>,
}

/// Entries whose policies were run again and see the same.
#[derive(Clone, Debug, PartialEq)]
pub struct Class {
    /// Their inputs, in words.
    pub sees: String,
    /// The entries, the highest tracking rate first.
    pub ranked: Vec<Standing>,
}

/// An entry with its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Standing {
    /// The entry.
    pub entry: Entry,
    /// Rank among the entries that it is listed with; equal rates have equal ranks, and entries that fly alike share the best of theirs.
    pub rank: Option<usize>,
    /// Entries that fly more than half of the episodes alike have the same number.
    pub group: usize,
    /// File of another entry that flies more than half of the episodes alike, and the number of these episodes.
    pub alike: Option<(String, usize)>,
    /// Metrics, in the order of `METRICS`.
    pub scores: Vec<MetricSummary>,
    /// Tracking rate, minus that of the first that it is listed with, over pairs of episodes.
    pub behind: Option<MetricDifference>,
    /// Mean tracking rate by group of episodes.
    pub groups: Vec<(String, f64)>,
}

impl Standing {
    /// Mean tracking rate.
    pub fn rate(&self) -> f64 {
        self.scores.first().and_then(|score| score.mean).unwrap_or(0.0)
    }
}

impl Board {
    /// The board of entries.
    pub fn of(entries: Vec<Entry>, refused: Vec<Refused>, flown: usize) -> Self {
        let mut contests: BTreeMap<(String, String, String), Vec<Entry>> = BTreeMap::new();
        for entry in entries {
            let key = (entry.suite.name.clone(), entry.suite.hash.clone(), entry.card.ground().to_string());
            contests.entry(key).or_default().push(entry);
        }
        Self { contests: contests.into_values().filter_map(Contest::of).collect(), refused, flown }
    }

    /// Number of entries whose scores are a claim.
    pub fn claims(&self) -> usize {
        self.contests.iter().map(|contest| contest.claimed.len()).sum()
    }

    /// Whether no entry is refused, is a claim, or has a policy that gives other actions.
    pub fn is_sound(&self) -> bool {
        let sound = |standing: &Standing| standing.entry.proof.differs().is_empty();
        self.refused.is_empty() && self.claims() == 0 && self.contests.iter().flat_map(Contest::all).all(sound)
    }
}

impl Contest {
    fn of(entries: Vec<Entry>) -> Option<Self> {
        let (suite, ground) = entries.first().map(|first| (first.suite.clone(), first.card.ground()))?;
        let found = alike(&entries.iter().map(|entry| entry.rows.as_slice()).collect::<Vec<_>>());
        let files: Vec<String> = entries.iter().map(|entry| entry.file.clone()).collect();
        let mut standings: Vec<Standing> = entries.into_iter().map(standing).collect();
        for (standing, found) in standings.iter_mut().zip(found) {
            standing.group = found.group;
            standing.alike = found.closest.map(|(other, episodes)| (files[other].clone(), episodes));
        }
        standings.sort_by(|a, b| b.rate().total_cmp(&a.rate()).then_with(|| a.entry.file.cmp(&b.entry.file)));
        let (claimed, verified): (Vec<_>, Vec<_>) =
            standings.into_iter().partition(|it| matches!(it.entry.proof, Proof::Claimed(_)));
        let (world, seeing): (Vec<_>, Vec<_>) = verified.into_iter().partition(|it| it.entry.sees.world);
        let (run, mut ranked): (Vec<_>, Vec<_>) = seeing.into_iter().partition(|it| it.entry.proof == Proof::Rerun);
        rank(&mut ranked);
        let mut classes: BTreeMap<String, Vec<Standing>> = BTreeMap::new();
        run.into_iter().for_each(|it| classes.entry(it.entry.sees.words.clone()).or_default().push(it));
        let class = |(sees, mut ranked): (String, Vec<Standing>)| {
            rank(&mut ranked);
            Class { sees, ranked }
        };
        let rerun = classes.into_iter().map(class).collect();
        Some(Self { suite, ground, rerun, ranked, world, claimed })
    }

    /// All entries, those that prove most first.
    pub fn all(&self) -> impl Iterator<Item = &Standing> {
        self.rerun.iter().flat_map(|class| &class.ranked).chain(&self.ranked).chain(&self.world).chain(&self.claimed)
    }
}

/// Gives ranks to entries in the order of their rates, and the distance from the first. A group of entries that fly alike takes one place.
fn rank(ranked: &mut [Standing]) {
    let places = places(&ranked.iter().map(|it| (it.group, it.rate())).collect::<Vec<_>>());
    let Some(first) = ranked.first().map(|first| first.entry.rows.clone()) else { return };
    for (at, standing) in ranked.iter_mut().enumerate() {
        standing.rank = Some(places[at]);
        standing.behind = (at > 0).then(|| difference(&METRICS[0], &pairs(&first, &standing.entry.rows))).flatten();
    }
}

/// Ranks of groups and rates, the highest rate first: each has that of the best of its group, and a group takes one place.
fn places(ranked: &[(usize, f64)]) -> Vec<usize> {
    let mut best: Vec<(usize, f64)> = vec![];
    for &(group, rate) in ranked {
        if best.iter().all(|&(other, _)| other != group) {
            best.push((group, rate));
        }
    }
    let higher = |rate: f64| best.iter().filter(|(_, other)| *other > rate).count();
    let of_group = |group: usize| best.iter().find(|(other, _)| *other == group).map_or(0, |&(_, rate)| higher(rate));
    ranked.iter().map(|&(group, _)| 1 + of_group(group)).collect()
}

fn standing(entry: Entry) -> Standing {
    let scores = summary(&entry.rows.iter().collect::<Vec<_>>());
    let groups = groups(&entry.rows);
    Standing { entry, rank: None, group: 0, alike: None, scores, behind: None, groups }
}

/// Mean tracking rate by stratum of the suite, where there are several, and by thirds of the episodes, from those that the expert's
/// flights see best.
fn groups(rows: &[Row]) -> Vec<(String, f64)> {
    let mean = |rows: &[&Row]| rows.iter().map(|row| row.score.tracking_rate()).sum::<f64>() / rows.len().max(1) as f64;
    let by_stratum = strata(rows);
    let several = by_stratum.len() > 1;
    let mut groups: Vec<(String, f64)> =
        by_stratum.iter().filter(|_| several).map(|(name, rows)| ((*name).to_owned(), mean(rows))).collect();
    let mut ordered: Vec<&Row> = rows.iter().collect();
    let visible = |row: &Row| row.certified_visibility;
    ordered.sort_by(|a, b| visible(b).total_cmp(&visible(a)).then_with(|| a.episode.cmp(&b.episode)));
    let end = |third: usize| third * ordered.len() / 3;
    if ordered.len() >= 3 {
        let thirds = ["easy third", "middle third", "hard third"].into_iter().zip(0..);
        groups.extend(thirds.map(|(name, third)| (name.to_owned(), mean(&ordered[end(third)..end(third + 1)]))));
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::places;

    #[test]
    fn a_group_takes_one_place_and_equal_rates_share_one() {
        let ranked = [(0, 0.9), (0, 0.9), (3, 0.8), (4, 0.8), (0, 0.7), (5, 0.6)];
        assert_eq!(places(&ranked), [1, 1, 2, 2, 1, 4]);
        assert_eq!(places(&[]), [0; 0]);
    }
}
