//! Ranges, lengths and allowed values.

use super::context::Context;
use super::schema_words::{allowed_values, show_json};
use crate::document::{Node, Value, list};
use cosfly_diagnose::{Diagnostic, LARGEST_MAGNITUDE, nearest_name, plausible};
use serde_json::Value as Json;
use std::cmp::Ordering;

/// Checks `minimum`, `maximum`, their exclusive forms, the range of the number's `format`, and that a number with fractions is
/// one that a measurement can have.
pub(super) fn check_number(
    context: &Context<'_>,
    schema: &Json,
    node: &Node,
    path: &[String],
) -> Option<Box<Diagnostic>> {
    let limit = |key: &str| schema.get(key).filter(|limit| limit.is_number());
    let rules = [
        ("minimum", &[Ordering::Greater, Ordering::Equal][..], "at least"),
        ("maximum", &[Ordering::Less, Ordering::Equal][..], "at most"),
        ("exclusiveMinimum", &[Ordering::Greater][..], "greater than"),
        ("exclusiveMaximum", &[Ordering::Less][..], "less than"),
    ];
    let violated = |key: &str, allowed: &[Ordering]| {
        limit(key).is_some_and(|limit| compare(&node.value, limit).is_some_and(|order| !allowed.contains(&order)))
    };
    let wanted = if rules.iter().any(|(key, allowed, _)| violated(key, allowed)) {
        let rules: Vec<String> =
            rules.iter().filter_map(|(key, _, words)| Some(format!("{words} `{}`", show_json(limit(key)?)))).collect();
        rules.join(" and ")
    } else if let Some(range) = schema.get("format").and_then(Json::as_str).and_then(format_range)
        && !(range.0..=range.1).contains(&as_f64(&node.value))
    {
        format!("at least `{}` and at most `{}`", show_number(range.0), show_number(range.1))
    } else if is_measured(schema, &node.value) && plausible(as_f64(&node.value)).is_err() {
        format!("at most `{}` in magnitude, as every number with a unit", show_number(LARGEST_MAGNITUDE))
    } else {
        return None;
    };
    let rest = format!("is `{}`; it must be {wanted}", context.texts.written(&node.place));
    Some(context.documented(context.problem("recipe-out-of-range", &node.place, path, rest), schema, path))
}

/// Whether a value is a number with fractions; whole numbers, such as seeds, have ranges of their own.
fn is_measured(schema: &Json, value: &Value) -> bool {
    matches!(value, Value::Float(_)) || schema.get("type").and_then(Json::as_str) == Some("number")
}

/// Checks `minLength` and `maxLength` (in characters) and `pattern`.
pub(super) fn check_text(
    context: &Context<'_>,
    schema: &Json,
    text: &str,
    node: &Node,
    path: &[String],
) -> Option<Box<Diagnostic>> {
    let length = text.chars().count() as u64;
    let pattern = schema.get("pattern").and_then(Json::as_str);
    let rest = if schema.get("minLength").and_then(Json::as_u64).is_some_and(|least| length < least) {
        match length {
            0 => "is empty; it must not be".to_owned(),
            _ => format!("has {length} characters; it must have at least {}", schema["minLength"]),
        }
    } else if schema.get("maxLength").and_then(Json::as_u64).is_some_and(|most| length > most) {
        format!("has {length} characters; it may have at most {}", schema["maxLength"])
    } else if let Some(pattern) = pattern.filter(|pattern| !matches(pattern, text)) {
        format!("is `{}`; it must match `{pattern}`", context.texts.written(&node.place))
    } else {
        return None;
    };
    Some(context.documented(context.problem("recipe-out-of-range", &node.place, path, rest), schema, path))
}

/// Whether a part of `text` matches `pattern`. An invalid pattern accepts everything; `build` decides then.
fn matches(pattern: &str, text: &str) -> bool {
    regex_lite::Regex::new(pattern).map_or(true, |pattern| pattern.is_match(text))
}

/// Checks `minItems`, `maxItems` and `uniqueItems`.
pub(super) fn check_list_length(
    context: &Context<'_>,
    schema: &Json,
    items: &[Node],
    node: &Node,
    path: &[String],
) -> Option<Box<Diagnostic>> {
    let count = items.len() as u64;
    let least = schema.get("minItems").and_then(Json::as_u64);
    let most = schema.get("maxItems").and_then(Json::as_u64);
    let rest = if least.is_some_and(|least| count < least) || most.is_some_and(|most| count > most) {
        let wanted = match (least, most) {
            (Some(least), Some(most)) if least == most => format!("exactly {least}"),
            (Some(least), Some(most)) => format!("{least} to {most}"),
            (Some(least), None) => format!("at least {least}"),
            (_, most) => format!("at most {}", most.unwrap_or_default()),
        };
        format!("has {count} {}; it must have {wanted}", if count == 1 { "entry" } else { "entries" })
    } else if schema.get("uniqueItems") == Some(&Json::Bool(true)) {
        let mut seen: Vec<Json> = vec![];
        let twice = items.iter().find(|item| {
            let value = item.json();
            let known = seen.contains(&value);
            seen.push(value);
            known
        })?;
        let rest = format!("has `{}` twice", show_json(&twice.json()));
        return Some(context.problem("recipe-out-of-range", &twice.place, path, rest));
    } else {
        return None;
    };
    Some(context.documented(context.problem("recipe-out-of-range", &node.place, path, rest), schema, path))
}

/// Checks `enum` and `const`.
pub(super) fn check_allowed(
    context: &Context<'_>,
    schema: &Json,
    node: &Node,
    path: &[String],
) -> Option<Box<Diagnostic>> {
    if schema.get("enum").is_none() && schema.get("const").is_none() {
        return None;
    }
    let values = allowed_values(context.root, schema);
    let fits = values.iter().any(|(value, _)| match value {
        Json::Number(_) => compare(&node.value, value) == Some(Ordering::Equal),
        _ => &&node.json() == value,
    });
    (!fits).then(|| not_allowed(context, schema, &values, node, path))
}

/// Error of a value that is not among `values`; names the nearest one.
pub(super) fn not_allowed(
    context: &Context<'_>,
    schema: &Json,
    values: &[(&Json, Option<&str>)],
    node: &Node,
    path: &[String],
) -> Box<Diagnostic> {
    let names: Vec<String> = values.iter().map(|(value, _)| show_json(value)).collect();
    let written = node.as_text().map_or_else(|| context.texts.written(&node.place), str::to_owned);
    let wanted = match &names[..] {
        [only] => format!("`{only}`"),
        _ => format!("one of {}", list(names.iter().map(String::as_str), usize::MAX)),
    };
    let short: String = written.chars().take(60).collect();
    let mut problem =
        context.problem("recipe-not-allowed", &node.place, path, format!("is `{short}`; it must be {wanted}"));
    if let Some(near) = nearest_name(&written, names.iter().map(String::as_str)) {
        problem = problem.hint(format!("did you mean `{near}`?"));
    }
    context.documented(problem, schema, path)
}

/// Order of a number and a limit, exact for whole numbers.
fn compare(value: &Value, limit: &Json) -> Option<Ordering> {
    match (value, limit.as_i64()) {
        (Value::Integer(value), Some(limit)) => Some(value.cmp(&limit)),
        (Value::Integer(_), None) if limit.is_u64() => Some(Ordering::Less),
        (Value::Integer(_) | Value::Float(_), _) => as_f64(value).partial_cmp(&limit.as_f64()?),
        _ => None,
    }
}

fn as_f64(value: &Value) -> f64 {
    match value {
        Value::Integer(value) => *value as f64,
        Value::Float(value) => *value,
        _ => 0.0,
    }
}

/// Range of the Rust type behind a number.
fn format_range(format: &str) -> Option<(f64, f64)> {
    Some(match format {
        "uint8" => (0.0, f64::from(u8::MAX)),
        "uint16" => (0.0, f64::from(u16::MAX)),
        "uint32" => (0.0, f64::from(u32::MAX)),
        "uint" | "uint64" => (0.0, u64::MAX as f64),
        "int8" => (f64::from(i8::MIN), f64::from(i8::MAX)),
        "int16" => (f64::from(i16::MIN), f64::from(i16::MAX)),
        "int32" => (f64::from(i32::MIN), f64::from(i32::MAX)),
        "float" => (f64::from(f32::MIN), f64::from(f32::MAX)),
        _ => return None,
    })
}

fn show_number(value: f64) -> String {
    if value.abs() < 1e16 { format!("{value}") } else { format!("{value:e}") }
}
