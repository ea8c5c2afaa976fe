//! `splits.json`: what the splits of a dataset keep, for readers and for the linter.

use super::leaks::LintRules;
use cosfly_schema::config::{DatasetConfig, SplitBy, SplitShares, WindowConfig};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Name of the file.
pub const FILE: &str = "splits.json";
/// Longest file that is read; ours has some hundred bytes.
const LIMIT: u64 = 64 << 10;

/// The file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Promise {
    /// Version of this file.
    pub version: u32,
    /// What goes to one split as a whole, the shares, and how much walks may overlap.
    pub splits: SplitShares,
    /// How training windows are cut.
    pub windows: WindowConfig,
}

impl Promise {
    /// What a dataset promises; what a recipe without a word about it would for datasets without the file.
    ///
    /// # Errors
    /// Why the file cannot be read, in words.
    pub fn of_dataset(folder: &Path) -> Result<Self, String> {
        let path = folder.join(FILE);
        let default = Self { version: 1, splits: SplitShares::default(), windows: WindowConfig::default() };
        let Ok(found) = std::fs::metadata(&path) else { return Ok(default) };
        if !found.is_file() || found.len() > LIMIT {
            return Err(format!("it is no file of at most {LIMIT} bytes"));
        }
        let text = std::fs::read(&path).map_err(|error| error.to_string())?;
        let promise: Self = serde_json::from_slice(&text).map_err(|error| error.to_string())?;
        match promise.version {
            1 => Ok(promise),
            version => Err(format!("it has version {version}; this cosfly reads version 1")),
        }
    }

    /// What the linter holds it against.
    pub fn rules(&self) -> LintRules {
        LintRules { max_route_overlap: self.splits.max_route_overlap, by_town: self.splits.by == SplitBy::Town }
    }
}

/// The text of the file.
pub fn promise(config: &DatasetConfig) -> String {
    let promise = Promise { version: 1, splits: config.splits.clone(), windows: config.windows };
    serde_json::to_string_pretty(&promise).expect("numbers and names always print") + "\n"
}
