//! [`scout`]: baselines that fly every candidate before the policy does: they cost little, and where they have trouble others have, too.

use super::hidden_views::hidden_views;
use super::pool::Pool;
use crate::crew::{EpisodeOutcome, Shifts, crew};
use crate::flight::{Attempt, Latency, Row, fly};
use crate::pilot::{Asked, FirstAnswer, Manners, Place};
use cosfly_diagnose::Result;
use cosfly_env::{End, EnvironmentSettings};
use std::sync::OnceLock;
use std::sync::atomic::AtomicBool;

/// The scouts: the first says whether an episode can be flown at all.
const SCOUTS: [&str; 7] = [
    "expert",
    "expert:delay_s=0.5",
    "expert:gain=0.7",
    "expert:noise_mps=2",
    "follow",
    "follow:delay_s=0.5",
    "constant-velocity",
];
/// Features of a scout.
const FEATURES: usize = 2;
/// Weight of the share of hidden views in the first guess, where that of all scouts together is 1.
const HIDDEN_VIEWS: f64 = 0.25;

/// Weights of the features in the first guess, before a flight: all scouts' features alike, hidden views, nothing for drawn values.
pub fn first_weights(features: usize) -> Vec<f64> {
    let told = SCOUTS.len() * FEATURES;
    let weights = std::iter::repeat_n(1.0 / told as f64, told).chain([HIDDEN_VIEWS]).chain(std::iter::repeat(0.0));
    weights.take(features).collect()
}

/// How candidates are flown.
pub struct Scouting<'a> {
    /// Settings of the environment, for each part of the pool.
    pub settings: &'a [EnvironmentSettings],
    /// How policies are asked.
    pub manners: &'a Manners,
    /// Threads.
    pub jobs: usize,
    /// Set from anywhere to stop.
    pub cancelled: &'a AtomicBool,
}

/// Whether a policy failed in an episode: it collided, lost the target for good, or answered wrongly.
pub fn failed(row: &Row) -> bool {
    row.policy_failure.is_some() || row.score.end != Some(End::Finished)
}

/// Features of each candidate before the policy flies it, numbers of 0..=1: for each scout its share of steps without the target and
/// whether it failed, then the share of hidden views around the target, then the drawn values. `None` where the expert has no success.
/// `progress` gets the numbers of finished and of all.
///
/// # Errors
/// `fly-stopped`.
pub fn scout(pool: &Pool, order: &Scouting<'_>, progress: &dyn Fn(u64, u64)) -> Result<Vec<Option<Vec<f64>>>> {
    let places = SCOUTS.iter().map(|name| Place::read(name)).collect::<Result<Vec<_>>>()?;
    let told: Vec<OnceLock<Option<Vec<f64>>>> = pool.suite.tasks.iter().map(|_| OnceLock::new()).collect();
    let first = FirstAnswer::default();
    first.tell();
    let shifts = Shifts { jobs: order.jobs, cancelled: order.cancelled, first: &first };
    let pilots = || Ok(places.iter().map(|place| Asked::new(place, order.manners, &first)).collect::<Vec<_>>());
    crew((0..told.len()).collect(), &shifts, progress, pilots, |pilots, at| {
        let task = &pool.suite.tasks[at];
        let mut features = vec![];
        for (number, pilot) in pilots.iter_mut().enumerate() {
            let flown = match fly(task, order.settings[task.part], Latency::Simulated, pilot) {
                Attempt::Flown(flown) => flown,
                Attempt::Unanswered(reason) | Attempt::Gone(reason) => return Ok(EpisodeOutcome::Gone(reason)),
            };
            // The expert's success is more than that it comes to the end: it tracks the target there.
            if number == 0 && !flown.row.score.success() {
                told[at].get_or_init(|| None);
                return Ok(EpisodeOutcome::Kept);
            }
            features.extend([1.0 - flown.row.score.tracking_rate(), f64::from(u8::from(failed(&flown.row)))]);
        }
        features.push(hidden_views(&task.episode));
        features.extend(&pool.draws[task.part].places);
        told[at].get_or_init(|| Some(features));
        Ok(EpisodeOutcome::Kept)
    })?;
    Ok(told.into_iter().map(|told| told.into_inner().flatten()).collect())
}
