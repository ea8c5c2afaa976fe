//! [`Again`]: the actions of a bundle, flown again; and its policy, run again.

use crate::bundle::{Bundle, EpisodeRecord};
use crate::flight::{FlownEpisode, fly_by};
use crate::pilot::{PilotFailure, Runnable};
use crate::suite::{EpisodeTask, Suite};
use cosfly_diagnose::{Diagnostic, Fault, Result, counted};
use cosfly_env::{Environment, EnvironmentSettings};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Sender, channel};

/// A bundle and what it is flown again with.
pub struct Again<'a> {
    /// The bundle.
    pub bundle: &'a Bundle,
    /// The suite that it is of.
    pub suite: &'a Suite,
    /// Settings of each part of the suite.
    pub settings: &'a [EnvironmentSettings],
    /// Threads.
    pub jobs: usize,
    /// Set from anywhere to stop.
    pub cancelled: &'a AtomicBool,
}

impl Again<'_> {
    /// Flies all episodes by the recorded actions, and gives for each that does not come to the same row the first step that differs,
    /// in words. `progress` gets the numbers of finished and of all episodes.
    ///
    /// # Errors
    /// `fly-bundle` for a bundle of another suite; `fly-stopped`.
    pub fn by_record(&self, progress: &dyn Fn(u64, u64)) -> Result<Vec<String>> {
        let is_measured = self.bundle.card.is_measured();
        let flown =
            |task: &EpisodeTask, record: &EpisodeRecord| by_record(task, self.settings[task.part], is_measured, record);
        self.differences(&flown, progress)
    }

    /// Runs the policy again on what it sees, and gives for each episode in which it does not give the same actions, which come to
    /// the same row, the first step that differs, in words.
    ///
    /// # Errors
    /// `fly-bundle` for a bundle of another suite; `fly-stopped`.
    pub fn by_policy(&self, policy: &Runnable, progress: &dyn Fn(u64, u64)) -> Result<Vec<String>> {
        let is_measured = self.bundle.card.is_measured();
        let flown = |task: &EpisodeTask, record: &EpisodeRecord| {
            let settings = self.settings[task.part];
            let mut pilot = policy.pilot();
            pilot.begin(&Environment::new(Arc::clone(&task.episode), settings), &task.knowledge)?;
            fly_by(task, settings, &mut |environment: &Environment| {
                let kept = record.steps.get(environment.observation().step as usize);
                // Times are those of the record: the clock of this machine says nothing of another.
                let latency_s = kept.and_then(|kept| kept.latency_s).filter(|_| is_measured);
                pilot.act(environment).map(|action| (action, latency_s))
            })
        };
        self.differences(&flown, progress)
    }

    /// How episodes that are flown differ from their records.
    fn differences(&self, flown: &FlyOne<'_>, progress: &dyn Fn(u64, u64)) -> Result<Vec<String>> {
        let (bundle, suite) = (self.bundle, self.suite);
        let records: BTreeMap<&str, &EpisodeRecord> =
            bundle.episodes.iter().map(|record| (record.row.episode.as_str(), record)).collect();
        let unknown = suite.tasks.iter().find(|task| !records.contains_key(task.episode.name.as_str()));
        if let Some(task) = unknown {
            let message = format!("the bundle has no episode `{}` of the suite `{}`", task.episode.name, suite.name);
            return Err(Diagnostic::new("fly-bundle", Fault::Input, message));
        }
        if bundle.episodes.len() != suite.tasks.len() {
            let (theirs, ours) = (bundle.episodes.len(), suite.tasks.len());
            let message = format!(
                "the bundle has {theirs}, the suite `{}` has {ours}",
                suite.name,
                theirs = counted(theirs, "episode")
            );
            return Err(Diagnostic::new("fly-bundle", Fault::Input, message));
        }
        let one = |done: &mut Sender<()>, task: &EpisodeTask| {
            if self.cancelled.load(Ordering::Relaxed) {
                return None;
            }
            let record = records[task.episode.name.as_str()];
            let found = difference(&task.episode.name, flown(task, record), record);
            // Nobody listens any more: nothing is shown.
            _ = done.send(());
            Some(found)
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.jobs).build();
        let pool = pool.map_err(|error| Diagnostic::new("fly-threads", Fault::Machine, error.to_string()))?;
        let (done, heard) = channel();
        let found: Option<Vec<Option<String>>> = std::thread::scope(|scope| {
            let flown = scope.spawn(|| pool.install(|| suite.tasks.par_iter().map_with(done, one).collect()));
            heard.iter().zip(1..).for_each(|((), count)| progress(count, suite.tasks.len() as u64));
            flown.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        });
        let found = found.ok_or_else(|| {
            let message = "stopped before all episodes were flown again";
            Diagnostic::new("fly-stopped", Fault::Stopped, message).hint("run the same command again")
        })?;
        Ok(found.into_iter().flatten().collect())
    }
}

/// Flies an episode that has a record.
type FlyOne<'a> = dyn Fn(&EpisodeTask, &EpisodeRecord) -> std::result::Result<FlownEpisode, String> + Sync + 'a;

/// The first step, or the row, in which an episode differs from its record, in words.
fn difference(name: &str, flown: std::result::Result<FlownEpisode, String>, record: &EpisodeRecord) -> Option<String> {
    let flown = match flown {
        Ok(flown) => flown,
        Err(rule) => return Some(format!("`{name}`: {rule}")),
    };
    let again = EpisodeRecord::of(&flown.row, &flown.steps);
    let step = again.steps.iter().zip(&record.steps).position(|(ours, theirs)| ours != theirs);
    if let Some(step) = step {
        return Some(format!("`{name}`: step {} comes out differently", step + 1));
    }
    if again.steps.len() != record.steps.len() {
        let (ours, theirs) = (again.steps.len(), record.steps.len());
        return Some(format!(
            "`{name}`: it ends after {ours}, in the record after {theirs}",
            ours = counted(ours, "step")
        ));
    }
    let (ours, theirs) = (again.row_text(), record.row_text());
    (ours != theirs).then(|| format!("`{name}`: all steps are equal, the row is not: {ours} instead of {theirs}"))
}

/// Flies an episode by the actions of its record.
///
/// # Errors
/// A step without an action where one is asked for, in words.
pub fn by_record(
    task: &EpisodeTask,
    settings: EnvironmentSettings,
    is_measured: bool,
    record: &EpisodeRecord,
) -> std::result::Result<FlownEpisode, String> {
    fly_by(task, settings, &mut |environment: &Environment| {
        let step = environment.observation().step;
        match record.steps.get(step as usize) {
            // The policy failed here: the row says so.
            None => Err(PilotFailure::Answer(String::new())),
            Some(kept) => match kept.action {
                // Latencies that were not measured are those of the card.
                Some(action) => Ok((action, kept.latency_s.filter(|_| is_measured))),
                None => Err(PilotFailure::Gone(format!("step {} has no action where one is asked for", step + 1))),
            },
        }
    })
}
