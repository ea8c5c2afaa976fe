//! What a stage declares about itself: ports, items, sources, version. Data, not methods.

use cosfly_diagnose::Diagnostic;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Everything the engine knows about a stage before running it.
#[derive(Clone, Debug)]
pub struct StageProperties {
    /// Kind, such as `map`; with [`Self::version`] part of every key.
    pub kind: String,
    /// Raised by hand whenever the same inputs would give other bytes.
    pub version: u32,
    /// The parameters this stage reads, defaults filled in; part of every key. Nothing else may steer `run`.
    pub parameters: serde_json::Value,
    /// Files outside the store that it reads; their content is part of the key.
    pub sources: Vec<Source>,
    /// Where its inputs come from.
    pub inputs: Vec<InputPort>,
    /// What it makes, as `name/format-version`, such as `town/1`.
    pub artifact: &'static str,
    /// Which items it has.
    pub items: ItemRule,
    /// Rough size of one item's output, for `cosfly plan` before any is made; 0 when it is about as large as what
    /// arrives at its [`Fan::Each`] ports.
    pub bytes_per_item: u64,
}

/// A file that a stage reads from outside the store.
#[derive(Clone, Debug)]
pub struct Source {
    /// Parameter that names the file, such as `source`.
    pub parameter: String,
    /// The path, absolute or relative to the recipe (the recipe reader resolves it).
    pub path: PathBuf,
    /// What is asked of the file before anything runs.
    pub check: Option<SourceCheck>,
}

/// A look into a file while the recipe is read: it may refuse the file, and it tells which parameters the file wants.
#[derive(Clone)]
pub struct SourceCheck {
    /// Parameter that the file itself describes, keys joined by dots, such as `terms.0.params`.
    pub describes: String,
    /// From the file's path to the JSON Schema of that parameter.
    pub read: Arc<ReadSchema>,
    /// Once the parameter fits that schema: whether the file can do what is asked of it.
    pub settle: Option<Arc<Settle>>,
}

/// See [`SourceCheck::read`]. What it refuses is shown at the parameter that names the file.
pub type ReadSchema = dyn Fn(&Path) -> Result<serde_json::Value, Box<Diagnostic>> + Send + Sync;

/// See [`SourceCheck::settle`]. What it refuses is shown at the parameter that names the file.
pub type Settle = dyn Fn(&Path) -> Result<(), Box<Diagnostic>> + Send + Sync;

impl Source {
    /// A file that is taken as it is.
    pub fn new(parameter: impl Into<String>, path: impl Into<PathBuf>) -> Self {
        Self { parameter: parameter.into(), path: path.into(), check: None }
    }
}

impl fmt::Debug for SourceCheck {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SourceCheck").field("describes", &self.describes).finish_non_exhaustive()
    }
}

/// A named input of a stage.
#[derive(Clone, Debug)]
pub struct InputPort {
    /// Name in the recipe's `inputs` table.
    pub name: &'static str,
    /// Artifact it takes, such as `town/1`.
    pub artifact: &'static str,
    /// How its items meet the stage's own items.
    pub fan: Fan,
    /// How many stages it takes, and what it calls their items.
    pub takes: Takes,
    /// Whether the port may be left out.
    pub optional: bool,
    /// Whom it is connected to.
    pub source: PortSource,
    /// One sentence for the reference.
    pub doc: &'static str,
}

/// How many stages a port takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    /// One, whose items keep their ids.
    One,
    /// One or a list. Items are called `<stage>-<item>`, so that adding a second stage renames nothing.
    Named,
    /// One or a list. Items keep their ids, so stages that have items of the same id cannot be connected together.
    Distinct,
}

/// Who connects a port.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PortSource {
    /// The recipe's `inputs` table.
    Recipe,
    /// Another part of the same recipe stage, by its suffix (see [`crate::StagePart`]).
    Sibling(&'static str),
}

/// How the items of an input meet the items of the stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fan {
    /// Item `x` of the input feeds item `x` of the stage.
    Each,
    /// The input's only item feeds every item of the stage.
    Broadcast,
    /// All items of the input feed each item of the stage.
    Gather,
}

/// Which items a stage has; known before anything runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ItemRule {
    /// A single item named `all`.
    One,
    /// `<prefix>00000`, `<prefix>00001` ...: asking for more never renames the old ones.
    Count {
        /// Leads every item id.
        prefix: &'static str,
        /// How many.
        count: u64,
    },
    /// The items of the named [`Fan::Each`] port.
    PerInput(&'static str),
    /// Every item of the named [`Fan::Each`] port once per variant, as `<item>-<variant>`: a new variant renames nothing.
    /// All of them read that item, here and at the [`Fan::Each`] ports of later stages that know it by its own id only.
    PerVariant {
        /// The port.
        port: &'static str,
        /// What is appended, such as `HardRainNoon`; at least one.
        variants: Vec<String>,
    },
}
