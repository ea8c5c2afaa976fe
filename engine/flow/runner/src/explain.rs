//! `cosfly why`: the ingredient that changed a task's key, followed upstream to where the change began.

use crate::change::{Change, definition_changes};
use crate::document::{PortDocument, StoredInput, StoredPlan};
use crate::plan::Plan;
use crate::planning::plan;
use cosfly_diagnose::{Diagnostic, Fault, Result, nearest_name};
use cosfly_fingerprint::Digest;
use cosfly_recipe::{Arrival, Recipe};
use cosfly_stage::{ItemId, ItemName, StageName};
use cosfly_store::Store;
use std::collections::{BTreeMap, BTreeSet};

/// One task of a chain and its changes.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Item of the task.
    pub id: ItemId,
    /// Changed ingredients of its key.
    pub changes: Vec<Change>,
}

/// Reason why a task runs, or ran the last time.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// Item of the task.
    pub id: ItemId,
    /// False where nothing needs the task: everything that is made of its result is finished.
    pub needed: bool,
    /// True where the task is finished as the recipe is now; the chain is then about the run that finished it.
    pub finished: bool,
    /// The task itself, then upstream to the root cause. Empty where nothing ever changed.
    pub chain: Vec<Link>,
}

/// Explanation of the key of `stage` (of `item`, or of its first item that is to run).
///
/// # Errors
/// `why-unknown-stage` and `why-unknown-item` with the nearest name, or a refusal of planning.
pub fn why(recipe: &Recipe, store: &Store, stage: &str, item: Option<&str>) -> Result<Explanation> {
    let plan = plan(recipe, store)?;
    let position = recipe.position(stage).ok_or_else(|| {
        let names: Vec<&str> = recipe.stages.iter().map(|stage| stage.name.as_str()).collect();
        let problem = Diagnostic::new("why-unknown-stage", Fault::Recipe, format!("the recipe has no stage `{stage}`"));
        with_known(problem, stage, &names)
    })?;
    let items = &recipe.stages[position].items;
    if items.is_empty() {
        return Err(Diagnostic::new("why-unknown-item", Fault::Recipe, format!("stage `{stage}` has no items")));
    }
    let index = match item {
        Some(item) => items.iter().position(|name| name.to_string() == item).ok_or_else(|| {
            let names: Vec<String> = items.iter().map(ToString::to_string).collect();
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let problem =
                Diagnostic::new("why-unknown-item", Fault::Recipe, format!("stage `{stage}` has no item `{item}`"));
            with_known(problem, item, &names)
        })?,
        None => {
            let planned = &plan.stages[position];
            let first = (0..items.len()).find(|item| planned.will_run(*item));
            first.or_else(|| planned.finished.iter().position(Option::is_none)).unwrap_or(0)
        }
    };
    let id = recipe.id(position, index);
    let finished = plan.stages[position].finished[index].is_some();
    let chain = match starting_point(&plan, store, position, index, finished) {
        Start::Same => Vec::new(),
        Start::Known(change) => vec![Link { id: id.clone(), changes: vec![change] }],
        Start::Earlier(key) => follow(&plan, store, position, index, key),
    };
    Ok(Explanation { id, needed: plan.stages[position].needed[index], finished, chain })
}

fn with_known(problem: Box<Diagnostic>, given: &str, known: &[&str]) -> Box<Diagnostic> {
    match nearest_name(given, known.iter().copied()) {
        Some(near) => problem.hint(format!("did you mean `{near}`?")),
        None => problem.hint(format!("known: `{}`", known.iter().take(12).copied().collect::<Vec<_>>().join("`, `"))),
    }
}

/// Beginning of an explanation, from the history of a task.
enum Start {
    /// The task never had another key.
    Same,
    /// The whole answer.
    Known(Change),
    /// Its most recent other key.
    Earlier(Digest),
}

fn starting_point(plan: &Plan<'_>, store: &Store, stage: usize, item: usize, finished: bool) -> Start {
    let now = plan.stages[stage].plans[item];
    let (name, text) = (&plan.recipe.stages[stage].name, plan.recipe.stages[stage].items[item].to_string());
    let (mut any_run, mut any_stage, mut was_now, mut earlier) = (false, false, false, None);
    for run in store.past_runs(&plan.recipe_id) {
        any_run = true;
        let Some(past) = run.stage(name.as_str()) else { continue };
        any_stage = true;
        match past.items.get(&text) {
            Some(digest) if *digest == now => was_now = true,
            Some(digest) => {
                earlier = Some(*digest);
                break;
            }
            None => {}
        }
    }
    match earlier {
        _ if !finished && (was_now || store.was_finished(&now)) => Start::Known(Change::OutputLost),
        Some(digest) => Start::Earlier(digest),
        None if finished => Start::Same,
        None if !any_run => Start::Known(Change::FirstRun),
        None if !any_stage => Start::Known(Change::NewStage),
        None => Start::Known(Change::NewItem),
    }
}

/// Chain from a task whose key was `old` to the root cause.
fn follow(plan: &Plan<'_>, store: &Store, mut stage: usize, mut item: usize, mut old: Digest) -> Vec<Link> {
    let mut chain = Vec::new();
    loop {
        let (changes, next) = compare(plan, store, stage, item, &old);
        chain.push(Link { id: plan.recipe.id(stage, item), changes });
        match next {
            // Stages are in dependency order, so this ends.
            Some((upstream, upstream_item, digest)) if upstream < stage => {
                (stage, item, old) = (upstream, upstream_item, digest);
            }
            _ => return chain,
        }
    }
}

/// Changes between a task and its former self, and the upstream task to look at next with its former key.
fn compare(
    plan: &Plan<'_>,
    store: &Store,
    stage: usize,
    item: usize,
    old: &Digest,
) -> (Vec<Change>, Option<(usize, usize, Digest)>) {
    let before = StoredPlan::read(old, |digest| store.document(digest));
    let Some(before) = before else { return (vec![Change::Forgotten], None) };
    let mut changes = match store.document(&before.definition) {
        Some(definition) => definition_changes(&definition, &plan.stages[stage].definition.json),
        None => vec![Change::Forgotten],
    };
    let now = inputs_of(plan, stage, item);
    changes.extend(wiring_changes(&before.inputs, &now));
    let mut changed = now.iter().flat_map(|(port, inputs)| {
        let before = before.inputs.get(*port).map_or(&[][..], Vec::as_slice);
        let by_name: BTreeMap<&ItemName, &StoredInput> = before.iter().map(|input| (&input.name, input)).collect();
        inputs.iter().filter_map(move |(arrival, input)| {
            let is_same = |old: &&&StoredInput| old.stage == input.stage && old.item == input.item;
            let old = by_name.get(&input.name).filter(is_same)?;
            (old.plan != input.plan).then_some((arrival.stage, arrival.item, old.plan))
        })
    });
    let next = changed.next();
    if let Some((upstream, upstream_item, _)) = next {
        let inputs = 1 + changed.count() as u64;
        changes.push(Change::Upstream { first: plan.recipe.id(upstream, upstream_item), inputs });
    }
    (changes, next)
}

type InputsNow<'p> = BTreeMap<&'static str, Vec<(&'p Arrival, StoredInput)>>;

fn inputs_of<'p>(plan: &'p Plan<'_>, stage: usize, item: usize) -> InputsNow<'p> {
    let described = &plan.recipe.stages[stage];
    let stored = |arrival: &'p Arrival| {
        let upstream = &plan.recipe.stages[arrival.stage];
        let input = StoredInput {
            name: arrival.name.clone(),
            stage: upstream.name.clone(),
            item: upstream.items[arrival.item].clone(),
            plan: plan.stages[arrival.stage].plans[arrival.item],
        };
        (arrival, input)
    };
    debug_assert!(plan.stages[stage].ports.iter().map(PortDocument::port).is_sorted());
    described.connections.iter().map(|c| (c.port.name, c.arrivals_for(item).iter().map(stored).collect())).collect()
}

fn wiring_changes(old: &BTreeMap<String, Vec<StoredInput>>, new: &InputsNow<'_>) -> Vec<Change> {
    let ports: BTreeSet<&str> = old.keys().map(String::as_str).chain(new.keys().copied()).collect();
    let mut changes = Vec::new();
    for port in ports {
        let before = old.get(port).map_or(&[][..], Vec::as_slice);
        let now: Vec<&StoredInput> = new.get(port).into_iter().flatten().map(|(_, input)| input).collect();
        let (old, new) = (stages_of(before.iter()), stages_of(now.iter().copied()));
        let port = port.to_owned();
        if old != new {
            changes.push(Change::Wiring { port, old, new });
            continue;
        }
        let names = |inputs: &mut dyn Iterator<Item = &StoredInput>| -> BTreeSet<String> {
            inputs.map(|input| input.name.to_string()).collect()
        };
        let (before, now) = (names(&mut before.iter()), names(&mut now.iter().copied()));
        if before != now {
            let added = now.difference(&before).cloned().collect();
            let removed = before.difference(&now).cloned().collect();
            changes.push(Change::Items { port, added, removed });
        }
    }
    changes
}

/// Stages of `inputs`, each once, in their order.
fn stages_of<'i>(inputs: impl Iterator<Item = &'i StoredInput>) -> Vec<String> {
    let mut stages: Vec<&StageName> = Vec::new();
    for input in inputs {
        if stages.last() != Some(&&input.stage) && !stages.contains(&&input.stage) {
            stages.push(&input.stage);
        }
    }
    stages.into_iter().map(StageName::to_string).collect()
}
