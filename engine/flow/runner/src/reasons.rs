//! Reasons why the items of a stage will run, found for many items at once.

use crate::change::{Change, definition_changes};
use crate::plan::{Plan, PlannedStage};
use crate::reason::Reason;
use cosfly_recipe::{Arrival, RecipeStage};
use cosfly_store::{PastRun, PastStage, Store};

/// Fills in the reasons of every stage that has items to run.
pub(crate) fn give_reasons(plan: &mut Plan<'_>, store: &Store) {
    if plan.to_run() == 0 {
        return;
    }
    let mut history = History { loaded: Vec::new(), more: store.past_runs(&plan.recipe_id) };
    for stage in 0..plan.stages.len() {
        if plan.stages[stage].to_run() > 0 {
            plan.stages[stage].reasons = reasons_of(plan, store, &mut history, stage);
        }
    }
}

/// Remembered runs, newest first, loaded as far as they are needed: mostly one.
struct History<I> {
    loaded: Vec<PastRun>,
    more: I,
}

impl<I: Iterator<Item = PastRun>> History<I> {
    /// Newest run with finished items of a stage, and that stage.
    fn newest_with(&mut self, stage: &str) -> Option<(&PastRun, &PastStage)> {
        let has_items = |run: &PastRun| run.stage(stage).is_some_and(|stage| !stage.items.is_empty());
        let mut position = self.loaded.iter().position(has_items);
        while position.is_none() {
            let next = self.more.next()?;
            position = has_items(&next).then_some(self.loaded.len());
            self.loaded.push(next);
        }
        let run = self.loaded.get(position?)?;
        Some((run, run.stage(stage)?))
    }

    fn is_empty(&self) -> bool {
        self.loaded.is_empty()
    }
}

fn reasons_of(
    plan: &Plan<'_>,
    store: &Store,
    history: &mut History<impl Iterator<Item = PastRun>>,
    stage: usize,
) -> Vec<(Reason, u64)> {
    let planned = &plan.stages[stage];
    let Some((run, past)) = history.newest_with(planned.name.as_str()) else {
        let change = if history.is_empty() { Change::FirstRun } else { Change::NewStage };
        return vec![(Reason::Changed(vec![change]), planned.to_run())];
    };
    let definition = definition_reason(planned, past, store);
    let mut reasons: Vec<(Reason, u64)> = Vec::new();
    for item in (0..planned.plans.len()).filter(|item| planned.will_run(*item)) {
        let reason = item_reason(plan, run, past, stage, item, definition.as_ref());
        match reasons.iter_mut().find(|(known, _)| *known == reason) {
            Some((_, count)) => *count += 1,
            None => reasons.push((reason, 1)),
        }
    }
    reasons
}

/// Reason that all items share: a change of the stage's definition.
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
    match past.items.get(&described.items[item].to_string()) {
        None => return Reason::Changed(vec![Change::NewItem]),
        Some(digest) if *digest == plan.stages[stage].plans[item] => {
            return Reason::Changed(vec![Change::OutputLost]);
        }
        Some(_) => {}
    }
    if let Some(reason) = definition {
        return reason.clone();
    }
    let upstreams = changed_upstreams(plan, run, described, item);
    if upstreams.is_empty() { Reason::Wiring } else { Reason::Upstream(upstreams) }
}

/// Names of the stages of which an item reads items with other keys than in `run`.
fn changed_upstreams(plan: &Plan<'_>, run: &PastRun, described: &RecipeStage, item: usize) -> Vec<String> {
    let mut changed: Vec<String> = Vec::new();
    for connection in &described.connections {
        // Arrivals are sorted by stage.
        for arrivals in connection.arrivals_for(item).chunk_by(|a, b| a.stage == b.stage) {
            let upstream = &plan.recipe.stages[arrivals[0].stage];
            let past = run.stage(upstream.name.as_str());
            let is_other = |arrival: &Arrival| {
                let before = past.and_then(|stage| stage.items.get(&upstream.items[arrival.item].to_string()));
                before != Some(&plan.stages[arrival.stage].plans[arrival.item])
            };
            if !changed.iter().any(|known| upstream.name == **known) && arrivals.iter().any(is_other) {
                changed.push(upstream.name.to_string());
            }
        }
    }
    changed
}
