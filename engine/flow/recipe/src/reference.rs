//! Reference page of the book, generated from the schemas and ports of the kinds.

use crate::outline::FILE_KIND;
use crate::parameters::{allowed_values, resolve, show_json, show_toml, type_words_of};
use cosfly_stage::{Fan, InputPort, Registry, StageKind, Takes};
use serde_json::Value;
use std::fmt::Write;

/// Deepest nesting of tables that is listed parameter by parameter.
const MOST_LEVELS: usize = 6;

const INTRODUCTION: &str = "\
# Recipe reference

<!-- Generated from the stage kinds of the binary. Do not edit. -->

A recipe is one TOML file: the name and seed of a dataset, and connected stages:

```toml
#:schema ../schemas/recipe.schema.json
name = \"carla_town\"
seed = 42

[stages.town]
use = \"map\"                       # kind of the stage
source = \"towns/downtown.xodr\"    # parameters of the kind

[stages.walkers]
use = \"pedestrians\"
inputs.town = \"town\"              # port = name of a stage
count = 4
```

| key | type | default | meaning |
|---|---|---|---|
| `name` | a string of `a-z`, `0-9`, `_`, `-` | required | Name of the dataset and its folder. |
| `seed` | a whole number, at least `0` | `0` | Root of all randomness. |
| `intermediates` | `\"keep\"` or `\"remove\"` | `\"keep\"` | Whether packed pictures and other intermediate files are removed from the store as soon as everything that reads them is finished. |
| `for_each.LIST` | a list, or a pattern of files | | Values that stages are made for; see [Many towns](../guide/many-towns.md). |
| `tool.fly` | a table | | Drone, air and latency of `cosfly fly`; see [below](#toolfly). Runs do not read it. |
| `stages.NAME` | a table | at least one | A stage; names are `a-z`, `0-9`, `_` and begin with a letter. |
| `stages.NAME.use` | a string | required | Kind of the stage: one of those below. |
| `stages.NAME.for_each` | the name of a list, or a list of names | | The stage is made for each value, as `NAME_VALUE`; `{LIST}` or `{LIST.FIELD}` in a parameter is the value. |
| `stages.NAME.inputs.PORT` | the name of a stage, or a list of names where many are allowed | | Upstream stages of a port. |

Every other key of a stage is a parameter of its kind. Paths are relative to the recipe's folder.
`--set stages.walkers.count=8` on the command line replaces one value; a value that is not TOML is taken as a string.
At a port that takes many stages, items are called `STAGE-ITEM`; at the ports of a dataset they keep their names.
";

/// Text of the reference page in Markdown: inputs and parameters of each kind with type, default, range and meaning.
pub fn reference(registry: &Registry) -> String {
    let mut page = INTRODUCTION.to_owned();
    // Writing to a String cannot fail.
    for kind in registry.iter() {
        let _ = write_kind(kind, &mut page);
    }
    for tool in registry.tools() {
        let doc = tool.schema.get("description").and_then(Value::as_str).unwrap_or_default().replace('\n', " ");
        let _ = writeln!(page, "\n## `[tool.{}]`\n\n{doc}", tool.name)
            .and_then(|()| write_parameters(&tool.schema, &mut page));
    }
    page
}

fn write_kind(kind: &dyn StageKind, page: &mut String) -> std::fmt::Result {
    let name = if kind.name() == FILE_KIND { "wasm:FILE" } else { kind.name() };
    writeln!(page, "\n## `{name}`\n\n{}", kind.doc())?;
    let ports = kind.ports();
    if !ports.is_empty() {
        writeln!(page, "\n| input | takes | items | meaning |\n|---|---|---|---|")?;
        for port in &ports {
            writeln!(page, "| `{}` | {} | {} | {} |", port.name, takes(port), fan_words(port.fan), cell(port.doc))?;
        }
    }
    write_parameters(&kind.schema(), page)
}

/// Table of the parameters of a schema.
fn write_parameters(schema: &Value, page: &mut String) -> std::fmt::Result {
    let mut rows = vec![];
    collect_rows(schema, schema, None, "", 0, &mut rows);
    if rows.is_empty() {
        return writeln!(page, "\nNo parameters.");
    }
    writeln!(page, "\n| parameter | type | default | range | meaning |\n|---|---|---|---|---|")?;
    for row in rows {
        writeln!(page, "| `{}` | {} | {} | {} | {} |", row.name, row.kind, row.default, row.range, row.what)?;
    }
    Ok(())
}

fn takes(port: &InputPort) -> String {
    let many = if port.takes == Takes::One { "" } else { "one or more of " };
    let optional = if port.optional { ", optional" } else { "" };
    format!("{many}`{}`{optional}", port.artifact)
}

fn fan_words(fan: Fan) -> &'static str {
    match fan {
        Fan::Each => "item by item",
        Fan::Broadcast => "its one item, for all",
        Fan::Gather => "all together",
        Fan::Group => "in groups",
    }
}

struct Row {
    name: String,
    kind: String,
    default: String,
    range: String,
    what: String,
}

/// Appends one row per parameter of the table `schema`; nested tables as `a.b`.
fn collect_rows(
    root: &Value,
    schema: &Value,
    defaults: Option<&Value>,
    prefix: &str,
    depth: usize,
    rows: &mut Vec<Row>,
) {
    let table = resolve(root, schema);
    let required: Vec<&str> =
        table.get("required").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str).collect();
    for (key, rule) in table.get("properties").and_then(Value::as_object).into_iter().flatten() {
        if rule.get("const").is_some() {
            continue; // the tag of an alternative is in the prefix
        }
        let name = format!("{prefix}{key}");
        let default = defaults.and_then(|defaults| defaults.get(key)).or_else(|| rule.get("default"));
        let target = nullable_target(root, rule);
        if depth < MOST_LEVELS && target.get("properties").is_some() && alternatives(target).is_empty() {
            let own_default = default.filter(|default| default.is_null());
            rows.push(row(root, rule, &name, own_default, required.contains(&key.as_str())));
            collect_rows(root, target, default, &format!("{name}."), depth + 1, rows);
            continue;
        }
        rows.push(row(root, rule, &name, default, required.contains(&key.as_str())));
        if depth < MOST_LEVELS {
            collect_inner_rows(root, target, &name, depth, rows);
        }
    }
}

/// Appends the rows of tables inside lists, maps and alternatives.
fn collect_inner_rows(root: &Value, target: &Value, name: &str, depth: usize, rows: &mut Vec<Row>) {
    for (keyword, mark) in [("items", "[]."), ("additionalProperties", ".*.")] {
        if let Some(inner) = target.get(keyword).filter(|inner| inner.is_object()) {
            let inner = nullable_target(root, inner);
            collect_rows(root, inner, None, &format!("{name}{mark}"), depth + 1, rows);
            collect_alternatives(root, inner, &format!("{name}{}", mark.trim_end_matches('.')), depth, rows);
        }
    }
    collect_alternatives(root, target, name, depth, rows);
}

fn collect_alternatives(root: &Value, target: &Value, name: &str, depth: usize, rows: &mut Vec<Row>) {
    for alternative in alternatives(target) {
        let alternative = resolve(root, alternative);
        let Some(properties) = alternative.get("properties").and_then(Value::as_object) else { continue };
        let tag = properties.iter().find_map(|(key, rule)| Some(format!("({key} = {})", rule.get("const")?.as_str()?)));
        collect_rows(root, alternative, None, &format!("{name}{}.", tag.unwrap_or_default()), depth + 1, rows);
    }
}

fn row(root: &Value, rule: &Value, name: &str, default: Option<&Value>, required: bool) -> Row {
    let target = resolve(root, rule);
    let default = match default {
        Some(Value::Null) => "none".to_owned(),
        Some(default) => format!("`{}`", cell(&show_toml(default))),
        None if required => "required".to_owned(),
        None => String::new(),
    };
    let description = rule.get("description").or_else(|| target.get("description")).and_then(Value::as_str);
    let mut what = cell(without_default(description.unwrap_or_default(), &default));
    let values = allowed_values(root, rule);
    for (value, doc) in &values {
        if let Some(doc) = doc {
            let _ = write!(what, "{}`{}`: {}", if what.is_empty() { "" } else { "<br>" }, show_json(value), cell(doc));
        }
    }
    let names: Vec<String> = values.iter().map(|(value, _)| format!("`{}`", show_json(value))).collect();
    let range = match tag_values(root, rule) {
        Some(tags) => tags,
        None if names.is_empty() => range(root, rule),
        None => names.join(", "),
    };
    Row { name: name.to_owned(), kind: kind_words(root, rule), default, range: cell(&range), what }
}

/// A description without a last sentence that only repeats the column of defaults.
fn without_default<'a>(description: &'a str, default: &str) -> &'a str {
    let trimmed = description.trim_end();
    match trimmed.rfind("Default ") {
        Some(start) if trimmed[start + 8..].trim_end_matches('.').trim_matches('`') == default.trim_matches('`') => {
            trimmed[..start].trim_end()
        }
        _ => description,
    }
}

/// Type in words; lists name the type of their entries.
fn kind_words(root: &Value, rule: &Value) -> String {
    let target = nullable_target(root, rule);
    let words = type_words_of(root, rule);
    let inner = match target.get("items") {
        Some(items) if words == "a list" => type_words_of(root, items),
        _ => return cell(&words),
    };
    let plural = match inner.as_str() {
        "a table" => "tables",
        "a number" => "numbers",
        "a whole number" => "whole numbers",
        "a string" => "strings",
        "a list" => "lists",
        _ => return cell(&words),
    };
    format!("a list of {plural}")
}

/// Values of the tag that distinguishes the alternatives of a table: `kind`: `none`, `random`.
fn tag_values(root: &Value, rule: &Value) -> Option<String> {
    let mut key = None;
    let mut values = vec![];
    for alternative in alternatives(nullable_target(root, rule)) {
        let properties = resolve(root, alternative).get("properties")?.as_object()?;
        let (name, value) = properties.iter().find_map(|(name, rule)| Some((name, rule.get("const")?.as_str()?)))?;
        key = Some(name);
        values.push(format!("`{value}`"));
    }
    Some(format!("`{}`: {}", key?, values.join(", ")))
}

/// Limits of a number, a text or a list, and of a list's entries.
fn range(root: &Value, rule: &Value) -> String {
    let target = nullable_target(root, rule);
    let limits = [
        ("minimum", "at least "),
        ("exclusiveMinimum", "greater than "),
        ("maximum", "at most "),
        ("exclusiveMaximum", "less than "),
        ("minLength", "characters: at least "),
        ("maxLength", "characters: at most "),
    ];
    let mut words: Vec<String> = limits
        .iter()
        .filter_map(|(key, word)| {
            let limit = target.get(key).or_else(|| rule.get(key)).filter(|limit| limit.is_number())?;
            Some(format!("{word}`{}`", show_json(limit)))
        })
        .collect();
    if let Some(pattern) = target.get("pattern").and_then(Value::as_str) {
        words.push(format!("matches `{pattern}`"));
    }
    match (target.get("minItems"), target.get("maxItems")) {
        (Some(least), Some(most)) if least == most => words.push(format!("exactly `{least}` entries")),
        (Some(least), Some(most)) => words.push(format!("`{least}` to `{most}` entries")),
        (Some(least), None) => words.push(format!("at least `{least}` entries")),
        (None, Some(most)) => words.push(format!("at most `{most}` entries")),
        (None, None) => {}
    }
    if let Some(items) = target.get("items").filter(|items| items.is_object()) {
        let values = allowed_values(root, items);
        let names: Vec<String> = values.iter().map(|(value, _)| format!("`{}`", show_json(value))).collect();
        let inner = if names.is_empty() { range(root, items) } else { names.join(", ") };
        if !inner.is_empty() {
            words.push(format!("each {inner}"));
        }
    }
    words.join(", ")
}

/// Schema behind `$ref` and `anyOf [X, null]`.
fn nullable_target<'a>(root: &'a Value, rule: &'a Value) -> &'a Value {
    let target = resolve(root, rule);
    let mut others = alternatives(target)
        .into_iter()
        .map(|part| resolve(root, part))
        .filter(|part| part.get("type").and_then(Value::as_str) != Some("null"));
    match (others.next(), others.next()) {
        (Some(only), None) => only,
        _ => target,
    }
}

fn alternatives(schema: &Value) -> Vec<&Value> {
    ["anyOf", "oneOf"].iter().filter_map(|keyword| schema.get(keyword).and_then(Value::as_array)).flatten().collect()
}

/// Text for one cell of a Markdown table.
fn cell(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|")
}
