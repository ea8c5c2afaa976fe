//! What a run came to.

use crate::plan::Plan;
use cosfly_diagnose::Diagnostic;
use cosfly_recipe::ItemIds;
use cosfly_stage::{Artifact, Produced};
use cosfly_store::Finished;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunOutcome {
    /// Every item of every stage is finished.
    Complete,
    /// Something failed; see [`RunSummary::failures`] and [`RunSummary::diagnostics`].
    Failed,
    /// The run was asked to stop. What is finished stays finished.
    Cancelled,
}

/// A task that failed.
#[derive(Clone, Debug)]
pub struct Failure {
    /// Stage name.
    pub stage: String,
    /// Item id.
    pub item: String,
    /// Why.
    pub diagnostic: Box<Diagnostic>,
}

/// Counts of one stage.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StageSummary {
    /// Stage name.
    pub name: String,
    /// Items it has.
    pub total: u64,
    /// Finished before the run, or by another process during it.
    pub cached: u64,
    /// Computed in this run.
    pub ran: u64,
    /// Not computed, because their inputs turned out to be those of an earlier run.
    pub reused: u64,
    /// Failed.
    pub failed: u64,
    /// Not tried, because something they read failed.
    pub skipped: u64,
    /// Not tried or abandoned, because the run stopped.
    pub unfinished: u64,
}

/// What a run came to, with what every item made.
pub struct RunSummary {
    /// How it ended.
    pub outcome: RunOutcome,
    /// In the recipe's order.
    pub stages: Vec<StageSummary>,
    /// The first failed tasks (at most [`Self::MOST_FAILURES`]); all of them were reported as events.
    pub failures: Vec<Failure>,
    /// What went wrong without a task failing: a disk that refused, bytes that differ between executions.
    pub diagnostics: Vec<Box<Diagnostic>>,
    items: Vec<ItemIds>,
    finished: Vec<Vec<Option<Finished>>>,
}

impl RunSummary {
    /// How many failures are kept in memory.
    pub const MOST_FAILURES: usize = 100;

    pub(crate) fn new(plan: Plan<'_>, outcome: RunOutcome, stages: Vec<StageSummary>) -> Self {
        Self {
            outcome,
            stages,
            failures: Vec::new(),
            diagnostics: Vec::new(),
            items: plan.recipe.stages.iter().map(|stage| stage.items.clone()).collect(),
            finished: plan.stages.into_iter().map(|stage| stage.finished).collect(),
        }
    }

    /// What an item made, under the name of its own stage; nothing when it is not finished.
    pub fn artifact(&self, stage: &str, item: &str) -> Option<Artifact> {
        self.finished_items(stage).find(|(id, _)| *id == item).map(|(_, finished)| Artifact {
            stage: stage.to_owned(),
            item: item.to_owned(),
            blobs: finished.record.outputs.clone(),
        })
    }

    /// The finished items of a stage, in order.
    pub fn finished_items(&self, stage: &str) -> impl Iterator<Item = (&str, &Finished)> {
        let position = self.stages.iter().position(|summary| summary.name == stage);
        position.into_iter().flat_map(|position| {
            let items = self.items[position].iter().zip(&self.finished[position]);
            items.filter_map(|(item, finished)| Some((&**item, finished.as_ref()?)))
        })
    }

    /// What the items of all stages said beside their blobs, cached ones too: (stage, item, produced).
    pub fn produced(&self) -> impl Iterator<Item = (&str, &str, &Produced)> {
        self.stages.iter().flat_map(|stage| {
            self.finished_items(&stage.name)
                .map(|(item, finished)| (stage.name.as_str(), item, &finished.record.produced))
        })
    }

    /// All warnings: (stage, item, warning).
    pub fn warnings(&self) -> impl Iterator<Item = (&str, &str, &str)> {
        self.produced().flat_map(|(stage, item, produced)| {
            produced.warnings.iter().map(move |warning| (stage, item, warning.as_str()))
        })
    }

    /// All items that hold no usable result: (stage, item, reason).
    pub fn rejected(&self) -> impl Iterator<Item = (&str, &str, &str)> {
        self.produced().filter_map(|(stage, item, produced)| Some((stage, item, produced.rejected.as_deref()?)))
    }
}
