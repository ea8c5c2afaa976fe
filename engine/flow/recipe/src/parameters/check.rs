//! Checks a value against a schema.

use super::alternatives::mistakes_of_the_meant;
use super::context::{Context, Subject};
use super::scalars::{check_allowed, check_list_length, check_number, check_text};
use super::schema_words::{is_null, is_open, resolve};
use crate::document::{Node, Place, Problems, Table, Texts, Value, list};
use cosfly_diagnose::{Diagnostic, nearest_name};
use serde_json::Value as Json;

/// All violations of `schema` by the `parameters` of a stage.
pub(crate) fn check_parameters(schema: &Json, parameters: &Node, subject: &Subject<'_>, texts: &Texts) -> Problems {
    let context = Context { root: schema, subject, texts };
    let mut problems = Problems::new();
    context.check(schema, parameters, &mut vec![], &mut problems);
    problems
}

impl Context<'_> {
    /// Checks `node` at `path` and appends the errors.
    fn check(&self, schema: &Json, node: &Node, path: &mut Vec<String>, problems: &mut Problems) {
        let Json::Object(keywords) = schema else {
            if schema == &Json::Bool(false) {
                problems.push(self.problem("recipe-unknown-key", &node.place, path, "may not be given"));
            }
            return;
        };
        if matches!(node.value, Value::Refused) {
            return;
        }
        if keywords.get("not").and_then(Json::as_object).is_some_and(serde_json::Map::is_empty) {
            // The way to say `false` with a reason.
            let reason = keywords.get("description").and_then(Json::as_str).unwrap_or("may not be given");
            problems.push(self.problem("recipe-unknown-key", &node.place, path, reason));
            return;
        }
        if keywords.contains_key("$ref") {
            let target = resolve(self.root, schema);
            if target.get("$ref").is_none() {
                let before = problems.len();
                self.check(target, node, path, problems);
                if problems.len() > before {
                    return;
                }
            }
        }
        for part in keywords.get("allOf").and_then(Json::as_array).into_iter().flatten() {
            self.check(part, node, path, problems);
        }
        for keyword in ["anyOf", "oneOf"] {
            if let Some(alternatives) = keywords.get(keyword).and_then(Json::as_array) {
                self.check_alternatives(alternatives, node, path, problems);
            }
        }
        if let Some(problem) = self.check_type(schema, node, path) {
            problems.push(problem);
            return;
        }
        problems.extend(check_allowed(self, schema, node, path));
        match &node.value {
            Value::Integer(_) | Value::Float(_) => problems.extend(check_number(self, schema, node, path)),
            Value::Text(text) => problems.extend(check_text(self, schema, text, node, path)),
            Value::Array(items) => {
                problems.extend(check_list_length(self, schema, items, node, path));
                self.check_items(schema, items, path, problems);
            }
            Value::Table(table) => self.check_table(schema, table, node, path, problems),
            Value::Bool(_) | Value::Refused => {}
        }
    }

    /// Passes when one alternative fits; otherwise reports the errors against the intended one.
    fn check_alternatives(&self, alternatives: &[Json], node: &Node, path: &mut Vec<String>, problems: &mut Problems) {
        // TOML cannot write null.
        let candidates: Vec<&Json> = alternatives.iter().filter(|it| !is_null(self.root, it)).collect();
        let mut found = vec![];
        for candidate in &candidates {
            let mut wrong = Problems::new();
            self.check(candidate, node, path, &mut wrong);
            if wrong.is_empty() {
                return;
            }
            found.push(wrong);
        }
        problems.extend(mistakes_of_the_meant(self, &candidates, found, node, path));
    }

    fn check_type(&self, schema: &Json, node: &Node, path: &[String]) -> Option<Box<Diagnostic>> {
        let wanted: Vec<&str> = match schema.get("type")? {
            Json::String(name) => vec![name],
            Json::Array(names) => names.iter().filter_map(Json::as_str).collect(),
            _ => return None,
        };
        let fits = wanted.iter().any(|name| {
            matches!(
                (&node.value, *name),
                (Value::Bool(_), "boolean")
                    | (Value::Integer(_), "integer" | "number")
                    | (Value::Float(_), "number")
                    | (Value::Text(_), "string")
                    | (Value::Array(_), "array")
                    | (Value::Table(_), "object")
            )
        });
        (!fits).then(|| self.wrong_type(schema, node, path))
    }

    fn check_items(&self, schema: &Json, items: &[Node], path: &mut Vec<String>, problems: &mut Problems) {
        let leading = schema.get("prefixItems").and_then(Json::as_array).map_or(&[][..], Vec::as_slice);
        for (index, item) in items.iter().enumerate() {
            if let Some(rule) = leading.get(index).or_else(|| schema.get("items")) {
                path.push(index.to_string());
                self.check(rule, item, path, problems);
                path.pop();
            }
        }
    }

    fn check_table(&self, schema: &Json, table: &Table, node: &Node, path: &mut Vec<String>, problems: &mut Problems) {
        let known = schema.get("properties").and_then(Json::as_object);
        for (key, entry) in table {
            path.push(key.clone());
            if let Some(rule) = known.and_then(|known| known.get(key)) {
                self.check(rule, &entry.node, path, problems);
            } else if !is_open(schema) {
                path.pop();
                problems.push(self.unknown_key(schema, key, &entry.key, path));
                continue;
            } else if let Some(rule) = schema.get("additionalProperties") {
                self.check(rule, &entry.node, path, problems);
            }
            path.pop();
        }
        for key in schema.get("required").and_then(Json::as_array).into_iter().flatten().filter_map(Json::as_str) {
            if !table.contains_key(key) {
                let place = if path.is_empty() { self.subject.place } else { &node.place };
                let rule = known.and_then(|known| known.get(key)).unwrap_or(&Json::Null);
                let message = format!("`{}` has no `{key}`", self.name(path));
                let problem = self.texts.problem("recipe-missing-key", place, message);
                path.push(key.to_owned());
                problems.push(self.documented(problem, rule, path));
                path.pop();
            }
        }
    }

    fn unknown_key(&self, schema: &Json, key: &str, place: &Place, path: &[String]) -> Box<Diagnostic> {
        let Subject { stage, kind, ports, .. } = self.subject;
        let known = schema.get("properties").and_then(Json::as_object);
        let names = || known.into_iter().flatten().map(|(name, _)| name.as_str());
        let owner = if path.is_empty() { format!("`{kind}`") } else { format!("`{}` of `{kind}`", path.join(".")) };
        let mut problem =
            self.texts.problem("recipe-unknown-key", place, format!("`{key}` is not a parameter of {owner}"));
        // Keys that were there once, each with the way out.
        if let Some(hint) = schema.get("x-gone").and_then(|gone| gone.get(key)).and_then(Json::as_str) {
            return problem.hint(hint);
        }
        if let Some(near) = nearest_name(key, names()) {
            problem = problem.hint(format!("did you mean `{near}`?"));
        } else if path.is_empty() && ports.contains(&key) {
            problem = problem.hint(format!("`{key}` is an input: write `inputs.{key} = ...` in `[stages.{stage}]`"));
        } else if path.is_empty()
            && let Some(near) = nearest_name(key, ["use", "inputs"])
        {
            problem = problem.hint(format!("did you mean `{near}`?"));
        }
        if names().next().is_none() {
            return problem.hint(format!("{owner} has no parameters"));
        }
        problem.hint(format!("parameters of {owner}: {}", list(names(), usize::MAX)))
    }
}
