//! `oneOf` and `anyOf`: the intended alternative and its errors.

use super::context::Context;
use super::scalars::not_allowed;
use super::schema_words::{allowed_values, resolve};
use crate::document::{Node, Problems, Value};
use serde_json::Value as Json;

/// Errors to report when none of `candidates` fits: those `found` against the intended alternative, or one error that
/// lists the alternatives.
pub(super) fn mistakes_of_the_meant(
    context: &Context<'_>,
    candidates: &[&Json],
    mut found: Vec<Problems>,
    node: &Node,
    path: &mut Vec<String>,
) -> Problems {
    if let [only] = &mut found[..] {
        return std::mem::take(only);
    }
    if let Some(meant) = meant_alternative(context, candidates, node) {
        return found.swap_remove(meant);
    }
    if let Some(problem) = wrong_tag(context, candidates, node, path) {
        return vec![problem];
    }
    let either = serde_json::json!({ "anyOf": candidates });
    let values = allowed_values(context.root, &either);
    vec![match &node.value {
        Value::Text(_) if !values.is_empty() => not_allowed(context, &either, &values, node, path),
        _ => context.wrong_type(&either, node, path),
    }]
}

/// Index of the alternative whose tag, single key or type is the given one.
fn meant_alternative(context: &Context<'_>, candidates: &[&Json], node: &Node) -> Option<usize> {
    if let Value::Table(table) = &node.value {
        for (index, candidate) in candidates.iter().enumerate() {
            let (tags, keys) = (tags(context.root, candidate), externally_tagged(context.root, candidate));
            let tagged = tags.iter().any(|(tag, value)| {
                table.get(*tag).is_some_and(|entry| entry.node.as_text().is_some_and(|text| text == *value))
            });
            if tagged || keys.is_some_and(|key| table.contains_key(key)) {
                return Some(index);
            }
        }
    }
    let wanted = match &node.value {
        Value::Table(_) => "object",
        Value::Array(_) => "array",
        Value::Integer(_) | Value::Float(_) => "number",
        _ => return None,
    };
    let mut same = candidates.iter().enumerate().filter(|(_, candidate)| {
        let kind = resolve(context.root, candidate).get("type").and_then(Json::as_str);
        kind == Some(wanted) || (wanted == "number" && kind == Some("integer"))
    });
    match (same.next(), same.next()) {
        (Some((index, _)), None) => Some(index),
        _ => None,
    }
}

/// Error of a table without the tag that all alternatives have, or with an unknown value of it.
fn wrong_tag(
    context: &Context<'_>,
    candidates: &[&Json],
    node: &Node,
    path: &mut Vec<String>,
) -> Option<Box<cosfly_diagnose::Diagnostic>> {
    let table = node.as_table()?;
    let (tag, _) = tags(context.root, candidates.first()?).first().copied()?;
    let values: Vec<&str> = candidates
        .iter()
        .map(|candidate| tags(context.root, candidate).iter().find(|(name, _)| *name == tag).map(|(_, value)| *value))
        .collect::<Option<_>>()?;
    let rule = serde_json::json!({ "enum": values });
    match table.get(tag) {
        Some(entry) => {
            path.push(tag.to_owned());
            let problem = not_allowed(context, &rule, &allowed_values(context.root, &rule), &entry.node, path);
            path.pop();
            Some(problem)
        }
        None => {
            let values = crate::document::list(values, usize::MAX);
            let problem = context.problem("recipe-missing-key", &node.place, path, format!("has no `{tag}`"));
            Some(problem.hint(format!("`{tag}` is one of {values}")))
        }
    }
}

/// Properties of a table alternative that allow one text only, and that text.
fn tags<'a>(root: &'a Json, candidate: &'a Json) -> Vec<(&'a str, &'a str)> {
    let properties = resolve(root, candidate).get("properties").and_then(Json::as_object);
    properties
        .into_iter()
        .flatten()
        .filter_map(|(key, rule)| Some((key.as_str(), rule.get("const")?.as_str()?)))
        .collect()
}

/// Only key of an alternative such as `{ fixed = {...} }`.
fn externally_tagged<'a>(root: &'a Json, candidate: &'a Json) -> Option<&'a str> {
    let candidate = resolve(root, candidate);
    let properties = candidate.get("properties")?.as_object()?;
    let mut keys = properties.iter().filter(|(_, rule)| rule.get("const").is_none()).map(|(key, _)| key);
    let required = candidate.get("required")?.as_array()?;
    match (keys.next(), keys.next(), required.len()) {
        (Some(key), None, 1) if properties.len() == 1 => Some(key),
        _ => None,
    }
}
