//! How recipes name plugins: file, parameters, limits.

use cosfly_diagnose::ParameterError;
use cosfly_stage::parameters;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Prefix of a plugin's file in recipes.
pub const PREFIX: &str = "wasm:";
/// Stands for the file in parameters that go into keys: its content is there instead.
const CONTENT: &str = "wasm:(content)";

/// Plugins of a `plan` stage.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ExpertPlugins {
    /// Cost terms from plugins, beside the built-in ones.
    pub terms: Vec<TermPlugin>,
    /// The objective from a plugin; `objective = "plugin"` only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plugin: Option<ObjectivePlugin>,
}

/// A cost term from a plugin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TermPlugin {
    /// The file, as in `wasm:plugins/privacy.wasm`; relative paths begin at the recipe's folder.
    #[serde(rename = "use")]
    #[schemars(regex(pattern = "^wasm:."))]
    pub file: String,
    /// Weight of its cost, at least 0. Default 1.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 1_000_000.0))]
    pub weight: f64,
    /// Name in tables, where the plugin's own is taken or does not say enough.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(regex(pattern = "^[a-z][a-z0-9_]{0,59}$"))]
    pub name: Option<String>,
    /// Its parameters, checked against what the plugin declares (`cosfly plugin check FILE` lists them).
    #[serde(default)]
    pub params: Map<String, Value>,
    /// Limits: memory, time, instructions.
    #[serde(default)]
    pub limits: PluginLimitConfig,
    /// SHA-256 of the file; another file is refused. Not checked when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(regex(pattern = "^[0-9a-f]{64}$"))]
    pub sha256: Option<String>,
}

/// An objective from a plugin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ObjectivePlugin {
    /// The file, as in `wasm:plugins/orbit.wasm`; relative paths begin at the recipe's folder.
    #[serde(rename = "use")]
    #[schemars(regex(pattern = "^wasm:."))]
    pub file: String,
    /// How many flights, each from a seed of its own. Default 1.
    #[serde(default = "one_flight")]
    #[schemars(range(min = 1, max = 100_000))]
    pub count: u64,
    /// Its parameters, checked against what the plugin declares (`cosfly plugin check FILE` lists them).
    #[serde(default)]
    pub params: Map<String, Value>,
    /// Limits: memory, time, instructions.
    #[serde(default)]
    pub limits: PluginLimitConfig,
    /// SHA-256 of the file; another file is refused. Not checked when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(regex(pattern = "^[0-9a-f]{64}$"))]
    pub sha256: Option<String>,
}

/// A stage from a plugin: `use = "wasm:FILE"`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StagePlugin {
    /// The file; written as `use = "wasm:FILE"`. Relative paths begin at the recipe's folder.
    pub file: String,
    /// Its parameters, checked against what the plugin declares (`cosfly plugin check FILE` lists them).
    #[serde(default)]
    pub params: Map<String, Value>,
    /// Limits: memory, time, instructions.
    #[serde(default)]
    pub limits: PluginLimitConfig,
    /// SHA-256 of the file; another file is refused. Not checked when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(regex(pattern = "^[0-9a-f]{64}$"))]
    pub sha256: Option<String>,
    /// Outputs: `flights`, the ones that arrive at `trajectories`, judged or labelled; or `extras` of rendered flights, those
    /// that arrive at `frames`, for the dataset's `inputs.extras`: annotations, tables, files. Default `flights`.
    #[serde(default)]
    pub makes: Makes,
}

/// Outputs of a stage from a plugin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Makes {
    /// Flights, judged or labelled.
    #[default]
    Flights,
    /// Additions to datasets beside their own tables.
    Extras,
}

/// Limits of a plugin: memory, time, instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PluginLimitConfig {
    /// Most memory, MiB. Default 64.
    #[schemars(range(min = 1, max = 4096))]
    pub memory_mib: u32,
    /// Longest call of a function, milliseconds. Default 1000.
    #[schemars(range(min = 10, max = 600_000))]
    pub call_ms: u32,
    /// Most instructions of one call, counted exactly, so that the same plugin fails at the same place on every machine; 0 does
    /// not count. With it the plugin runs in strict mode: NaNs have the same bits everywhere. Costs a
    /// factor of two to three. Default 0.
    #[schemars(range(min = 0, max = 1_000_000_000_000u64))]
    pub fuel: u64,
}

fn one() -> f64 {
    1.0
}

fn one_flight() -> u64 {
    1
}

impl Default for PluginLimitConfig {
    fn default() -> Self {
        Self { memory_mib: 64, call_ms: 1000, fuel: 0 }
    }
}

/// Parameters that all uses of plugins have in common.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// The file as written, without `wasm:`.
    pub file: String,
    /// Its parameters.
    pub params: Map<String, Value>,
    /// Limits: memory, time, instructions.
    pub limits: PluginLimitConfig,
    /// SHA-256 of the file, if it is to be checked.
    pub sha256: Option<String>,
}

fn without_prefix(file: &str) -> String {
    file.strip_prefix(PREFIX).unwrap_or(file).to_owned()
}

impl TermPlugin {
    /// Parameters in common with other uses.
    pub fn setting(&self) -> Setting {
        let (params, sha256) = (self.params.clone(), self.sha256.clone());
        Setting { file: without_prefix(&self.file), params, limits: self.limits, sha256 }
    }
}

impl ObjectivePlugin {
    /// Parameters in common with other uses.
    pub fn setting(&self) -> Setting {
        let (params, sha256) = (self.params.clone(), self.sha256.clone());
        Setting { file: without_prefix(&self.file), params, limits: self.limits, sha256 }
    }
}

impl StagePlugin {
    /// Parameters in common with other uses.
    pub fn setting(&self) -> Setting {
        let (params, sha256) = (self.params.clone(), self.sha256.clone());
        Setting { file: self.file.clone(), params, limits: self.limits, sha256 }
    }

    /// Ingredients of keys.
    pub fn canonical(&self) -> Self {
        Self { file: CONTENT.to_owned(), sha256: None, ..self.clone() }
    }
}

impl ExpertPlugins {
    /// All uses in the order of the stage's sources: the terms, then the objective; each with its parameter.
    pub fn settings(&self) -> Vec<(String, Setting)> {
        let terms = self.terms.iter().enumerate().map(|(index, term)| (format!("terms.{index}"), term.setting()));
        let objective = self.plugin.iter().map(|plugin| ("plugin".to_owned(), plugin.setting()));
        terms.chain(objective).collect()
    }

    /// Ingredients of keys, without places of files and the number of flights.
    pub fn canonical(&self) -> Self {
        let mut all = self.clone();
        for term in &mut all.terms {
            (term.file, term.sha256) = (CONTENT.to_owned(), None);
        }
        if let Some(plugin) = &mut all.plugin {
            (plugin.file, plugin.sha256, plugin.count) = (CONTENT.to_owned(), None, 1);
        }
        all
    }

    /// Refuses what the schema cannot say, at its place.
    ///
    /// # Errors
    /// Two terms that are given the same name.
    pub fn validate(&self) -> Result<(), ParameterError> {
        for (index, term) in self.terms.iter().enumerate() {
            let Some(name) = &term.name else { continue };
            if self.terms[..index].iter().any(|earlier| earlier.name.as_ref() == Some(name)) {
                let message = format!("two terms are called `{name}`");
                return Err(parameters::refused_at(&format!("terms[{index}].name"), message));
            }
        }
        Ok(())
    }
}
