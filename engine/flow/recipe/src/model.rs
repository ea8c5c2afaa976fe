//! The checked recipe: stages in dependency order, wired, with their items and files known.

use cosfly_stage::{Fan, InputPort, Stage};
use std::fmt;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

/// Item ids of a stage, shared by all that have the same ones.
pub type ItemIds = Arc<[Arc<str>]>;

/// A recipe that can be run: everything that can be known before running is checked.
#[derive(Clone, Debug)]
pub struct Recipe {
    /// Its name, `[a-z0-9_-]+`.
    pub name: String,
    /// Root of all randomness.
    pub seed: u64,
    /// The recipe file as it was given.
    pub path: PathBuf,
    /// Folder of the recipe; relative paths in it start here.
    pub directory: PathBuf,
    /// The recipe's text, for labels.
    pub text: Arc<str>,
    /// In dependency order (what is equal there, in the order of the file): a stage's inputs stand before it.
    pub stages: Vec<RecipeStage>,
}

/// One stage, or one part of a stage, of a checked recipe.
#[derive(Clone)]
pub struct RecipeStage {
    /// Unique name: the recipe's stage name with the part's suffix, such as `dataset.logs` or `dataset`.
    pub name: String,
    /// The name in the recipe, without suffix.
    pub recipe_name: String,
    /// The kind in the recipe (`use`).
    pub kind: String,
    /// What runs.
    pub stage: Arc<dyn Stage>,
    /// Connected ports, in the order of the stage's properties; optional ports that are left out are absent.
    pub connections: Vec<Connection>,
    /// Files it reads, in the order of [`cosfly_stage::StageProperties::sources`]; they existed when the recipe was read.
    pub sources: Vec<SourceFile>,
    /// Its items.
    pub items: ItemIds,
    /// What the ids of its items may end with, after a `-`, that ids of earlier stages do not
    /// (see [`cosfly_stage::ItemRule::PerVariant`]).
    pub variants: Vec<String>,
    /// Its parameters as the recipe and `--set` give them: no defaults, no `use`, no `inputs`.
    pub parameters: serde_json::Value,
    /// Bytes of [`Recipe::text`] with the stage's name, for labels.
    pub span: Range<usize>,
}

/// A port and what is connected to it.
#[derive(Clone, Debug)]
pub struct Connection {
    /// The port as the stage declares it.
    pub port: InputPort,
    /// Indices into [`Recipe::stages`], in the order of the recipe.
    pub upstreams: Vec<usize>,
    /// What arrives. [`Fan::Each`]: entry `i` feeds the stage's item `i`. [`Fan::Broadcast`]: exactly one entry.
    /// [`Fan::Gather`]: all entries, by upstream and then in its item order.
    pub arrivals: Arc<[Arrival]>,
}

/// One item at a port.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Arrival {
    /// Id at the port: the upstream id, or `<stage>-<item>` when the port takes many stages.
    pub id: Arc<str>,
    /// Index of the upstream stage in [`Recipe::stages`].
    pub stage: usize,
    /// Index in that stage's [`RecipeStage::items`].
    pub item: usize,
}

/// A file outside the store that a stage reads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceFile {
    /// The parameter that names it, keys joined by dots.
    pub parameter: String,
    /// As the stage declares it.
    pub declared: PathBuf,
    /// Resolved against the recipe's folder.
    pub path: PathBuf,
}

impl Recipe {
    /// Index of the stage called `name` (with suffix).
    pub fn position(&self, name: &str) -> Option<usize> {
        self.stages.iter().position(|stage| stage.name == name)
    }
}

impl RecipeStage {
    /// The connection of port `name`.
    pub fn connection(&self, name: &str) -> Option<&Connection> {
        self.connections.iter().find(|connection| connection.port.name == name)
    }

    /// Indices of all stages it reads from, sorted, each once.
    pub fn upstreams(&self) -> Vec<usize> {
        let mut all: Vec<usize> = self.connections.iter().flat_map(|c| c.upstreams.iter().copied()).collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}

impl Connection {
    /// What the stage's item number `item` reads through this port.
    pub fn arrivals_for(&self, item: usize) -> &[Arrival] {
        match self.port.fan {
            Fan::Each => self.arrivals.get(item..=item).unwrap_or(&[]),
            Fan::Broadcast | Fan::Gather => &self.arrivals,
        }
    }
}

impl fmt::Debug for RecipeStage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RecipeStage")
            .field("name", &self.name)
            .field("kind", &self.kind)
            .field("items", &self.items.len())
            .field("parameters", &self.parameters)
            .finish_non_exhaustive()
    }
}
