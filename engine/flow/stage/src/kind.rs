//! The registry of stage kinds: parameters in, stages out.

use crate::{InputPort, Stage};
use cosfly_diagnose::ParameterError;
use std::collections::BTreeMap;

/// A kind of stage that recipes name with `use = "..."`.
pub trait StageKind: Send + Sync {
    /// Name in recipes (`use = "..."`).
    fn name(&self) -> &'static str;
    /// Description for the reference and `cosfly schema`, one sentence.
    fn doc(&self) -> &'static str;
    /// JSON Schema of the parameters (an object), with descriptions, defaults and ranges. The recipe reader checks
    /// parameters against it and points at the offending place; `build` may rely on that.
    fn schema(&self) -> serde_json::Value;
    /// Every port that a recipe may connect, for any parameters; for editors and the reference. The ports of the built
    /// parts together are a subset of them, apart from ports between siblings.
    fn ports(&self) -> Vec<InputPort>;
    /// Former names of the kind itself and of its inputs, each with the name of today. Former parameters stand in the schema
    /// (`x-gone`).
    fn gone(&self) -> &'static [(&'static str, &'static str)] {
        &[]
    }
    /// Builds the stage, or its parts in dependency order, the stage itself (with the empty suffix) last. Paths go into
    /// [`crate::StageProperties::sources`] as they are written.
    ///
    /// # Errors
    /// Violations of rules between parameters that the schema cannot express.
    fn build(&self, parameters: serde_json::Value) -> Result<Vec<StagePart>, ParameterError>;
}

/// One part of a recipe stage. Most kinds have one, with an empty suffix; `dataset` has `logs` beside it. A part whose
/// required inputs a recipe leaves out is left out as well, where all ports that read it are optional.
pub struct StagePart {
    /// Name of the part; empty for the stage itself (see [`crate::StageName`]).
    pub suffix: &'static str,
    /// Stage that does the work of the part.
    pub stage: Box<dyn Stage>,
}

/// Table `[tool.NAME]` of recipes: settings of a command, which runs do not read.
pub struct Tool {
    /// Name.
    pub name: &'static str,
    /// JSON Schema of the table (an object), with descriptions, defaults and ranges.
    pub schema: serde_json::Value,
}

/// Stage kinds and tools that a binary offers, by name.
#[derive(Default)]
pub struct Registry {
    kinds: BTreeMap<&'static str, Box<dyn StageKind>>,
    tools: Vec<Tool>,
}

impl Registry {
    /// Creates a registry of `kinds`; a later kind replaces an earlier one of the same name.
    pub fn new(kinds: Vec<Box<dyn StageKind>>) -> Self {
        Self { kinds: kinds.into_iter().map(|kind| (kind.name(), kind)).collect(), tools: vec![] }
    }

    /// Registry with the tables of a tool.
    pub fn with_tool(mut self, tool: Tool) -> Self {
        self.tools.push(tool);
        self
    }

    /// All tools.
    pub fn tools(&self) -> &[Tool] {
        &self.tools
    }

    /// Kind called `name`.
    pub fn get(&self, name: &str) -> Option<&dyn StageKind> {
        self.kinds.get(name).map(|kind| &**kind)
    }

    /// All kinds, sorted by name.
    pub fn iter(&self) -> impl Iterator<Item = &dyn StageKind> {
        self.kinds.values().map(|kind| &**kind)
    }
}
