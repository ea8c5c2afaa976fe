//! Why the items of a stage will run, in few words for many items.

use crate::explain::{Change, definition_changes, newest_with_stage};
use crate::plan::{Plan, PlannedStage};
use cosfly_recipe::RecipeStage;
use cosfly_store::{PastRun, PastStage, Store};
use std::fmt;

/// Why some items of a stage will run.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason {
    /// Something about the items themselves or the stage as a whole.
    Changed(Vec<Change>),
    /// What they read will be made anew by these stages.
    Upstream(Vec<String>),
    /// Other inputs are connected.
    Wiring,
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Changed(changes) => changes.iter().enumerate().try_for_each(|(index, change)| {
                f.write_str(if index == 0 { "" } else { "; " })?;
                change.fmt(f)
            }),
            Self::Upstream(stages) => write!(f, "what `{}` makes for it changed", stages.join("`, `")),
            Self::Wiring => write!(f, "other inputs are connected"),
        }
    }
}

/// Fills in the reasons of every stage that has items to run.
pub(crate) fn give_reasons(plan: &mut Plan<'_>, store: &Store) {
    if plan.to_run() == 0 {
        return;
    }
    let runs: Vec<PastRun> = store.past_runs(&plan.recipe_id).collect();
    for stage in 0..plan.stages.len() {
        if plan.stages[stage].to_run() > 0 {
            plan.stages[stage].reasons = reasons_of(plan, store, &runs, stage);
        }
    }
}

fn reasons_of(plan: &Plan<'_>, store: &Store, runs: &[PastRun], stage: usize) -> Vec<(Reason, u64)> {
    let planned = &plan.stages[stage];
    let all = |change| vec![(Reason::Changed(vec![change]), planned.to_run())];
    let Some(past) = newest_with_stage(runs, &planned.name) else {
        return all(if runs.is_empty() { Change::FirstRun } else { Change::NewStage });
    };
    let run = &runs[past];
    let Some(past) = run.stage(&planned.name) else { return all(Change::NewStage) };
    let definition = definition_reason(planned, past, store);
    let mut reasons: Vec<(Reason, u64)> = Vec::new();
    for item in (0..planned.plans.len()).filter(|item| planned.finished[*item].is_none()) {
        let reason = item_reason(plan, run, past, stage, item, definition.as_ref());
        match reasons.iter_mut().find(|(known, _)| *known == reason) {
            Some((_, count)) => *count += 1,
            None => reasons.push((reason, 1)),
        }
    }
    reasons
}

/// What changed for all items alike.
fn definition_reason(planned: &PlannedStage, past: &PastStage, store: &Store) -> Option<Reason> {
    if past.definition == planned.definition.digest {
        return None;
    }
    Some(Reason::Changed(match store.document(&past.definition) {
        Some(old) => definition_changes(&old, &planned.definition.json),
        None => vec![Change::Forgotten],
    }))
}

fn item_reason(
    plan: &Plan<'_>,
    run: &PastRun,
    past: &PastStage,
    stage: usize,
    item: usize,
    definition: Option<&Reason>,
) -> Reason {
    let described: &RecipeStage = &plan.recipe.stages[stage];
    match past.items.get(&*described.items[item]) {
        None => return Reason::Changed(vec![Change::NewItem]),
        Some(digest) if *digest == plan.stages[stage].plans[item] => {
            return Reason::Changed(vec![Change::OutputLost]);
        }
        Some(_) => {}
    }
    if let Some(reason) = definition {
        return reason.clone();
    }
    let mut upstreams: Vec<String> = Vec::new();
    for connection in &described.connections {
        for upstream in &connection.upstreams {
            let name = &plan.recipe.stages[*upstream].name;
            let changed = connection.arrivals_for(item).iter().filter(|a| a.stage == *upstream).any(|arrival| {
                let id = &*plan.recipe.stages[arrival.stage].items[arrival.item];
                let before = run.stage(name).and_then(|stage| stage.items.get(id));
                before != Some(&plan.stages[arrival.stage].plans[arrival.item])
            });
            if changed && !upstreams.contains(name) {
                upstreams.push(name.clone());
            }
        }
    }
    if upstreams.is_empty() { Reason::Wiring } else { Reason::Upstream(upstreams) }
}
