//! `oneOf` and `anyOf`: which alternative was meant, and what is wrong with it.

use super::check::Walk;
use super::scalars::not_allowed;
use super::schema_words::{allowed_values, is_null, resolve};
use crate::document::{Node, Problems, Value};
use serde_json::Value as Json;

/// Passes when one alternative fits; else reports against the one that was most likely meant.
pub(super) fn check_alternatives(
    walk: &Walk<'_>,
    alternatives: &[Json],
    node: &Node,
    path: &mut Vec<String>,
    problems: &mut Problems,
) {
    let candidates: Vec<&Json> = alternatives.iter().filter(|alternative| !is_null(walk.root, alternative)).collect();
    let mut found = vec![];
    for candidate in &candidates {
        let mut wrong = Problems::new();
        walk.check(candidate, node, path, &mut wrong);
        if wrong.is_empty() {
            return;
        }
        found.push(wrong);
    }
    if let [only] = &mut found[..] {
        problems.append(only);
        return;
    }
    if let Some(meant) = meant_alternative(walk, &candidates, node) {
        problems.append(&mut found[meant]);
        return;
    }
    if let Some(problem) = wrong_tag(walk, &candidates, node, path) {
        problems.push(problem);
        return;
    }
    let either = serde_json::json!({ "anyOf": candidates });
    let values = allowed_values(walk.root, &either);
    problems.push(match &node.value {
        Value::Text(_) if !values.is_empty() => not_allowed(walk, &either, &values, node, path),
        _ => walk.wrong_type(&either, node, path),
    });
}

/// The alternative whose tag, single key or type is the given one.
fn meant_alternative(walk: &Walk<'_>, candidates: &[&Json], node: &Node) -> Option<usize> {
    if let Value::Table(table) = &node.value {
        for (index, candidate) in candidates.iter().enumerate() {
            let (tags, keys) = (tags(walk.root, candidate), externally_tagged(walk.root, candidate));
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
        let kind = resolve(walk.root, candidate).get("type").and_then(Json::as_str);
        kind == Some(wanted) || (wanted == "number" && kind == Some("integer"))
    });
    match (same.next(), same.next()) {
        (Some((index, _)), None) => Some(index),
        _ => None,
    }
}

/// All alternatives carry one tag, and the given table lacks it or gives it an unknown value.
fn wrong_tag(
    walk: &Walk<'_>,
    candidates: &[&Json],
    node: &Node,
    path: &mut Vec<String>,
) -> Option<Box<cosfly_diagnose::Diagnostic>> {
    let table = node.as_table()?;
    let (tag, _) = tags(walk.root, candidates.first()?).first().copied()?;
    let values: Vec<&str> = candidates
        .iter()
        .map(|candidate| tags(walk.root, candidate).iter().find(|(name, _)| *name == tag).map(|(_, value)| *value))
        .collect::<Option<_>>()?;
    let rule = serde_json::json!({ "enum": values });
    match table.get(tag) {
        Some(entry) => {
            path.push(tag.to_owned());
            let problem = not_allowed(walk, &rule, &allowed_values(walk.root, &rule), &entry.node, path);
            path.pop();
            Some(problem)
        }
        None => {
            let values = crate::document::list(values, usize::MAX);
            let problem = walk.problem("recipe-missing-key", &node.place, path, format!("has no `{tag}`"));
            Some(problem.hint(format!("`{tag}` is one of {values}")))
        }
    }
}

/// Properties of a table alternative that have one fixed text: (key, text).
fn tags<'a>(root: &'a Json, candidate: &'a Json) -> Vec<(&'a str, &'a str)> {
    let properties = resolve(root, candidate).get("properties").and_then(Json::as_object);
    properties
        .into_iter()
        .flatten()
        .filter_map(|(key, rule)| Some((key.as_str(), rule.get("const")?.as_str()?)))
        .collect()
}

/// The only key of an alternative such as `{ fixed = {...} }`.
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
