//! Values of recipes as TOML on one line.

use serde_json::Value;

/// A value as TOML; nothing in a table where there is none.
pub(super) fn toml(value: &Value) -> String {
    match value {
        Value::Array(items) => format!("[{}]", items.iter().map(toml).collect::<Vec<_>>().join(", ")),
        Value::Object(table) => {
            let entries = table.iter().filter(|(_, value)| !value.is_null());
            let entries: Vec<String> = entries.map(|(key, value)| format!("{} = {}", text(key), toml(value))).collect();
            if entries.is_empty() { "{}".to_owned() } else { format!("{{ {} }}", entries.join(", ")) }
        }
        Value::String(value) => text(value),
        other => other.to_string(),
    }
}

/// A text in quotes; JSON's escapes are TOML's, but for that of `/`, which serde does not write.
pub(super) fn text(text: &str) -> String {
    let quoted = serde_json::to_string(text).unwrap_or_default();
    quoted.replace('\u{7f}', "\\u007f")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn values_come_back_from_their_text() {
        let value = serde_json::json!({
            "whole": 3, "real": 0.5, "is": true, "list": [1, [2]], "table": { "a b": "x\"\\\n\u{1}\u{7f}" }, "none": {},
        });
        let entries = value.as_object().expect("a table").iter();
        let lines: Vec<String> = entries.map(|(key, value)| format!("{} = {}\n", text(key), toml(value))).collect();
        let read = cosfly_recipe::table(Path::new("test"), &lines.concat()).expect("TOML");
        assert_eq!(serde_json::Value::Object(read), value);
    }
}
