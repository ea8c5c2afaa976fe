//! The registry of stage kinds: parameters in, stages out.

use crate::{InputPort, Stage};
use std::collections::BTreeMap;

/// A kind of stage that recipes name with `use = "..."`.
pub trait StageKind: Send + Sync {
    /// The name in recipes.
    fn name(&self) -> &'static str;
    /// One sentence for the reference and `cosfly schema`.
    fn doc(&self) -> &'static str;
    /// JSON Schema of its parameters (an object), with docs, defaults and ranges. The recipe reader
    /// checks parameters against it and points at the offending place; `build` may rely on that.
    fn schema(&self) -> serde_json::Value;
    /// Every port that a recipe may connect, whatever the parameters say; for editors and the reference.
    /// What `build` declares is a subset of it (all parts together, ports between siblings left out).
    fn ports(&self) -> Vec<InputPort>;
    /// Builds the stage, or its parts in dependency order, the last one under the empty suffix.
    /// `recipe_dir` is not needed here: paths go into [`crate::StageProperties::sources`] as written.
    fn build(&self, parameters: serde_json::Value) -> Result<Vec<StagePart>, ParameterError>;
}

/// One part of a recipe stage. Most kinds have one, with an empty suffix; `dataset` also has `logs`.
pub struct StagePart {
    /// Appended to the recipe's stage name as `.suffix`; empty for the stage itself.
    pub suffix: &'static str,
    /// The part.
    pub stage: Box<dyn Stage>,
}

/// A rule between parameters that the schema cannot say.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParameterError {
    /// Keys from the stage's table to the offending value, such as `["speed", "min_mps"]`.
    pub path: Vec<String>,
    /// The value and the violated rule, in the words of a diagnostic message.
    pub message: String,
    /// What to do.
    pub hint: Option<String>,
}

/// The sorted list of stage kinds a binary offers.
#[derive(Default)]
pub struct Registry {
    kinds: BTreeMap<&'static str, Box<dyn StageKind>>,
}

impl Registry {
    /// A registry of `kinds`; a later one of the same name replaces an earlier one.
    pub fn new(kinds: Vec<Box<dyn StageKind>>) -> Self {
        Self { kinds: kinds.into_iter().map(|kind| (kind.name(), kind)).collect() }
    }

    /// The kind called `name`.
    pub fn get(&self, name: &str) -> Option<&dyn StageKind> {
        self.kinds.get(name).map(|kind| &**kind)
    }

    /// All kinds, sorted by name.
    pub fn iter(&self) -> impl Iterator<Item = &dyn StageKind> {
        self.kinds.values().map(|kind| &**kind)
    }
}
