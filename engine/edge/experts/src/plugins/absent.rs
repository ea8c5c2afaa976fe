//! In place of the host, in a build without plugins: every use is refused when the recipe is read.

use super::PluginRole;
use super::config::{ExpertPlugins, Makes, Setting};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_flight::{DrawnReference, NoPlugins, OpenTerms, World};
use cosfly_frames::Seed;
use cosfly_planner::MucoConfig;
use cosfly_schema::flight_table::FlightColumns;
use cosfly_stage::{Source, SourceCheck};
use std::path::PathBuf;
use std::sync::Arc;

fn refused(file: &str) -> Box<Diagnostic> {
    Diagnostic::new("plugin-refused", Fault::Recipe, format!("plugin `{file}` cannot be used"))
        .because("this cosfly was built without plugins")
        .hint("build it with the feature `plugins`, which is on by default")
}

/// A source that is refused.
pub fn source(parameter: &str, role: PluginRole, setting: &Setting) -> Source {
    let file = setting.file.clone();
    let read = move |_: &std::path::Path| Err(refused(&file));
    Source {
        parameter: if matches!(role, PluginRole::Stage(_)) { "file".to_owned() } else { format!("{parameter}.use") },
        path: PathBuf::from(&setting.file),
        check: Some(SourceCheck { describes: "params".to_owned(), read: Arc::new(read), settle: None }),
    }
}

/// Type of a column's values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "never made here; as in the interface")]
pub enum ValueKind {
    Real,
    Integer,
    Boolean,
    Text,
    Bytes,
}

/// A column that a stage reads or gives.
pub struct Column {
    /// Name.
    pub name: String,
    /// Type of the values.
    pub kind: ValueKind,
    /// Meaning of the column.
    pub doc: String,
}

/// Use of a stage's answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "never made here; as in the interface")]
pub enum Effect {
    Filter,
    Label,
    Annotate,
    Rows,
    Files,
}

impl Effect {
    /// Nothing.
    pub fn words(self) -> &'static str {
        ""
    }
}

/// Columns that a stage reads and gives.
pub struct Declaration {
    /// Use of its answers.
    pub effect: Effect,
    /// Table or folder of the dataset.
    pub name: String,
    /// The columns that it reads.
    pub reads: Vec<Column>,
    /// The columns that it gives.
    pub gives: Vec<Column>,
}

/// Result for a flight.
pub struct Answered {
    /// An Arrow stream.
    pub answer: Vec<u8>,
    /// For users.
    pub warnings: Vec<String>,
}

/// No plugins.
#[derive(Clone, Default)]
pub struct Plugins;

impl Plugins {
    /// # Errors
    /// When there are any.
    pub fn of_expert(config: &ExpertPlugins, _: &[PathBuf]) -> Result<Self> {
        config.settings().first().map_or(Ok(Self), |(_, setting)| Err(refused(&setting.file)))
    }

    /// # Errors
    /// Always.
    pub fn of_stage(setting: &Setting, _: &[PathBuf]) -> Result<Self> {
        Err(refused(&setting.file))
    }

    /// The setting itself: there are no plugins.
    pub fn for_item(self, _: String) -> Self {
        self
    }

    /// # Errors
    /// Always.
    pub fn answer(&self, _: &Arc<World>, _: Makes, _: &FlightColumns) -> Result<(Declaration, Answered)> {
        Err(refused(""))
    }

    /// Nothing.
    pub fn told(&self) -> [&str; 3] {
        [""; 3]
    }

    /// The fault of a wrong answer.
    pub fn wrong_answer(&self, message: String) -> Box<Diagnostic> {
        Diagnostic::new("plugin-failed", Fault::Input, message)
    }
}

impl cosfly_flight::FlightPlugins for Plugins {
    fn open_terms(&self, world: &Arc<World>, seed: Seed) -> Result<OpenTerms> {
        NoPlugins.open_terms(world, seed)
    }

    fn draw_reference(
        &self,
        _: &Arc<World>,
        _: &MucoConfig,
        _: [f64; 4],
        _: Seed,
    ) -> Result<Result<DrawnReference, String>> {
        Err(refused(""))
    }
}
