//! The checked recipe: connected stages in dependency order, with their items and files.

use cosfly_stage::{Fan, InputPort, ItemId, ItemName, Stage, StageName, StageRole};
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

/// Names of a stage's items, shared by all stages that have the same ones.
pub type ItemNames = Arc<[ItemName]>;

/// A checked recipe, ready to run: everything that can be checked before running is checked.
#[derive(Clone, Debug)]
pub struct Recipe {
    /// Name of the recipe, `[a-z0-9_-]+`.
    pub name: String,
    /// Root of all randomness.
    pub seed: u64,
    /// Whether intermediate blobs are removed as soon as everything that reads them is finished.
    pub remove_intermediates: bool,
    /// Tables of other commands by their names (`[tool.NAME]`); runs do not read them.
    pub tool: serde_json::Map<String, serde_json::Value>,
    /// Path of the recipe file as it was given.
    pub path: PathBuf,
    /// Text of the recipe.
    pub text: Arc<str>,
    /// Stages in dependency order, and in the order of the file where that leaves a choice.
    pub stages: Vec<RecipeStage>,
}

/// One stage, or one part of a stage, of a checked recipe.
#[derive(Clone)]
pub struct RecipeStage {
    /// Name, unique in the recipe.
    pub name: StageName,
    /// Kind in the recipe (`use`).
    pub kind: String,
    /// Stage that makes the items.
    pub stage: Arc<dyn Stage>,
    /// Connected ports, in the order of the stage's properties; optional ports that are left out are absent.
    pub connections: Vec<Connection>,
    /// Files that the stage reads, in the order of [`cosfly_stage::StageProperties::sources`]; they existed when the
    /// recipe was read.
    pub sources: Vec<SourceFile>,
    /// Names of the stage's items.
    pub items: ItemNames,
    /// Parameters as the recipe and `--set` give them: without defaults, `use` and `inputs`.
    pub parameters: serde_json::Value,
}

/// A port and the stages connected to it.
#[derive(Clone, Debug)]
pub struct Connection {
    /// The port as the stage declares it.
    pub port: InputPort,
    /// Connected stages, as indices into [`Recipe::stages`], in the order of the recipe.
    pub upstreams: Vec<usize>,
    /// Items at the port. [`Fan::Each`]: entry `i` feeds the stage's item `i`. [`Fan::Broadcast`]: exactly one entry.
    /// [`Fan::Gather`]: all entries, by stage and then in its item order. [`Fan::Group`]: group by group.
    pub arrivals: Arc<[Arrival]>,
    /// [`Fan::Group`]: the stage's item `i` reads the arrivals from entry `i` to entry `i + 1`. Empty for other fans.
    pub bounds: Arc<[usize]>,
}

/// One item at a port.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Arrival {
    /// Name at the port (see [`cosfly_stage::Takes`]).
    pub name: ItemName,
    /// Stage that makes the item, as an index into [`Recipe::stages`].
    pub stage: usize,
    /// Index in that stage's [`RecipeStage::items`].
    pub item: usize,
}

/// A file outside the store that a stage reads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceFile {
    /// Parameter that names the file, keys joined by dots.
    pub parameter: String,
    /// Path, resolved against the recipe's folder.
    pub path: PathBuf,
}

impl Recipe {
    /// Index of the stage (or stage part) called `name`.
    pub fn position(&self, name: &str) -> Option<usize> {
        self.stages.iter().position(|stage| stage.name == *name)
    }

    /// Identity of item number `item` of stage number `stage`.
    pub fn id(&self, stage: usize, item: usize) -> ItemId {
        let described = &self.stages[stage];
        ItemId { stage: described.name.clone(), item: described.items[item].clone() }
    }
}

impl RecipeStage {
    /// Connection of port `name`.
    pub fn connection(&self, name: &str) -> Option<&Connection> {
        self.connections.iter().find(|connection| connection.port.name == name)
    }

    /// Whether the stage has the role `role`.
    pub fn has_role(&self, role: StageRole) -> bool {
        self.stage.properties().role == role
    }

    /// Port through which a stage of the role [`StageRole::Changes`] reads what it changes.
    pub fn changed(&self) -> Option<&Connection> {
        let artifact = self.stage.properties().artifact;
        let is_changed = |it: &&Connection| it.port.fan == Fan::Each && it.port.artifact == artifact;
        self.connections.iter().find(is_changed).filter(|_| self.has_role(StageRole::Changes))
    }

    /// Items that the stage's item number `item` reads, through all ports.
    pub fn reads(&self, item: usize) -> impl Iterator<Item = &Arrival> {
        self.connections.iter().flat_map(move |connection| connection.arrivals_for(item))
    }
}

impl Connection {
    /// Items that the stage's item number `item` reads through this port.
    pub fn arrivals_for(&self, item: usize) -> &[Arrival] {
        match self.port.fan {
            Fan::Each => self.arrivals.get(item..=item).unwrap_or(&[]),
            Fan::Broadcast | Fan::Gather => &self.arrivals,
            Fan::Group => match self.bounds.get(item..item + 2) {
                Some([start, end]) => &self.arrivals[*start..*end],
                _ => &[],
            },
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
