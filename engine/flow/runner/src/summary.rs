//! Summary of a run: how every task ended, and what the finished ones made.

use crate::plan::Plan;
use cosfly_diagnose::Diagnostic;
use cosfly_recipe::{Arrival, Connection, ItemNames};
use cosfly_stage::{Fan, ItemId, ItemName, StageName, Work};
use cosfly_store::Finished;

/// Outcome of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunOutcome {
    /// Every item of every stage is finished.
    Complete,
    /// Something failed; see [`RunSummary::failures`] and [`RunSummary::diagnostics`].
    Failed,
    /// The run was asked to stop. Finished tasks stay finished.
    Cancelled,
}

/// End of a task.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TaskEnd {
    /// Finished, with a usable result.
    Done(Work),
    /// Finished without a usable result; the reason is published.
    Rejected(Work, RejectionReason),
    /// Failed.
    Failed,
    /// Not tried: one of its inputs failed.
    Skipped,
    /// Not tried or given up: the run stopped.
    Cancelled,
    /// Not made: nothing needs it.
    NotNeeded,
}

/// Reason why an item holds no usable result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RejectionReason {
    /// Reason as it is published.
    pub reason: String,
    /// Beginning of the rejection.
    pub origin: RejectionOrigin,
}

/// Beginning of a rejection.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RejectionOrigin {
    /// The item itself was rejected.
    Own,
    /// This item further up was rejected, and all that read it inherit that.
    Inherited(ItemId),
}

/// A task that failed.
#[derive(Clone, Debug)]
pub struct Failure {
    /// Item of the task.
    pub id: ItemId,
    /// Reason.
    pub diagnostic: Box<Diagnostic>,
}

/// Counts of one stage.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StageSummary {
    /// Name of the stage.
    pub name: StageName,
    /// Number of items.
    pub total: u64,
    /// Items that were finished before the run, or by another process during it.
    pub cached: u64,
    /// Items that were computed in this run.
    pub ran: u64,
    /// Items that were not computed, because their inputs turned out to be those of an earlier run.
    pub reused: u64,
    /// Items that failed.
    pub failed: u64,
    /// Items that were not tried, because something that they read failed.
    pub skipped: u64,
    /// Items that were not tried or given up, because the run stopped.
    pub unfinished: u64,
    /// Items that were not made, because nothing needs them: everything that is made of them is finished.
    pub not_needed: u64,
}

/// State of a task at the end of a run.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ending {
    Finished(Work),
    Failed,
    Skipped,
    Cancelled,
    NotNeeded,
}

/// Items of one stage: names, connections, endings and results.
struct StageItems {
    names: ItemNames,
    connections: Vec<Connection>,
    endings: Vec<Ending>,
    results: Vec<Option<Finished>>,
}

/// Summary of a run.
pub struct RunSummary {
    /// Outcome of the run.
    pub outcome: RunOutcome,
    /// Counts of all stages, in the recipe's order.
    pub stages: Vec<StageSummary>,
    /// The first failed tasks (at most [`Self::MOST_FAILURES`]); all of them were reported as events.
    pub failures: Vec<Failure>,
    /// Failures that belong to no task: a disk that refused, bytes that differ between executions.
    pub diagnostics: Vec<Box<Diagnostic>>,
    /// Processor time of all threads, seconds; `None` where nothing was left to do or the system does not tell.
    pub processor_s: Option<f64>,
    items: Vec<StageItems>,
}

impl StageSummary {
    fn new(name: StageName, endings: &[Ending]) -> Self {
        let count = |ending: Ending| endings.iter().filter(|it| **it == ending).count() as u64;
        Self {
            name,
            total: endings.len() as u64,
            cached: count(Ending::Finished(Work::Cached)),
            ran: count(Ending::Finished(Work::Ran)),
            reused: count(Ending::Finished(Work::Reused)),
            failed: count(Ending::Failed),
            skipped: count(Ending::Skipped),
            unfinished: count(Ending::Cancelled),
            not_needed: count(Ending::NotNeeded),
        }
    }

    /// True where all items that are needed are finished.
    pub fn is_whole(&self) -> bool {
        self.cached + self.ran + self.reused + self.not_needed == self.total
    }
}

impl RunSummary {
    /// Number of failures that are kept in memory.
    pub const MOST_FAILURES: usize = 100;

    /// Summary of `plan`, whose tasks ended as `endings`, by stage and item.
    pub(crate) fn new(plan: Plan<'_>, endings: Vec<Vec<Ending>>) -> Self {
        let described = &plan.recipe.stages;
        let counts = described.iter().zip(&endings).map(|(stage, ends)| StageSummary::new(stage.name.clone(), ends));
        let stages: Vec<StageSummary> = counts.collect();
        let items = described.iter().zip(endings).zip(plan.stages).map(|((stage, endings), planned)| StageItems {
            names: stage.items.clone(),
            connections: stage.connections.clone(),
            endings,
            results: planned.finished,
        });
        let items = items.collect();
        Self {
            outcome: RunOutcome::Complete,
            stages,
            failures: Vec::new(),
            diagnostics: Vec::new(),
            processor_s: None,
            items,
        }
    }

    /// Result of an item; `None` where it is not finished.
    pub fn result(&self, stage: usize, item: usize) -> Option<&Finished> {
        self.items[stage].results[item].as_ref()
    }

    /// Finished items of a stage, in order.
    pub fn finished_items(&self, stage: usize) -> impl Iterator<Item = (&ItemName, &Finished)> {
        let StageItems { names, results, .. } = &self.items[stage];
        names.iter().zip(results).filter_map(|(name, finished)| Some((name, finished.as_ref()?)))
    }

    /// All tasks and how they ended, cached ones as well.
    pub fn ends(&self) -> impl Iterator<Item = (ItemId, TaskEnd)> {
        let tasks = |stage: usize| (0..self.items[stage].names.len()).map(move |item| (stage, item));
        let tasks = (0..self.items.len()).flat_map(tasks);
        tasks.map(|(stage, item)| (self.id(stage, item), self.end(stage, item)))
    }

    /// All items without a usable result.
    pub fn rejections(&self) -> impl Iterator<Item = (ItemId, RejectionReason)> {
        self.ends().filter_map(|(id, end)| match end {
            TaskEnd::Rejected(_, rejection) => Some((id, rejection)),
            _ => None,
        })
    }

    fn id(&self, stage: usize, item: usize) -> ItemId {
        ItemId { stage: self.stages[stage].name.clone(), item: self.items[stage].names[item].clone() }
    }

    fn end(&self, stage: usize, item: usize) -> TaskEnd {
        match (self.items[stage].endings[item], self.reason(stage, item)) {
            (Ending::Finished(work), None) => TaskEnd::Done(work),
            (Ending::Finished(work), Some(reason)) => {
                TaskEnd::Rejected(work, RejectionReason { reason: reason.to_owned(), origin: self.origin(stage, item) })
            }
            (Ending::Failed, _) => TaskEnd::Failed,
            (Ending::Skipped, _) => TaskEnd::Skipped,
            (Ending::Cancelled, _) => TaskEnd::Cancelled,
            (Ending::NotNeeded, _) => TaskEnd::NotNeeded,
        }
    }

    fn reason(&self, stage: usize, item: usize) -> Option<&str> {
        self.items[stage].results[item].as_ref()?.record.produced.rejected.as_deref()
    }

    /// Follows a rejection upstream: an item that reads a rejected one is rejected for that reason alone.
    fn origin(&self, stage: usize, item: usize) -> RejectionOrigin {
        let (mut at_stage, mut at_item) = (stage, item);
        while let Some(arrival) = self.rejected_input(at_stage, at_item) {
            (at_stage, at_item) = (arrival.stage, arrival.item);
        }
        if (at_stage, at_item) == (stage, item) {
            RejectionOrigin::Own
        } else {
            RejectionOrigin::Inherited(self.id(at_stage, at_item))
        }
    }

    /// First rejected item that an item reads at a port that brings it a single one.
    fn rejected_input(&self, stage: usize, item: usize) -> Option<&Arrival> {
        let single = self.items[stage]
            .connections
            .iter()
            .filter(|connection| matches!(connection.port.fan, Fan::Each | Fan::Broadcast));
        let mut inputs = single.flat_map(|connection| connection.arrivals_for(item));
        inputs.find(|arrival| self.reason(arrival.stage, arrival.item).is_some())
    }
}
