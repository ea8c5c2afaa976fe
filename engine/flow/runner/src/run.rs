//! Running a recipe: does what its plan leaves to do, then remembers and summarises.

use crate::options::RunOptions;
use crate::plan::Plan;
use crate::planning::plan_for;
use crate::summary::{Ending, RunOutcome, RunSummary, StageSummary};
use crate::workers::{AfterWork, do_the_rest};
use cosfly_diagnose::Result;
use cosfly_recipe::Recipe;
use cosfly_stage::{ItemName, RunEvent, Work};
use cosfly_store::{Costs, Finished, IndexedTask, Store};

/// Plans and runs a recipe.
///
/// # Errors
/// Only failures that keep a run from starting; all others are in the summary.
pub fn run(
    recipe: &Recipe,
    store: &Store,
    options: &RunOptions,
    report: &(dyn Fn(RunEvent) + Sync),
) -> Result<RunSummary> {
    let ran = work(recipe, store, options, report)?;
    let remembered = ran.remember(store);
    Ok(ran.summary(remembered, store))
}

/// A run whose tasks have ended.
pub(crate) struct Ran<'r> {
    plan: Plan<'r>,
    /// Whether tasks were left to do.
    has_worked: bool,
    after: AfterWork,
}

/// Plans a recipe and does what is left to do.
pub(crate) fn work<'r>(
    recipe: &'r Recipe,
    store: &Store,
    options: &RunOptions,
    report: &(dyn Fn(RunEvent) + Sync),
) -> Result<Ran<'r>> {
    let mut plan = plan_for(recipe, store, options.asked)?;
    let stages =
        plan.stages.iter().map(|stage| (stage.name.clone(), stage.items() - stage.not_needed(), stage.cached()));
    report(RunEvent::Planned { stages: stages.collect() });
    let has_worked = plan.to_run() > 0;
    let after = match has_worked {
        true => do_the_rest(&mut plan, store, options, report)?,
        false => AfterWork { endings: all_cached(&plan), ..AfterWork::default() },
    };
    Ok(Ran { plan, has_worked, after })
}

impl Ran<'_> {
    /// Items of a stage and their results; `None` where the run was stopped or an item is not finished.
    pub(crate) fn whole_stage(&self, stage: usize) -> Option<Vec<(&ItemName, &Finished)>> {
        let names = self.plan.recipe.stages[stage].items.iter();
        let results = names.zip(&self.plan.stages[stage].finished);
        let items: Option<Vec<_>> = results.map(|(name, finished)| Some((name, finished.as_ref()?))).collect();
        items.filter(|items| !items.is_empty() && !self.after.stopped)
    }

    /// Writes the history for `why` and garbage collection, and the index for the next quick start.
    pub(crate) fn remember(&self, store: &Store) -> Result<()> {
        let plan = &self.plan;
        if !self.has_worked && plan.index_is_current {
            return Ok(());
        }
        store.record_run(&plan.recipe_id, &plan.as_past_run())?;
        let stages = plan.stages.iter().zip(&plan.recipe.stages);
        let tasks = stages.flat_map(|(stage, described)| {
            let removable = described.stage.properties().intermediate;
            let finished = stage.plans.iter().zip(&stage.finished).zip(&stage.was_whole);
            finished.filter_map(move |((plan, finished), was_whole)| {
                Some(IndexedTask { plan, finished: finished.as_ref()?, removable, was_whole: *was_whole })
            })
        });
        store.write_index(&plan.recipe_id, &plan.run_digest(), &plan.folders, tasks)
    }

    /// Summary of the run.
    pub(crate) fn summary(self, remembered: Result<()>, store: &Store) -> RunSummary {
        let Self { plan, after, .. } = self;
        let AfterWork { endings, mut failures, costs, processor_s, mut diagnostics, stopped } = after;
        diagnostics.extend(remembered.err());
        diagnostics.extend(remember_costs(&plan, &costs, processor_s, store).err());
        failures.sort_by_key(|failure| plan.recipe.position(failure.id.stage.as_str()));
        let mut summary = RunSummary::new(plan, endings);
        (summary.failures, summary.diagnostics, summary.processor_s) = (failures, diagnostics, processor_s);
        summary.outcome = match summary.stages.iter().all(StageSummary::is_whole) && summary.diagnostics.is_empty() {
            _ if stopped => RunOutcome::Cancelled,
            true => RunOutcome::Complete,
            false => RunOutcome::Failed,
        };
        summary
    }
}

/// Keeps the measured time of tasks for predictions: processor time, by each task's part of the clock's. Beside other work, and where
/// a stage computes on several threads, the clock tells more or less than a core needs.
fn remember_costs(plan: &Plan<'_>, costs: &[Costs], processor_s: Option<f64>, store: &Store) -> Result<()> {
    let clock_s: f64 = costs.iter().map(|costs| costs.seconds).sum();
    let share = processor_s.filter(|_| clock_s > 0.0).map_or(1.0, |processor_s| processor_s / clock_s);
    let measured = plan.stages.iter().zip(costs).filter(|(_, costs)| costs.items > 0);
    measured.into_iter().try_for_each(|(stage, costs)| {
        let costs = Costs { seconds: share * costs.seconds, ..*costs };
        store.add_costs(&stage.definition.digest, &stage.kind_and_part(), &costs)
    })
}

fn all_cached(plan: &Plan<'_>) -> Vec<Vec<Ending>> {
    let ending = |finished: &Option<_>| finished.as_ref().map_or(Ending::NotNeeded, |_| Ending::Finished(Work::Cached));
    plan.stages.iter().map(|stage| stage.finished.iter().map(ending).collect()).collect()
}
