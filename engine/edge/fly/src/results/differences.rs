//! [`differences`] between two cards.

use serde_json::Value;
use std::collections::BTreeSet;

/// Entries in which two cards differ, in words, the kept one first.
pub fn differences(name: &str, kept: &Value, asked: &Value) -> Vec<String> {
    match (kept, asked) {
        _ if kept == asked => vec![],
        (Value::Object(ours), Value::Object(theirs)) => {
            let names: BTreeSet<&String> = ours.keys().chain(theirs.keys()).collect();
            let of = |key: &String| {
                let inside = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
                differences(&inside, ours.get(key).unwrap_or(&Value::Null), theirs.get(key).unwrap_or(&Value::Null))
            };
            names.into_iter().flat_map(of).collect()
        }
        _ => {
            let shown = |value: &Value| if value.is_null() { "nothing".to_owned() } else { value.to_string() };
            vec![format!("`{name}` was {} and is {} now", shown(kept), shown(asked))]
        }
    }
}
