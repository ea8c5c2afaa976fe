//! What a version of a dataset is: every file's hash, the exact recipe, the tool, and how each flight came about.

use cosfly_fingerprint::Digest;
use cosfly_stage::BlobRef;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The form of the manifest.
pub const SCHEMA: &str = "cosfly.version/1";

/// A version. Nothing in it depends on when or where it was named, except for the recipe's path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Version {
    /// [`SCHEMA`].
    pub schema: String,
    /// Its name.
    pub name: String,
    /// Name of the dataset, from the recipe.
    pub dataset: String,
    /// Version of the dataset, from the recipe: `MAJOR.MINOR.PATCH`.
    pub dataset_version: String,
    /// Version of cosfly that named it.
    pub cosfly: String,
    /// The recipe.
    pub recipe: RecipeText,
    /// BLAKE3 of all files of the recipe and of plugins, by stage and parameter, such as `expert.use`.
    pub sources: BTreeMap<String, Digest>,
    /// BLAKE3 over path, hash and size of all files.
    pub content: Digest,
    /// All files of the dataset by their paths.
    pub files: BTreeMap<String, BlobRef>,
    /// What all items of a stage share: kind, version, all parameters with their defaults, digests of files.
    pub definitions: BTreeMap<String, Value>,
    /// Every task behind a flight, as `stage/item`.
    pub tasks: BTreeMap<String, Task>,
    /// The published flights by their ids.
    pub flights: BTreeMap<String, Flight>,
    /// Items without a flight, with their reasons.
    pub rejected: BTreeMap<String, String>,
}

/// A recipe as it was.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecipeText {
    /// Where it lies: files that it names are looked for beside it.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
    /// Values of `--set`.
    pub overrides: Vec<String>,
    /// What it and the overrides say of each stage, without defaults.
    pub settings: BTreeMap<String, Value>,
}

/// One task.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// Its key: equal keys make equal bytes.
    pub key: Digest,
    /// What it reads, as `stage/item`.
    pub reads: Vec<String>,
}

/// One flight.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Flight {
    /// Its split.
    pub split: String,
    /// BLAKE3 of its log.
    pub log: Digest,
    /// The task that wrote the log.
    pub task: String,
}

impl Version {
    /// Number of bytes of all files.
    pub fn bytes(&self) -> u64 {
        self.files.values().map(|file| file.bytes).sum()
    }
}
