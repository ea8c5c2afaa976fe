//! Running a recipe: does what its plan leaves to do, then remembers and summarises.

use crate::options::RunOptions;
use crate::plan::Plan;
use crate::planning::plan_for;
use crate::summary::{Ending, RunOutcome, RunSummary, StageSummary};
use crate::workers::{AfterWork, do_the_rest};
use cosfly_diagnose::Result;
use cosfly_recipe::Recipe;
use cosfly_stage::{RunEvent, Work};
use cosfly_store::{Costs, Store};

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
    let mut plan = plan_for(recipe, store, options.asked)?;
    let stages =
        plan.stages.iter().map(|stage| (stage.name.clone(), stage.items() - stage.not_needed(), stage.cached()));
    report(RunEvent::Planned { stages: stages.collect() });
    let work = if plan.to_run() == 0 { None } else { Some(do_the_rest(&mut plan, store, options, report)?) };
    let remembered = if work.is_some() || !plan.index_is_current { remember(&plan, store) } else { Ok(()) };
    let AfterWork { endings, mut failures, costs, mut diagnostics, stopped } =
        work.unwrap_or_else(|| AfterWork { endings: all_cached(&plan), ..AfterWork::default() });
    diagnostics.extend(remembered.err());
    diagnostics.extend(remember_costs(&plan, &costs, store).err());
    failures.sort_by_key(|failure| recipe.position(failure.id.stage.as_str()));
    let mut summary = RunSummary::new(plan, endings);
    (summary.failures, summary.diagnostics) = (failures, diagnostics);
    summary.outcome = match summary.stages.iter().all(StageSummary::is_whole) && summary.diagnostics.is_empty() {
        _ if stopped => RunOutcome::Cancelled,
        true => RunOutcome::Complete,
        false => RunOutcome::Failed,
    };
    Ok(summary)
}

/// Keeps the measured time of tasks for predictions.
fn remember_costs(plan: &Plan<'_>, costs: &[Costs], store: &Store) -> Result<()> {
    let measured = plan.stages.iter().zip(costs).filter(|(_, costs)| costs.items > 0);
    measured
        .into_iter()
        .try_for_each(|(stage, costs)| store.add_costs(&stage.definition.digest, &stage.kind_and_part(), costs))
}

fn all_cached(plan: &Plan<'_>) -> Vec<Vec<Ending>> {
    let ending = |finished: &Option<_>| finished.as_ref().map_or(Ending::NotNeeded, |_| Ending::Finished(Work::Cached));
    plan.stages.iter().map(|stage| stage.finished.iter().map(ending).collect()).collect()
}

/// Writes the history for `why` and garbage collection, and the index for the next quick start.
fn remember(plan: &Plan<'_>, store: &Store) -> Result<()> {
    store.record_run(&plan.recipe_id, &plan.as_past_run())?;
    let stages = plan.stages.iter().zip(&plan.recipe.stages);
    let entries = stages.flat_map(|(stage, described)| {
        let intermediate = described.stage.properties().intermediate;
        let finished = stage.plans.iter().zip(&stage.finished);
        finished.filter_map(move |(plan, finished)| Some((plan, finished.as_ref()?, intermediate)))
    });
    store.write_index(&plan.recipe_id, &plan.run_digest(), entries)
}
