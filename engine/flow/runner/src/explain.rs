//! `cosfly why`: the ingredient that changed a task's key, followed upstream to where it began.

use crate::document::{PortDocument, StoredInput, StoredPlan};
use crate::plan::{Plan, plan};
use cosfly_diagnose::{Diagnostic, Fault, Result, nearest_name};
use cosfly_fingerprint::Digest;
use cosfly_recipe::{Arrival, Recipe};
use cosfly_store::{PastRun, Store};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// One ingredient of a key that is not what it was.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// No run of this recipe is remembered.
    FirstRun,
    /// No remembered run had this stage.
    NewStage,
    /// Earlier runs had the stage, but never finished this item.
    NewItem,
    /// It was finished, and then its records or blobs went missing or were damaged.
    OutputLost,
    /// A parameter, by its path with dots; `None` where it was absent.
    Parameter {
        /// Path below the stage's table.
        path: String,
        /// What it was.
        old: Option<Value>,
        /// What it is.
        new: Option<Value>,
    },
    /// The seed of the whole recipe.
    RecipeSeed {
        /// What it was.
        old: Value,
        /// What it is.
        new: Value,
    },
    /// The bytes of a source file; `None` where there was none.
    Source {
        /// The parameter that names the file.
        parameter: String,
        /// Digest of what it was.
        old: Option<Digest>,
        /// Digest of what it is.
        new: Option<Digest>,
    },
    /// What the stage uses.
    Kind {
        /// What it was.
        old: Value,
        /// What it is.
        new: Value,
    },
    /// The version of the stage's kind: this cosfly computes something else from the same inputs.
    KindVersion {
        /// What it was.
        old: Value,
        /// What it is.
        new: Value,
    },
    /// The form of what the stage makes.
    ArtifactFormat {
        /// What it was.
        old: Value,
        /// What it is.
        new: Value,
    },
    /// Other stages are connected to a port.
    Wiring {
        /// The port.
        port: String,
        /// Stages that were connected.
        old: Vec<String>,
        /// Stages that are connected.
        new: Vec<String>,
    },
    /// The same stages are connected, with more, fewer or other items.
    Items {
        /// The port.
        port: String,
        /// Items that arrive now and did not.
        added: Vec<String>,
        /// Items that arrived and do not any more.
        removed: Vec<String>,
    },
    /// What it reads has another key; the next link of the chain says why.
    Upstream {
        /// Stage of the first input that changed.
        stage: String,
        /// Its item.
        item: String,
        /// How many inputs changed in all.
        inputs: u64,
    },
    /// The old documents were removed by garbage collection.
    Forgotten,
}

/// One task of a chain and what changed in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Stage name.
    pub stage: String,
    /// Item id.
    pub item: String,
    /// What is not as it was.
    pub changes: Vec<Change>,
}

/// Why a task runs, or ran the last time.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// Stage name.
    pub stage: String,
    /// Item id.
    pub item: String,
    /// Whether it is finished as it is now; then the chain is about the run that made it so.
    pub finished: bool,
    /// The task itself, then upstream to the root cause. Empty when nothing ever changed.
    pub chain: Vec<Link>,
}

/// What changed the key of `stage` (of `item`, or of its first item that is to run).
///
/// # Errors
/// `why-unknown-stage` and `why-unknown-item` with the nearest name, or what planning refused.
pub fn why(recipe: &Recipe, store: &Store, stage: &str, item: Option<&str>) -> Result<Explanation> {
    let plan = plan(recipe, store)?;
    let position = recipe.position(stage).ok_or_else(|| {
        unknown("why-unknown-stage", "stage", stage, recipe.stages.iter().map(|stage| stage.name.as_str()))
    })?;
    let items = &recipe.stages[position].items;
    let index = match item {
        Some(item) => items
            .iter()
            .position(|id| &**id == item)
            .ok_or_else(|| unknown("why-unknown-item", "item", item, items.iter().map(|id| &**id)))?,
        None => plan.stages[position].finished.iter().position(Option::is_none).unwrap_or(0),
    };
    let Some(item) = items.get(index) else {
        return Err(Diagnostic::new("why-unknown-item", Fault::Recipe, format!("stage `{stage}` has no items")));
    };
    let finished = plan.stages[position].finished[index].is_some();
    let chain = match starting_point(&plan, store, position, index, finished) {
        Start::Same => Vec::new(),
        Start::Said(change) => vec![Link { stage: stage.to_owned(), item: item.to_string(), changes: vec![change] }],
        Start::Was(old) => follow(&plan, store, position, index, old),
    };
    Ok(Explanation { stage: stage.to_owned(), item: item.to_string(), finished, chain })
}

fn unknown<'a>(
    code: &'static str,
    what: &str,
    given: &str,
    known: impl Iterator<Item = &'a str> + Clone,
) -> Box<Diagnostic> {
    let diagnostic = Diagnostic::new(code, Fault::Recipe, format!("there is no {what} `{given}`"));
    let names: Vec<&str> = known.clone().take(12).collect();
    match nearest_name(given, known) {
        Some(near) => diagnostic.hint(format!("did you mean `{near}`?")),
        None => diagnostic.hint(format!("known: `{}`", names.join("`, `"))),
    }
}

/// What the history says about a task.
enum Start {
    /// It was never anything else.
    Same,
    /// The whole answer.
    Said(Change),
    /// Its most recent other key.
    Was(Digest),
}

fn starting_point(plan: &Plan<'_>, store: &Store, stage: usize, item: usize, finished: bool) -> Start {
    let now = plan.stages[stage].plans[item];
    let (name, id) = (&plan.recipe.stages[stage].name, &plan.recipe.stages[stage].items[item]);
    let (mut any_run, mut any_stage, mut was_now, mut was_other) = (false, false, false, None);
    for run in store.past_runs(&plan.recipe_id) {
        any_run = true;
        let Some(past) = run.stage(name) else { continue };
        any_stage = true;
        match past.items.get(&**id) {
            Some(digest) if *digest == now => was_now = true,
            Some(digest) => {
                was_other = Some(*digest);
                break;
            }
            None => {}
        }
    }
    let lost = was_now || store.done().is_ok_and(|done| done.binary_search(&now).is_ok());
    match was_other {
        _ if !finished && lost => Start::Said(Change::OutputLost),
        Some(digest) => Start::Was(digest),
        None if finished => Start::Same,
        None if !any_run => Start::Said(Change::FirstRun),
        None if !any_stage => Start::Said(Change::NewStage),
        None => Start::Said(Change::NewItem),
    }
}

/// The chain from a task whose key was `old` to the root cause.
fn follow(plan: &Plan<'_>, store: &Store, mut stage: usize, mut item: usize, mut old: Digest) -> Vec<Link> {
    let mut chain = Vec::new();
    loop {
        let described = &plan.recipe.stages[stage];
        let (changes, next) = compare(plan, store, stage, item, &old);
        chain.push(Link { stage: described.name.clone(), item: described.items[item].to_string(), changes });
        match next {
            // Stages are in dependency order, so this ends.
            Some((upstream, upstream_item, digest)) if upstream < stage => {
                (stage, item, old) = (upstream, upstream_item, digest);
            }
            _ => return chain,
        }
    }
}

/// What differs between a task and its former self, and the upstream task to look at next.
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
        let by_id: BTreeMap<&str, &StoredInput> = before.iter().map(|input| (input.id.as_str(), input)).collect();
        inputs.iter().filter_map(move |(arrival, input)| {
            let old = by_id.get(input.id.as_str()).filter(|old| old.stage == input.stage && old.item == input.item)?;
            (old.plan != input.plan).then_some((arrival.stage, arrival.item, old.plan))
        })
    });
    let next = changed.next();
    if let Some((upstream, upstream_item, _)) = next {
        let described = &plan.recipe.stages[upstream];
        changes.push(Change::Upstream {
            stage: described.name.clone(),
            item: described.items[upstream_item].to_string(),
            inputs: 1 + changed.count() as u64,
        });
    }
    (changes, next)
}

type InputsNow<'p> = BTreeMap<&'static str, Vec<(&'p Arrival, StoredInput)>>;

fn inputs_of<'p>(plan: &'p Plan<'_>, stage: usize, item: usize) -> InputsNow<'p> {
    let described = &plan.recipe.stages[stage];
    let stored = |arrival: &'p Arrival| {
        let upstream = &plan.recipe.stages[arrival.stage];
        let input = StoredInput {
            id: arrival.id.to_string(),
            stage: upstream.name.clone(),
            item: upstream.items[arrival.item].to_string(),
            plan: plan.stages[arrival.stage].plans[arrival.item],
        };
        (arrival, input)
    };
    debug_assert!(plan.stages[stage].ports.iter().map(PortDocument::port).is_sorted());
    described.connections.iter().map(|c| (c.port.name, c.arrivals_for(item).iter().map(stored).collect())).collect()
}

/// What differs between two definitions of one stage, as [`crate::PlannedStage::definition_document`] gives them.
pub fn definition_difference(old: &Value, new: &Value) -> Vec<Change> {
    definition_changes(old, &new.to_string())
}

/// What differs between two definitions of one stage.
pub(crate) fn definition_changes(old: &Value, new_json: &str) -> Vec<Change> {
    let new: Value = serde_json::from_str(new_json).unwrap_or_default();
    let pair = |key: &str| (old[key] != new[key]).then(|| (old[key].clone(), new[key].clone()));
    let mut changes = Vec::new();
    changes.extend(pair("kind").map(|(old, new)| Change::Kind { old, new }));
    changes.extend(pair("version").map(|(old, new)| Change::KindVersion { old, new }));
    changes.extend(pair("artifact").map(|(old, new)| Change::ArtifactFormat { old, new }));
    changes.extend(pair("seed").map(|(old, new)| Change::RecipeSeed { old, new }));
    parameter_changes("", Some(&old["parameters"]), Some(&new["parameters"]), &mut changes);
    let digest = |value: &Value| value.as_str().and_then(|text| text.parse().ok());
    for (parameter, old, new) in members(&old["sources"], &new["sources"]) {
        if old != new {
            let (old, new) = (old.and_then(digest), new.and_then(digest));
            changes.push(Change::Source { parameter: parameter.to_owned(), old, new });
        }
    }
    changes
}

fn parameter_changes(path: &str, old: Option<&Value>, new: Option<&Value>, changes: &mut Vec<Change>) {
    let below = |key: &dyn fmt::Display| if path.is_empty() { key.to_string() } else { format!("{path}.{key}") };
    match (old, new) {
        (old, new) if old == new => {}
        (Some(old @ Value::Object(_)), Some(new @ Value::Object(_))) => {
            members(old, new).for_each(|(key, old, new)| parameter_changes(&below(&key), old, new, changes));
        }
        (Some(Value::Array(old)), Some(Value::Array(new))) if old.len() == new.len() => {
            for (index, (old, new)) in old.iter().zip(new).enumerate() {
                parameter_changes(&below(&index), Some(old), Some(new), changes);
            }
        }
        (old, new) => {
            changes.push(Change::Parameter { path: path.to_owned(), old: old.cloned(), new: new.cloned() });
        }
    }
}

/// The members of two objects by key.
fn members<'v>(
    old: &'v Value,
    new: &'v Value,
) -> impl Iterator<Item = (&'v str, Option<&'v Value>, Option<&'v Value>)> {
    let keys = |value: &'v Value| value.as_object().into_iter().flat_map(|members| members.keys());
    let all: BTreeSet<&str> = keys(old).chain(keys(new)).map(String::as_str).collect();
    all.into_iter().map(|key| (key, old.get(key), new.get(key)))
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
        let ids = |inputs: &mut dyn Iterator<Item = &StoredInput>| -> BTreeSet<String> {
            inputs.map(|input| input.id.clone()).collect()
        };
        let (before, now) = (ids(&mut before.iter()), ids(&mut now.iter().copied()));
        if before != now {
            let added = now.difference(&before).cloned().collect();
            let removed = before.difference(&now).cloned().collect();
            changes.push(Change::Items { port, added, removed });
        }
    }
    changes
}

/// The stages among inputs, each once, in their order.
fn stages_of<'i>(inputs: impl Iterator<Item = &'i StoredInput>) -> Vec<String> {
    let mut stages: Vec<String> = Vec::new();
    for input in inputs {
        if stages.last() != Some(&input.stage) && !stages.contains(&input.stage) {
            stages.push(input.stage.clone());
        }
    }
    stages
}

/// The newest remembered run that has a stage.
pub(crate) fn newest_with_stage(runs: &[PastRun], stage: &str) -> Option<usize> {
    runs.iter().position(|run| run.stage(stage).is_some_and(|stage| !stage.items.is_empty()))
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = |value: &Option<Value>| value.as_ref().map_or("(absent)".to_owned(), |value| format!("`{value}`"));
        let digest = |digest: &Option<Digest>| digest.map_or("(none)".to_owned(), |d| format!("`{}`", d.short()));
        match self {
            Self::FirstRun => write!(f, "this recipe has not run here before"),
            Self::NewStage => write!(f, "the stage is new"),
            Self::NewItem => write!(f, "the item is new"),
            Self::OutputLost => write!(f, "its output is missing from the store, or damaged there"),
            Self::Parameter { path, old, new } => write!(f, "`{path}` changed from {} to {}", value(old), value(new)),
            Self::RecipeSeed { old, new } => write!(f, "the recipe's `seed` changed from `{old}` to `{new}`"),
            Self::Source { parameter, old, new } => {
                write!(f, "the file that `{parameter}` names changed from {} to {}", digest(old), digest(new))
            }
            Self::Kind { old, new } => write!(f, "`use` changed from `{old}` to `{new}`"),
            Self::KindVersion { old, new } => write!(f, "the stage's version went from `{old}` to `{new}`"),
            Self::ArtifactFormat { old, new } => write!(f, "the form of its output went from `{old}` to `{new}`"),
            Self::Wiring { port, old, new } => {
                write!(f, "`inputs.{port}` changed from `[{}]` to `[{}]`", old.join(", "), new.join(", "))
            }
            Self::Items { port, added, removed } => {
                write!(f, "at `inputs.{port}`, {} items came and {} went", added.len(), removed.len())
            }
            Self::Upstream { stage, item, inputs: 1 } => write!(f, "its input `{stage}/{item}` changed"),
            Self::Upstream { stage, item, inputs } => {
                write!(f, "{inputs} of its inputs changed, first `{stage}/{item}`")
            }
            Self::Forgotten => write!(f, "what it was made from has been removed by garbage collection"),
        }
    }
}
