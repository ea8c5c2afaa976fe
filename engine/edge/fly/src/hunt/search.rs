//! [`hunt`]: rounds of flights, the likeliest failures first.

use super::guess::Guess;
use super::pool::Pool;
use super::scouts::{failed, first_weights};
use crate::crew::{EpisodeOutcome, Shifts, crew};
use crate::flight::{Attempt, Latency, fly};
use crate::pilot::{Asked, FirstAnswer};
use crate::results::Folder;
use crate::run::Order;
use cosfly_diagnose::Result;
use cosfly_frames::Seed;
use std::collections::{BTreeMap, BTreeSet};

/// Flights of a round: after each the guess is fitted anew.
const ROUND: usize = 8;

/// Order in which candidates are flown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Search {
    /// The likeliest failures first; each flight tells of the next.
    Likeliest,
    /// At random, with this seed, those in which the expert fails too: what a hunt is measured against.
    Random(u64),
}

/// Outcome of a hunt.
#[derive(Debug, Default)]
pub struct Hunted {
    /// Candidates that were flown, in the order of their choice, and whether the policy failed.
    pub flown: Vec<(usize, bool)>,
    /// Candidates in which the expert fails.
    pub left_out: usize,
}

impl Hunted {
    /// Candidates in which the policy failed.
    pub fn failures(&self) -> Vec<usize> {
        self.flown.iter().filter(|(_, failed)| *failed).map(|(at, _)| *at).collect()
    }
}

/// Flies `budget` candidates of the order's suite and keeps their rows in the folder; those that are there already count as flown. A walk
/// in which the policy has failed is not flown again in other air, unless candidates are flown at random. `told` is what scouts say.
///
/// # Errors
/// Errors of the file system; `fly-stopped`; a policy that could not be had.
pub fn hunt(
    pool: &Pool,
    told: &[Option<Vec<f64>>],
    order: &Order<'_>,
    (search, budget): (Search, usize),
    folder: &Folder,
    progress: &dyn Fn(u64, u64),
) -> Result<Hunted> {
    let first = FirstAnswer::default();
    let mut hunted = Hunted { left_out: told.iter().filter(|told| told.is_none()).count(), ..Hunted::default() };
    let budget = budget.min(told.len());
    let first_weights = first_weights(told.iter().flatten().map(Vec::len).next().unwrap_or(0));
    loop {
        progress(hunted.flown.len() as u64, budget as u64);
        let count = ROUND.min(budget - hunted.flown.len());
        let round = match search {
            Search::Likeliest => next(pool, told, &hunted.flown, &first_weights, count),
            Search::Random(seed) => {
                shuffled(told.len(), seed).into_iter().skip(hunted.flown.len()).take(count).collect()
            }
        };
        if round.is_empty() {
            return Ok(hunted);
        }
        let due: Vec<usize> = round.iter().copied().filter(|at| row(pool, folder, *at).is_none()).collect();
        let missing = due.len();
        let shifts = Shifts { jobs: order.jobs, cancelled: order.cancelled, first: &first };
        let pilot = || Ok(Asked::new(order.place, order.manners, &first));
        let crewed = crew(due, &shifts, &|_, _| (), pilot, |pilot, at| {
            let task = &pool.suite.tasks[at];
            Ok(match fly(task, order.settings[task.part], Latency::Simulated, pilot) {
                Attempt::Flown(flown) => {
                    folder.keep(&flown, None)?;
                    EpisodeOutcome::Kept
                }
                Attempt::Unanswered(reason) => EpisodeOutcome::Unanswered(reason),
                Attempt::Gone(reason) => EpisodeOutcome::Gone(reason),
            })
        })?;
        if let Some(reason) = crewed.gone {
            return Err(first.refusal(&order.place.name(), &reason, missing - crewed.kept));
        }
        hunted
            .flown
            .extend(round.into_iter().filter_map(|at| Some((at, row(pool, folder, at)? && told[at].is_some()))));
    }
}

/// Whether the policy failed in a candidate, where it was flown.
fn row(pool: &Pool, folder: &Folder, at: usize) -> Option<bool> {
    folder.row(&pool.suite.tasks[at].episode.name).map(|row| failed(&row))
}

/// Numbers below `all` in a random order.
fn shuffled(all: usize, seed: u64) -> Vec<usize> {
    let mut stream = Seed::of_item(seed, "hunt", "random").stream("order");
    let mut order: Vec<usize> = (0..all).collect();
    (1..all).rev().for_each(|last| order.swap(last, stream.index(last + 1)));
    order
}

/// The likeliest failures among the candidates, each of another walk.
fn next(
    pool: &Pool,
    told: &[Option<Vec<f64>>],
    flown: &[(usize, bool)],
    first_weights: &[f64],
    count: usize,
) -> Vec<usize> {
    let known: Vec<(&[f64], bool)> =
        flown.iter().filter_map(|(at, failed)| Some((told[*at].as_deref()?, *failed))).collect();
    let guess = Guess::of(&known, first_weights);
    let before: BTreeSet<usize> = flown.iter().map(|(at, _)| *at).collect();
    let mut walks: BTreeSet<(usize, &str)> =
        flown.iter().filter(|(_, failed)| *failed).map(|(at, _)| pool.walk(*at)).collect();
    let open = told.iter().enumerate().filter(|(at, _)| !before.contains(at));
    let mut open: Vec<(usize, f64)> = open.filter_map(|(at, told)| Some((at, guess.at(told.as_deref()?)))).collect();
    open.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    open.into_iter().map(|(at, _)| at).filter(|at| walks.insert(pool.walk(*at))).take(count).collect()
}

/// Number of failures of each part of the pool.
pub fn by_part(pool: &Pool, failures: &[usize]) -> BTreeMap<usize, usize> {
    let mut parts = BTreeMap::new();
    failures.iter().for_each(|at| *parts.entry(pool.suite.tasks[*at].part).or_insert(0) += 1);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_random_order_has_each_once_and_is_the_same_again() {
        let order = shuffled(100, 7);
        assert!(order == shuffled(100, 7) && order != shuffled(100, 8));
        assert_eq!(order.iter().copied().collect::<BTreeSet<_>>().len(), 100);
    }
}
