//! Changes of the ingredients of a key.

use cosfly_diagnose::counted;
use cosfly_fingerprint::Digest;
use cosfly_stage::ItemId;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fmt;

/// A change of one ingredient of a key.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// No run of this recipe is remembered.
    FirstRun,
    /// No remembered run had this stage.
    NewStage,
    /// Earlier runs had the stage, but never finished this item.
    NewItem,
    /// The item was finished, and then its records or blobs went missing or were damaged.
    OutputLost,
    /// A parameter.
    Parameter {
        /// Path below the stage's table, keys joined by dots.
        path: String,
        /// Earlier value; `None` where it was absent.
        old: Option<Value>,
        /// Present value; `None` where it is absent.
        new: Option<Value>,
    },
    /// The seed of the whole recipe.
    RecipeSeed {
        /// Earlier value.
        old: Value,
        /// Present value.
        new: Value,
    },
    /// The content of a source file.
    Source {
        /// Parameter that names the file.
        parameter: String,
        /// Digest of the earlier content; `None` where there was no file.
        old: Option<Digest>,
        /// Digest of the present content; `None` where there is no file.
        new: Option<Digest>,
    },
    /// The kind of the stage (`use`).
    Kind {
        /// Earlier value.
        old: Value,
        /// Present value.
        new: Value,
    },
    /// The version of the stage's kind: this cosfly computes other results from the same inputs.
    KindVersion {
        /// Earlier value.
        old: Value,
        /// Present value.
        new: Value,
    },
    /// The format of the stage's output.
    ArtifactFormat {
        /// Earlier value.
        old: Value,
        /// Present value.
        new: Value,
    },
    /// Other stages are connected to a port.
    Wiring {
        /// Port.
        port: String,
        /// Stages that were connected.
        old: Vec<String>,
        /// Stages that are connected.
        new: Vec<String>,
    },
    /// Items of the connected stages: more, fewer or others; the stages are as before.
    Items {
        /// Port.
        port: String,
        /// Names of items that are at the port now and were not.
        added: Vec<String>,
        /// Names of items that were at the port and are not any more.
        removed: Vec<String>,
    },
    /// Inputs have other keys; the next link of the chain says why.
    Upstream {
        /// First input that changed.
        first: ItemId,
        /// Number of inputs that changed.
        inputs: u64,
    },
    /// The documents of the earlier run were removed by garbage collection.
    Forgotten,
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // A parameter that is left to the stage is null or left out.
        let value = |value: &Option<Value>| match value {
            None | Some(Value::Null) => "its default".to_owned(),
            Some(value) => format!("`{value}`"),
        };
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
            Self::ArtifactFormat { old, new } => write!(f, "the format of its output went from `{old}` to `{new}`"),
            Self::Wiring { port, old, new } => {
                write!(f, "`inputs.{port}` changed from `[{}]` to `[{}]`", old.join(", "), new.join(", "))
            }
            Self::Items { port, added, removed } => {
                write!(f, "at `inputs.{port}`, added: {}, removed: {}", counted(added.len(), "item"), removed.len())
            }
            Self::Upstream { first, inputs: 1 } => write!(f, "its input `{first}` changed"),
            Self::Upstream { first, inputs } => write!(f, "{inputs} of its inputs changed, first `{first}`"),
            Self::Forgotten => write!(f, "garbage collection removed the record of the earlier run"),
        }
    }
}

/// Changes from one definition of a stage to another, as [`crate::PlannedStage::definition_document`] gives them.
pub fn definition_difference(old: &Value, new: &Value) -> Vec<Change> {
    definition_changes(old, &new.to_string())
}

/// Changes as in [`definition_difference`], with the new definition as text.
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

/// Members of two objects by key.
fn members<'v>(
    old: &'v Value,
    new: &'v Value,
) -> impl Iterator<Item = (&'v str, Option<&'v Value>, Option<&'v Value>)> {
    let keys = |value: &'v Value| value.as_object().into_iter().flat_map(|members| members.keys());
    let all: BTreeSet<&str> = keys(old).chain(keys(new)).map(String::as_str).collect();
    all.into_iter().map(|key| (key, old.get(key), new.get(key)))
}
