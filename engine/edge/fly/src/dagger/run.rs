//! A round: all episodes of a suite, flown and labelled on several threads; episodes that are in the folder are kept.

use super::folder::LabelFolder;
use super::rollout::{Mixture, rollout};
use crate::experts::Experts;
use crate::pilot::{Manners, Place, open};
use crate::suite::Suite;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_env::Settings;
use cosfly_recipe::Recipe;
use cosfly_store::Store;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};

/// What is flown, and how.
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
    pub settings: Settings,
    /// Who flies.
    pub mixture: Mixture,
    /// Name of the round.
    pub name: &'a str,
    /// Threads.
    pub jobs: usize,
    /// Set from anywhere to stop.
    pub cancelled: &'a AtomicBool,
}

/// What came of it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Flown {
    /// Episodes flown by this call.
    pub episodes: usize,
    /// States from which the expert was asked for its way on.
    pub asked: u64,
}

/// Flies what the folder lacks of a round.
///
/// # Errors
/// Errors of the expert and of the file system; `fly-policy-gone`; `fly-stopped`.
pub fn run(round: &Round<'_>, folder: &LabelFolder, progress: &dyn Fn(u64, u64)) -> Result<Flown> {
    let tasks = &round.suite.tasks;
    let due: Vec<usize> = (0..tasks.len()).filter(|at| !folder.has(round.name, &tasks[*at].episode.name)).collect();
    let (next, done, asked, stop) =
        (AtomicUsize::new(0), AtomicUsize::new(0), AtomicU64::new(0), AtomicBool::new(false));
    let failed: Mutex<Option<Box<Diagnostic>>> = Mutex::new(None);
    let one = |experts: &mut Experts<'_>, pilot: &mut dyn crate::pilot::Pilot, at: usize| -> Result<()> {
        let task = &tasks[at];
        let known = experts.flight(&task.episode.name)?;
        match rollout(task, &known, round.settings, &round.mixture, pilot)? {
            Ok(made) => {
                asked.fetch_add(u64::from(made.asked), Ordering::Relaxed);
                folder.keep(round.name, &task.episode.name, &made)
            }
            Err(reason) => {
                let message = "the policy could not be had for some of the episodes";
                Err(Diagnostic::new("fly-policy-gone", Fault::Machine, message)
                    .because(reason)
                    .hint("the episodes that were flown are kept: the same command flies the others"))
            }
        }
    };
    let work = || {
        let made = cosfly_runner::plan(round.recipe, round.store).and_then(|plan| {
            let mut experts = Experts::new(plan, round.store);
            let mut pilot = open(round.place, round.manners);
            while !stop.load(Ordering::Relaxed) && !round.cancelled.load(Ordering::Relaxed) {
                let Some(&at) = due.get(next.fetch_add(1, Ordering::Relaxed)) else { break };
                one(&mut experts, &mut *pilot, at)?;
                done.fetch_add(1, Ordering::Relaxed);
            }
            Ok(())
        });
        if let Err(error) = made {
            stop.store(true, Ordering::Relaxed);
            failed.lock().unwrap_or_else(|it| it.into_inner()).get_or_insert(error);
        }
    };
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..round.jobs.clamp(1, due.len().max(1))).map(|_| scope.spawn(work)).collect();
        while workers.iter().any(|worker| !worker.is_finished()) {
            progress(done.load(Ordering::Relaxed) as u64, due.len() as u64);
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
    });
    if let Some(error) = failed.into_inner().unwrap_or_else(|it| it.into_inner()) {
        return Err(error);
    }
    if round.cancelled.load(Ordering::Relaxed) {
        let message = "stopped; the episodes that were flown are kept, and the same command goes on with the others";
        return Err(Diagnostic::new("fly-stopped", Fault::Stopped, message));
    }
    Ok(Flown { episodes: done.into_inner(), asked: asked.into_inner() })
}
