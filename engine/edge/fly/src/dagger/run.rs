//! A round: all episodes of a suite, flown and labelled on several threads; episodes that are in the folder are kept.

use super::folder::LabelFolder;
use super::kept::{KeptObservations, ObservationKeeper};
use super::rollout::{Attempt, PolicyMixture, rollout};
use crate::crew::{EpisodeOutcome, Shifts, crew};
use crate::experts::Experts;
use crate::pilot::{Asked, FirstAnswer, Manners, Place};
use crate::suite::Suite;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_env::EnvironmentSettings;
use cosfly_recipe::Recipe;
use cosfly_store::Store;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// Task of a round: suite, policy and settings.
pub struct Round<'a> {
    /// Recipe of the suite.
    pub recipe: &'a Recipe,
    /// Store with its flights.
    pub store: &'a Store,
    /// Episodes.
    pub suite: &'a Suite,
    /// The policy.
    pub place: &'a Place,
    /// How it is asked.
    pub manners: &'a Manners,
    /// Settings of the environment.
    pub settings: EnvironmentSettings,
    /// Pilot of the episode.
    pub mixture: PolicyMixture,
    /// Observations that are kept with every label.
    pub kept: KeptObservations,
    /// Name of the round.
    pub name: &'a str,
    /// Name of the policy.
    pub policy: &'a str,
    /// Threads.
    pub jobs: usize,
    /// Set from anywhere to stop.
    pub cancelled: &'a AtomicBool,
}

/// Outcome of a round.
#[derive(Debug, Default)]
pub struct RoundOutcome {
    /// Episodes flown by this call.
    pub episodes: usize,
    /// States from which the expert was asked for its way on.
    pub asked: u64,
    /// Episodes of this call that the policy ended by its fault, and why in the first of them.
    pub failures: Option<(usize, String)>,
    /// Why episodes were not flown: the policy could not be had, or is not set up.
    pub gone: Option<Box<Diagnostic>>,
}

/// Flies what the folder lacks of a round.
///
/// # Errors
/// Errors of the expert and of the file system; `fly-stopped`.
pub fn run(round: &Round<'_>, folder: &LabelFolder, progress: &dyn Fn(u64, u64)) -> Result<RoundOutcome> {
    let tasks = &round.suite.tasks;
    let due: Vec<usize> = (0..tasks.len()).filter(|at| !folder.has(round.name, &tasks[*at].episode.name)).collect();
    let (first, all, asked) = (FirstAnswer::default(), due.len(), AtomicU64::new(0));
    let failures: Mutex<BTreeMap<usize, String>> = Mutex::default();
    let shifts = Shifts { jobs: round.jobs, cancelled: round.cancelled, first: &first };
    let worker = || {
        let plan = cosfly_runner::plan(round.recipe, round.store)?;
        let keeper = ObservationKeeper::new(&round.kept);
        Ok((Experts::new(plan, round.store), Asked::new(round.place, round.manners, &first), keeper))
    };
    let crewed = crew(due, &shifts, progress, worker, |(experts, pilot, keeper), at| {
        let task = &tasks[at];
        let known = experts.flight(&task.episode.name)?;
        Ok(match rollout(task, &known, round.settings, &round.mixture, pilot, keeper)? {
            Attempt::Flown(made) => {
                asked.fetch_add(u64::from(made.asked), Ordering::Relaxed);
                folder.keep(round.name, &task.episode.name, &made, keeper)?;
                if let Some(reason) = made.policy_failure {
                    let reason = format!("{}, {reason}", task.episode.name);
                    failures.lock().unwrap_or_else(PoisonError::into_inner).insert(at, reason);
                }
                EpisodeOutcome::Kept
            }
            Attempt::Unanswered(reason) => EpisodeOutcome::Unanswered(reason),
            Attempt::Gone(reason) => EpisodeOutcome::Gone(reason),
        })
    })?;
    let failures = failures.into_inner().unwrap_or_else(PoisonError::into_inner);
    Ok(RoundOutcome {
        episodes: crewed.kept,
        asked: asked.into_inner(),
        failures: failures.first_key_value().map(|(_, reason)| (failures.len(), reason.clone())),
        gone: crewed.gone.map(|reason| first.refusal(round.policy, &reason, all - crewed.kept)),
    })
}
