//! Declaration of a stage: ports, items, sources, version. Data, not methods.

use crate::{Asks, ItemName};
use cosfly_diagnose::Diagnostic;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Declaration of a stage, known to the engine before the stage runs.
#[derive(Clone, Debug)]
pub struct StageProperties {
    /// Kind, such as `map`; part of every key, together with [`Self::version`].
    pub kind: String,
    /// Version of the kind, raised by hand whenever the same inputs would give other bytes.
    pub version: u32,
    /// Parameters that the stage reads, with defaults filled in; part of every key. Nothing else may influence `run`.
    pub parameters: serde_json::Value,
    /// Files outside the store that the stage reads; their content is part of the key.
    pub sources: Vec<Source>,
    /// Ports through which the stage reads other stages.
    pub inputs: Vec<InputPort>,
    /// Kind of the output, as `name/format-version`, such as `town/1`.
    pub artifact: &'static str,
    /// Rule that defines the items.
    pub items: ItemRule,
    /// Estimated size of one item's output, bytes, for `cosfly plan` before any item is made; where this and the two below are 0, it is
    /// about as large as the items that arrive with it at [`Fan::Each`] and [`Fan::Group`] ports.
    pub bytes_per_item: u64,
    /// Estimated size of one item's output for each of its frames, bytes, on top of [`Self::bytes_per_item`].
    pub bytes_per_frame: u64,
    /// Estimated size of one item's output for each of its seconds, bytes, on top of the others.
    pub bytes_per_s: u64,
    /// Length of one item where the stage itself sets it; without it, items are as long as those that they are made of.
    pub length: Option<ItemLength>,
    /// Estimated number of blobs of one item that no other item made, for `cosfly plan` before any item is made.
    pub files_per_item: u64,
    /// Blobs that only other stages need: they may be removed once everything that reads them is finished. A reader that
    /// needs a removed blob has the item made again.
    pub intermediate: &'static [&'static str],
    /// Requests that an item may send to a service outside, for `cosfly plan`.
    pub asks: Option<Asks>,
    /// Name that a dataset has for what the stage makes of an item, such as a table; a port that gathers extras takes each name once an
    /// item. Not part of the key.
    pub gives: Option<String>,
    /// Needs of the stage from those that it reads; not part of the key.
    pub needs: Vec<StageNeed>,
    /// Role of the stage; not part of the key.
    pub role: StageRole,
    /// Resources of one item, for engines on other machines; not part of the key.
    pub resources: Resources,
}

impl StageProperties {
    /// A stage of a kind that gives artifacts of a kind: version 1, one item of one blob, no parameters, sources or inputs.
    pub fn new(kind: &str, role: StageRole, artifact: &'static str) -> Self {
        Self {
            kind: kind.to_owned(),
            version: 1,
            parameters: serde_json::json!({}),
            sources: vec![],
            inputs: vec![],
            artifact,
            items: ItemRule::One,
            bytes_per_item: 0,
            bytes_per_frame: 0,
            bytes_per_s: 0,
            length: None,
            files_per_item: 1,
            intermediate: &[],
            asks: None,
            gives: None,
            needs: vec![],
            role,
            resources: Resources::default(),
        }
    }
}

/// Length of an item that is a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ItemLength {
    /// Number of frames.
    pub frames: u64,
    /// Duration, seconds.
    pub duration_s: f64,
}

impl ItemLength {
    /// Frames, `dt_s` seconds apart.
    pub fn new(frames: u32, dt_s: f64) -> Self {
        Self { frames: frames.into(), duration_s: f64::from(frames) * dt_s }
    }

    /// Several of this length, one after the other.
    pub fn times(self, count: usize) -> Self {
        Self { frames: self.frames.saturating_mul(count as u64), duration_s: self.duration_s * count as f64 }
    }
}

/// Need of a parameter from the stages at a port: checked with the recipe, before anything is made.
#[derive(Clone, Debug, PartialEq)]
pub enum StageNeed {
    /// Some item at the port is a variant of this name.
    Variant {
        /// The parameter, keys joined by dots.
        parameter: String,
        /// The port.
        port: &'static str,
        /// Name of the variant.
        name: String,
    },
    /// A number is less than some times a number that stages have as a parameter: those at the port, and all that they read.
    LessThan {
        /// The parameter, keys joined by dots.
        parameter: String,
        /// Its number.
        number: f64,
        /// The port.
        port: &'static str,
        /// Parameter of those stages.
        other: &'static str,
        /// How many times theirs the number has to stay below.
        times: f64,
    },
}

/// Role of a stage in a recipe: other tools find stages by it, never by the names of kinds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StageRole {
    /// Makes the world, or bodies that move in it.
    World,
    /// Plans flights.
    Plans,
    /// Changes, judges or labels artifacts: its output is of the kind that it reads at a [`Fan::Each`] port.
    Changes,
    /// Makes pictures of flights.
    Films,
    /// Makes texts, tables or files about flights.
    Speaks,
    /// Publishes the result of a recipe.
    Publishes,
    /// Serves the other parts of its stage only.
    Serves,
}

/// Resources of one item, as measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resources {
    /// Memory, MiB.
    pub memory_mib: u64,
    /// Items that share a command: starting one costs about as much as 20 cheap items.
    pub batch: u32,
}

impl Default for Resources {
    fn default() -> Self {
        Self { memory_mib: 1024, batch: 1 }
    }
}

/// A file that a stage reads from outside the store.
#[derive(Clone, Debug)]
pub struct Source {
    /// Parameter that names the file, such as `source`.
    pub parameter: String,
    /// Path of the file, absolute or relative to the recipe's folder (the recipe reader resolves it).
    pub path: PathBuf,
    /// Check of the file before any stage runs.
    pub check: Option<SourceCheck>,
}

/// Check of a file while the recipe is read: it may reject the file, and gives the schema of the parameters that the
/// file takes.
#[derive(Clone)]
pub struct SourceCheck {
    /// Parameter that the file itself describes, keys joined by dots, such as `terms.0.params`; empty for all parameters.
    pub describes: String,
    /// Function from the file's path to the JSON Schema of that parameter.
    pub read: Arc<ReadSchema>,
    /// Function that decides, once the parameter fits that schema, whether the file can do what the parameters request.
    pub settle: Option<Arc<Settle>>,
}

/// Type of [`SourceCheck::read`]. An error is shown at the parameter that names the file.
pub type ReadSchema = dyn Fn(&Path) -> Result<serde_json::Value, Box<Diagnostic>> + Send + Sync;

/// Type of [`SourceCheck::settle`]. An error is shown at the parameter that names the file.
pub type Settle = dyn Fn(&Path) -> Result<(), Box<Diagnostic>> + Send + Sync;

impl Source {
    /// A source without a check.
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
    /// Kind of artifact that it takes, such as `town/1`.
    pub artifact: &'static str,
    /// Relation of its items to the stage's own items.
    pub fan: Fan,
    /// Number of stages that the port takes, and the names of their items.
    pub takes: Takes,
    /// Whether the port may be left unconnected.
    pub optional: bool,
    /// Origin of its input.
    pub source: PortSource,
    /// Blobs that the stage sees at the port, and that its key depends on.
    pub sees: Sees,
    /// Description for the reference, one sentence.
    pub doc: &'static str,
}

/// Number of stages that a port takes, and the names of their items at the port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    /// One stage, whose items keep their names.
    One,
    /// One stage or a list. Items are named `<stage>-<item>`, so that adding a second stage renames nothing.
    Named,
    /// One stage or a list. Items keep their names, so stages with items of the same name cannot be connected together.
    Distinct,
}

/// Blobs of the items at a port that the stage sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sees {
    /// All blobs.
    All,
    /// Blobs of these names.
    Only(&'static [&'static str]),
    /// The blob with the name of the stage's own item: one item that holds a part for each item of the stage.
    Own,
}

impl Sees {
    /// Whether the item `reader` of the stage sees the blob `name`.
    pub fn shows(self, name: &str, reader: &ItemName) -> bool {
        match self {
            Self::All => true,
            Self::Only(names) => names.contains(&name),
            Self::Own => reader.to_string() == name,
        }
    }
}

/// Origin of the input of a port.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PortSource {
    /// The recipe's `inputs` table.
    Recipe,
    /// Another part of the same recipe stage, by its suffix (see [`crate::StagePart`]).
    Sibling(&'static str),
}

/// Relation of the items of an input to the items of the stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fan {
    /// Item `x` of the input feeds item `x` of the stage.
    Each,
    /// The input's only item feeds every item of the stage.
    Broadcast,
    /// All items of the input feed each item of the stage.
    Gather,
    /// The items of a group feed the stage's item for that group (see [`ItemRule::Groups`]); with [`ItemRule::PerInput`], all items of
    /// its name.
    Group,
}

/// Rule that defines the items of a stage, before any stage runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ItemRule {
    /// One item, `all`.
    One,
    /// `<prefix>00000`, `<prefix>00001` ...: a higher count never renames items.
    Count {
        /// Prefix of every name.
        prefix: &'static str,
        /// Number of items.
        count: u64,
    },
    /// The items of the named [`Fan::Each`] port.
    PerInput(&'static str),
    /// `<prefix>00000`, `<prefix>00001` ...: one item for each `size` items of the named [`Fan::Group`] port, counted where
    /// they began. Items that began as the same one, such as an expert and its perturbed twin, are in one group, and further
    /// items change no earlier group.
    Groups {
        /// Name of the port.
        port: &'static str,
        /// Prefix of every name.
        prefix: &'static str,
        /// Number of first items in a group, at least 1.
        size: u64,
    },
    /// Every item of the named [`Fan::Each`] port once per variant, as `<item>-<variant>`: a new variant renames nothing.
    /// All variants read that item, here and at the [`Fan::Each`] ports of later stages that only have the item itself.
    PerVariant {
        /// Name of the port.
        port: &'static str,
        /// Variants, such as `HardRainNoon`; at least one.
        variants: Vec<String>,
    },
}
