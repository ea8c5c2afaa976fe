//! The driver of a run on HyperQueue: plans, leaves out what is finished, submits the rest as one job, follows it, and looks
//! again, until nothing is left that could be done. It may die at any time: another one finds the job by its name.
//!
//! The store is the truth. What the engine says only tells where to look: a record is read after the engine reports the end
//! of its task, because a network file system may remember for a minute that a file was absent.

use crate::hq::{Hq, Job};
use crate::job_file::job_file;
use crate::leaves::{Command, Leaf, kept_stages, leaves};
use crate::request::Request;
use crate::told::Told;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_recipe::Recipe;
use cosfly_runner::{Plan, plan_elsewhere};
use cosfly_stage::RunEvent;
use cosfly_store::Store;
use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Time during which a server that does not answer is asked again.
const PATIENCE: Duration = Duration::from_secs(120);
/// Time during which a finished task is looked for in the store: network file systems remember absent files.
const VISIBLE: Duration = Duration::from_secs(90);
/// Submissions in a row after which nothing had changed.
const MOST_IDLE_WAVES: u32 = 5;
/// Pauses between two looks at the engine.
const SHORTEST_PAUSE: Duration = Duration::from_millis(100);
const LONGEST_PAUSE: Duration = Duration::from_secs(5);

/// A run on HyperQueue.
pub struct Driver<'a> {
    /// Recipe to run.
    pub recipe: &'a Recipe,
    /// Store that all machines share.
    pub store: &'a Store,
    /// Stage that the driver runs itself, with all that read it.
    pub wanted: usize,
    /// Stage that is asked for; without one, all stages that no other reads.
    pub asked: Option<usize>,
    /// Command of leaves.
    pub command: Command,
    /// Requests by stage.
    pub requests: Vec<Request>,
    /// Set from anywhere to stop: the job is cancelled.
    pub cancelled: Arc<AtomicBool>,
}

/// Failures of a run on other machines; everything else is in the store.
#[derive(Debug, Default)]
pub struct ClusterOutcome {
    /// Failed tasks by plan digest, all reported as events.
    pub failed: BTreeMap<Digest, Box<Diagnostic>>,
    /// Tasks that gave other bytes than before; the earlier bytes are kept.
    pub divergences: Vec<Box<Diagnostic>>,
}

/// A submitted job and its leaves.
struct Wave<'p, 'r> {
    plan: &'p Plan<'r>,
    leaves: BTreeMap<u32, &'p Leaf>,
    job: u64,
    name: String,
}

impl Driver<'_> {
    /// Runs everything but the stages that the driver keeps.
    ///
    /// # Errors
    /// Failures of the engine, the store or the machine. Failed tasks are part of the result.
    pub fn run(&self, hq: &Hq, report: &(dyn Fn(RunEvent) + Sync)) -> Result<ClusterOutcome> {
        let mut told = Told::new(self.store, report);
        let (mut idle_waves, mut is_first) = (0, true);
        while !self.is_stopped() {
            let plan = plan_elsewhere(self.recipe, self.store, self.asked)?;
            let before = told.progress();
            told.planned(&plan, is_first);
            let kept = kept_stages(&plan, self.wanted);
            let requests = self.requests_of_wave(&told);
            let leaves = leaves(&plan, &kept, |digest| told.failed.contains_key(digest), &requests);
            if leaves.is_empty() {
                break;
            }
            if idle_waves == MOST_IDLE_WAVES {
                let message = format!("HyperQueue ended {MOST_IDLE_WAVES} jobs in a row without finishing a task");
                return Err(Diagnostic::new("cluster-no-progress", Fault::Machine, message)
                    .hint("look at `hq job list --all` and at the log of the server"));
            }
            let name = self.job_name(&plan, &requests);
            let job = match self.patiently(|| self.find_running(hq, &name))? {
                Some(job) => job,
                None => {
                    plan.publish_documents(self.store)?;
                    self.submit(hq, &name, &leaves)?
                }
            };
            let by_id = leaves.iter().map(|leaf| (leaf.id, leaf)).collect();
            let wave = Wave { plan: &plan, leaves: by_id, job, name };
            self.follow(hq, &wave, &mut told)?;
            let moved = told.progress() > before || is_first;
            idle_waves = if moved { 0 } else { idle_waves + 1 };
            is_first = false;
        }
        Ok(ClusterOutcome { failed: told.failed, divergences: told.divergences })
    }

    fn is_stopped(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Requests by stage; after a command without a result, every task of its stage has a command of its own, so that one
    /// that brings its command down does not take others with it.
    fn requests_of_wave(&self, told: &Told<'_>) -> Vec<Request> {
        let alone = |(stage, request): (usize, &Request)| match told.lossy.contains(&stage) {
            true => Request { batch: 1, ..*request },
            false => *request,
        };
        self.requests.iter().enumerate().map(alone).collect()
    }

    /// Name of the job: the same for every driver of the same plan, requests and store, so that leaves have the same numbers.
    fn job_name(&self, plan: &Plan<'_>, requests: &[Request]) -> String {
        // Raised where leaves of the same plan and requests get other tasks than before.
        let mut bytes: Vec<u8> = b"leaves 2 ".to_vec();
        bytes.extend(self.command.store.bytes());
        bytes.extend(format!("{requests:?}").bytes());
        plan.stages.iter().for_each(|stage| stage.plans.iter().for_each(|digest| bytes.extend(digest.0)));
        format!("cosfly-{}-{}", self.recipe.name, Digest::of(&bytes).short())
    }

    fn find_running(&self, hq: &Hq, name: &str) -> Result<Option<u64>> {
        let jobs = hq.jobs()?;
        Ok(jobs.into_iter().rev().find(|job| job.name == name && !job.is_over()).map(|job| job.id))
    }

    fn submit(&self, hq: &Hq, name: &str, leaves: &[Leaf]) -> Result<u64> {
        let failed = |error: std::io::Error| Diagnostic::io("write the job file", &error);
        let mut file = tempfile::Builder::new().prefix("cosfly-").suffix(".toml").tempfile().map_err(failed)?;
        file.write_all(job_file(name, leaves, &self.command).as_bytes()).map_err(failed)?;
        self.patiently(|| hq.submit(file.path()))
    }

    /// Follows a job to its end and reports its tasks.
    fn follow(&self, hq: &Hq, wave: &Wave<'_, '_>, told: &mut Told<'_>) -> Result<()> {
        let mut looked = BTreeSet::new();
        // Leaves that the engine has finished, and whose tasks are not all seen in the store yet.
        let mut unseen: BTreeSet<u32> = BTreeSet::new();
        let mut ended = None;
        loop {
            if self.is_stopped() {
                (told.report)(RunEvent::Stopping);
                return hq.cancel(wave.job);
            }
            let began = Instant::now();
            let Some(job) = self.patiently(|| self.job(hq, wave))? else { return Ok(()) };
            if ended != Some(job.ended) {
                ended = Some(job.ended);
                let finished = self.patiently(|| hq.finished(wave.job))?;
                unseen.extend(finished.into_iter().filter(|id| looked.insert(*id)));
            }
            unseen.retain(|id| !self.see(wave, *id, told));
            if job.is_over() {
                break;
            }
            self.sleep((began.elapsed() * 10).clamp(SHORTEST_PAUSE, LONGEST_PAUSE));
        }
        let over = Instant::now();
        while !unseen.is_empty() && over.elapsed() < VISIBLE && !self.is_stopped() {
            self.sleep(SHORTEST_PAUSE * 5);
            unseen.retain(|id| !self.see(wave, *id, told));
        }
        for (id, words) in self.patiently(|| hq.failed(wave.job))? {
            let Some(leaf) = wave.leaves.get(&id) else { continue };
            leaf.tasks.iter().for_each(|(stage, item)| told.ended_badly(wave.plan, *stage, *item, &words));
        }
        Ok(())
    }

    fn job(&self, hq: &Hq, wave: &Wave<'_, '_>) -> Result<Option<Job>> {
        // A server that lost its jobs may have given the number to another one.
        Ok(hq.jobs()?.into_iter().find(|job| job.id == wave.job && job.name == wave.name))
    }

    /// Reports the tasks of a finished leaf; true where all are in the store.
    fn see(&self, wave: &Wave<'_, '_>, id: u32, told: &mut Told<'_>) -> bool {
        let Some(leaf) = wave.leaves.get(&id) else { return true };
        let absent = leaf.tasks.iter().filter(|(stage, item)| !told.finished(wave.plan, *stage, *item)).count();
        absent == 0
    }

    /// Repeats a call of a server that does not answer, such as one that is being started again.
    fn patiently<T>(&self, call: impl Fn() -> Result<T>) -> Result<T> {
        let began = Instant::now();
        let mut pause = SHORTEST_PAUSE;
        loop {
            match call() {
                Err(refusal) if refusal.code == "cluster-hq-refused" && !self.is_stopped() => {
                    if began.elapsed() > PATIENCE {
                        return Err(refusal
                            .hint("start the server again and run the same command: finished items are kept")
                            .hint("a server started with `--journal FILE` also keeps its jobs"));
                    }
                    self.sleep(pause);
                    pause = (pause * 2).min(LONGEST_PAUSE);
                }
                other => return other,
            }
        }
    }

    fn sleep(&self, pause: Duration) {
        let began = Instant::now();
        while began.elapsed() < pause && !self.is_stopped() {
            std::thread::sleep((pause - began.elapsed().min(pause)).min(SHORTEST_PAUSE));
        }
    }
}
