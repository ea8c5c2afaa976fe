//! Manifest of a version of a dataset: hashes of all files, the exact recipe, the tool, and the origin of each flight.

use cosfly_fingerprint::Digest;
use cosfly_stage::{Blobs, ItemId};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Format of the manifest.
pub const SCHEMA: &str = "cosfly.version/2";

/// A named version. Its content does not depend on when or where it was named, except for the recipe's path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Version {
    /// Format of the manifest: [`SCHEMA`].
    pub schema: String,
    /// Name of the version.
    pub name: String,
    /// Name of the dataset, from the recipe.
    pub dataset: String,
    /// Version of the dataset, from the recipe: `MAJOR.MINOR.PATCH`.
    pub dataset_version: String,
    /// Version of cosfly that created the manifest.
    pub cosfly: String,
    /// Recipe of the dataset.
    pub recipe: RecipeText,
    /// BLAKE3 of all source files of the recipe and of plugins, by stage and parameter, such as `expert.use`.
    pub sources: BTreeMap<String, Digest>,
    /// BLAKE3 over path, hash and size of all files.
    pub content: Digest,
    /// All files of the dataset by their paths.
    pub files: Blobs,
    /// Stage of the recipe that published the files.
    pub published_by: String,
    /// Definitions by stage: kind, version, all parameters with their defaults, digests of files.
    pub definitions: BTreeMap<String, Value>,
    /// All tasks behind the flights; in the manifest, a list of names and tasks.
    #[serde(serialize_with = "as_list", deserialize_with = "from_list")]
    pub tasks: BTreeMap<ItemId, Task>,
    /// Published flights by their ids.
    pub flights: BTreeMap<String, VersionFlight>,
    /// Items without a flight, with their reasons.
    pub rejected: BTreeMap<String, String>,
}

/// The recipe as it was read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecipeText {
    /// Path of the recipe; files that it names are resolved relative to it.
    pub path: PathBuf,
    /// Text of the recipe.
    pub text: String,
    /// Values of `--set`.
    pub overrides: Vec<String>,
    /// Parameters of each stage as recipe and overrides give them, without defaults.
    pub settings: BTreeMap<String, Value>,
}

/// A task behind a flight.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// Key of the task: equal keys give equal bytes.
    pub key: Digest,
    /// Tasks that the task reads.
    pub reads: Vec<ItemId>,
}

/// A published flight.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VersionFlight {
    /// Split of the flight.
    pub split: String,
    /// BLAKE3 of the flight's log.
    pub log: Digest,
    /// Task that wrote the log.
    pub task: ItemId,
}

fn as_list<S: Serializer>(tasks: &BTreeMap<ItemId, Task>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(tasks)
}

fn from_list<'de, D: Deserializer<'de>>(deserializer: D) -> Result<BTreeMap<ItemId, Task>, D::Error> {
    Vec::deserialize(deserializer).map(|tasks| tasks.into_iter().collect())
}

impl Version {
    /// Number of bytes of all files.
    pub fn bytes(&self) -> u64 {
        self.files.values().map(|file| file.bytes).sum()
    }
}
