//! Descriptions of schemas in words: types, allowed values, documentation.

use serde_json::Value as Json;

/// Longest chain of `$ref` that is followed.
const MOST_REFERENCES: usize = 16;

/// Schema that `$ref`s lead to; `schema` itself where there is none or they cannot be resolved.
pub(crate) fn resolve<'a>(root: &'a Json, schema: &'a Json) -> &'a Json {
    let mut schema = schema;
    for _ in 0..MOST_REFERENCES {
        let target = schema.get("$ref").and_then(Json::as_str).and_then(|reference| {
            let pointer = reference.strip_prefix('#')?;
            if pointer.is_empty() { Some(root) } else { root.pointer(pointer) }
        });
        match target {
            Some(target) => schema = target,
            None => break,
        }
    }
    schema
}

/// Entry of the schema for the parameter at `path`, with its own description and default; `None` inside alternatives.
pub(super) fn rule_at<'a>(root: &'a Json, path: &[String]) -> Option<&'a Json> {
    let mut rule = root;
    for key in path {
        let target = resolve(root, rule);
        rule = match key.parse::<usize>() {
            Ok(index) => {
                target.get("prefixItems").and_then(|items| items.get(index)).or_else(|| target.get("items"))?
            }
            Err(_) => target.get("properties")?.get(key)?,
        };
    }
    Some(rule)
}

/// Whether tables may have keys that the schema does not list.
pub(super) fn is_open(schema: &Json) -> bool {
    match schema.get("additionalProperties") {
        Some(rule) => rule != &Json::Bool(false),
        None => true,
    }
}

/// Whether the schema only allows null.
pub(super) fn is_null(root: &Json, schema: &Json) -> bool {
    resolve(root, schema).get("type").and_then(Json::as_str) == Some("null")
}

/// Types that a schema allows, such as `a number` or `a string or a table`.
pub(crate) fn type_words_of(root: &Json, schema: &Json) -> String {
    let mut words = vec![];
    collect_type_words(root, schema, &mut words, 0);
    words.dedup();
    match words.split_last() {
        None => "anything".to_owned(),
        Some((last, [])) => (*last).to_owned(),
        Some((last, first)) => format!("{} or {last}", first.join(", ")),
    }
}

fn collect_type_words(root: &Json, schema: &Json, words: &mut Vec<&'static str>, depth: usize) {
    if depth > MOST_REFERENCES {
        return;
    }
    let schema = resolve(root, schema);
    let mut add = |name: &Json| {
        let word = match name.as_str() {
            Some("boolean") => "`true` or `false`",
            Some("integer") => "a whole number",
            Some("number") => "a number",
            Some("string") => "a string",
            Some("array") => "a list",
            Some("object") => "a table",
            _ => return,
        };
        if !words.contains(&word) {
            words.push(word);
        }
    };
    match schema.get("type") {
        Some(Json::Array(names)) => names.iter().for_each(&mut add),
        Some(name) => add(name),
        None if schema.get("const").or_else(|| schema.get("enum")?.get(0)).is_some_and(Json::is_string) => {
            add(&"string".into());
        }
        None => {}
    }
    for keyword in ["anyOf", "oneOf", "allOf"] {
        for part in schema.get(keyword).and_then(Json::as_array).into_iter().flatten() {
            collect_type_words(root, part, words, depth + 1);
        }
    }
}

/// Values that a schema lists, with their descriptions; empty where it lists none.
pub(crate) fn allowed_values<'a>(root: &'a Json, schema: &'a Json) -> Vec<(&'a Json, Option<&'a str>)> {
    let mut values = vec![];
    collect_allowed(root, schema, &mut values, 0);
    values
}

fn collect_allowed<'a>(root: &'a Json, schema: &'a Json, values: &mut Vec<(&'a Json, Option<&'a str>)>, depth: usize) {
    if depth > MOST_REFERENCES {
        return;
    }
    let schema = resolve(root, schema);
    let doc = schema.get("description").and_then(Json::as_str);
    if let Some(value) = schema.get("const") {
        values.push((value, doc));
    }
    for value in schema.get("enum").and_then(Json::as_array).into_iter().flatten().filter(|value| !value.is_null()) {
        values.push((value, None));
    }
    for keyword in ["anyOf", "oneOf"] {
        for part in schema.get(keyword).and_then(Json::as_array).into_iter().flatten() {
            collect_allowed(root, part, values, depth + 1);
        }
    }
}

/// First sentence of a description, on one line.
pub(super) fn first_sentence(description: &str) -> String {
    let paragraph = description.split("\n\n").next().unwrap_or_default();
    let line = paragraph.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.find(". ") {
        Some(end) => line[..end].to_owned(),
        None => line.trim_end_matches('.').to_owned(),
    }
}

/// A JSON value as TOML.
pub(crate) fn show_toml(value: &Json) -> String {
    match value {
        Json::String(text) => format!("{text:?}"),
        Json::Array(items) => format!("[{}]", items.iter().map(show_toml).collect::<Vec<_>>().join(", ")),
        Json::Object(table) if table.is_empty() => "{}".to_owned(),
        Json::Object(table) => {
            let entries: Vec<String> = table
                .iter()
                .filter(|(_, value)| !value.is_null())
                .map(|(key, value)| format!("{key} = {}", show_toml(value)))
                .collect();
            format!("{{ {} }}", entries.join(", "))
        }
        other => show_json(other),
    }
}

/// A JSON value as it would be written in a recipe; texts without quotes.
pub(crate) fn show_json(value: &Json) -> String {
    match value {
        Json::String(text) => text.clone(),
        Json::Number(number) => match number.as_f64() {
            Some(float) if number.is_f64() && float.fract() == 0.0 && float.abs() < 1e15 => format!("{float:.0}"),
            // Defaults of 32-bit fields are widened to 64 bits: `0.1` is `0.10000000149011612`.
            Some(float) if number.is_f64() && f64::from(float as f32) == float => (float as f32).to_string(),
            _ => number.to_string(),
        },
        other => other.to_string(),
    }
}
