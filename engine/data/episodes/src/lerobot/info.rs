//! `meta/info.json`: features, counts, splits.

use cosfly_diagnose::counted;
use serde_json::Value;
use std::path::Path;

/// Size of the largest `info.json` that is read, bytes.
const INFO_LIMIT: u64 = 1 << 26;

/// The contents of `meta/info.json`.
///
/// # Errors
/// The reason, in words.
pub fn info(folder: &Path) -> Result<Value, String> {
    let path = folder.join("meta/info.json");
    let size = std::fs::metadata(&path).map_err(|error| error.to_string())?.len();
    if size > INFO_LIMIT {
        return Err(format!("it has {size}", size = counted(size, "byte")));
    }
    let bytes = std::fs::read(path).map_err(|error| format!("it cannot be read: {error}"))?;
    let info: Value = serde_json::from_slice(&bytes).map_err(|error| format!("not JSON: {error}"))?;
    if info["features"].is_object() { Ok(info) } else { Err("it has no `features`".into()) }
}

/// Split of an episode.
pub fn split(info: &Value, number: i64) -> Option<String> {
    let splits = info["splits"].as_object()?;
    let holds = |range: &Value| {
        let (from, to) = range.as_str()?.split_once(':')?;
        Some(number >= from.trim().parse().ok()? && number < to.trim().parse().ok()?)
    };
    splits.iter().find(|(_, range)| holds(range) == Some(true)).map(|(name, _)| name.clone())
}
