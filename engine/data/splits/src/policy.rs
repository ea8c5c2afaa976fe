//! `splits.json`: the split policy of a dataset, for readers and for the linter.

use super::leaks::LintRules;
use cosfly_schema::config::{DatasetConfig, SplitShares, WindowConfig};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Name of the file.
pub const FILE: &str = "splits.json";
/// Size limit of the file, bytes; cosfly writes some hundred bytes.
const LIMIT: u64 = 64 << 10;

/// Split policy of a dataset: the content of `splits.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SplitPolicy {
    /// Version of the file format.
    pub version: u32,
    /// Shares of the splits, groups that stay together, and the largest overlap of walks.
    pub splits: SplitShares,
    /// Shape of training windows.
    pub windows: WindowConfig,
}

impl SplitPolicy {
    /// Reads the policy of a dataset; the default policy for datasets without the file.
    ///
    /// # Errors
    /// Reason why the file cannot be read, in words.
    pub fn of_dataset(folder: &Path) -> Result<Self, String> {
        let path = folder.join(FILE);
        let default = Self { version: 1, splits: SplitShares::default(), windows: WindowConfig::default() };
        let Ok(found) = std::fs::metadata(&path) else { return Ok(default) };
        if !found.is_file() || found.len() > LIMIT {
            return Err(format!("it is not a file of at most {LIMIT} bytes"));
        }
        let text = std::fs::read(&path).map_err(|error| error.to_string())?;
        let policy: Self = serde_json::from_slice(&text).map_err(|error| error.to_string())?;
        match policy.version {
            1 => Ok(policy),
            version => Err(format!("it has version {version}; this cosfly reads version 1")),
        }
    }

    /// Rules of the linter that follow from the policy.
    pub fn rules(&self) -> LintRules {
        LintRules::of_shares(&self.splits)
    }
}

/// Text of the file.
pub fn split_policy(config: &DatasetConfig) -> String {
    let policy = SplitPolicy { version: 1, splits: config.splits.clone(), windows: config.windows };
    serde_json::to_string_pretty(&policy).expect("numbers and names always print") + "\n"
}
