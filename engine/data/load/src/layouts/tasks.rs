//! Instructions of LeRobot's episodes: the task of their first frame, from `meta/tasks.parquet` or `meta/tasks.jsonl`.

use cosfly_diagnose::{Diagnostic, Result};
use cosfly_read::columns::{Column, column, column_names};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// Tasks of the dataset in `root` by their numbers; none where it states none.
///
/// # Errors
/// Damage of the table.
pub fn tasks(root: &Path) -> Result<BTreeMap<i64, String>> {
    let (table, lines) = (root.join("meta/tasks.parquet"), root.join("meta/tasks.jsonl"));
    if table.is_file() {
        // pandas calls an index without a name `__index_level_0__`.
        let names = column_names(&table)?;
        let Some(text) = names.iter().find(|name| ["task", "__index_level_0__"].contains(&name.as_str())) else {
            return Ok(BTreeMap::new());
        };
        let paths = [table];
        return Ok(match (column(&paths, "task_index")?, column(&paths, text)?) {
            (Column::Integers(numbers), Column::Texts(texts)) => {
                numbers.into_iter().zip(texts).filter_map(|(number, text)| Some((number, text?))).collect()
            }
            _ => BTreeMap::new(),
        });
    }
    if !lines.is_file() {
        return Ok(BTreeMap::new());
    }
    let text = std::fs::read_to_string(&lines)
        .map_err(|error| Diagnostic::io(format!("read `{}`", lines.display()), &error))?;
    let task = |line: &str| {
        let row: Value = serde_json::from_str(line).ok()?;
        Some((row["task_index"].as_i64()?, row["task"].as_str()?.to_owned()))
    };
    Ok(text.lines().filter_map(task).collect())
}

/// Language of a text, by its script: `zh` or `en`. LeRobot states none.
pub fn language(text: &str) -> &'static str {
    if text.chars().any(|letter| ('\u{4e00}'..='\u{9fff}').contains(&letter)) { "zh" } else { "en" }
}
