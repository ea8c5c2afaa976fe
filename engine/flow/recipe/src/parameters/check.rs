//! The walk over a value and its schema.

use super::alternatives::check_alternatives;
use super::scalars::{check_allowed, check_list_length, check_number, check_text};
use super::schema_words::{first_sentence, is_open, resolve, rule_at, show_toml, type_words_of};
use crate::document::{Node, Place, Problems, Table, Texts, Value, list};
use cosfly_diagnose::{Diagnostic, nearest_name};
use serde_json::Value as Json;

/// What is being checked, for messages.
pub(crate) struct Subject<'a> {
    /// Stage in the recipe.
    pub(crate) stage: &'a str,
    /// Its kind.
    pub(crate) kind: &'a str,
    /// Where the stage's name is written.
    pub(crate) place: &'a Place,
    /// Ports of the kind, for the hint when one is written among the parameters.
    pub(crate) ports: &'a [&'a str],
}

/// Schema, subject and texts: what every step of the walk needs.
pub(super) struct Walk<'a> {
    pub(super) root: &'a Json,
    pub(super) subject: &'a Subject<'a>,
    pub(super) texts: &'a Texts,
}

/// Every violation of `schema` by a stage's `parameters`.
pub(crate) fn check_parameters(schema: &Json, parameters: &Node, subject: &Subject<'_>, texts: &Texts) -> Problems {
    let walk = Walk { root: schema, subject, texts };
    let mut problems = Problems::new();
    walk.check(schema, parameters, &mut vec![], &mut problems);
    problems
}

impl Walk<'_> {
    /// Checks `node` at `path` and appends what is wrong.
    pub(super) fn check(&self, schema: &Json, node: &Node, path: &mut Vec<String>, problems: &mut Problems) {
        let Json::Object(keywords) = schema else {
            if schema == &Json::Bool(false) {
                problems.push(self.problem("recipe-unknown-key", &node.place, path, "may not be given"));
            }
            return;
        };
        if matches!(node.value, Value::Refused) {
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
                check_alternatives(self, alternatives, node, path, problems);
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

    /// A message that begins with the value's path in back-ticks, at `place`, with the parameter's documentation.
    pub(super) fn problem(
        &self,
        code: &'static str,
        place: &Place,
        path: &[String],
        rest: impl AsRef<str>,
    ) -> Box<Diagnostic> {
        self.texts.problem(code, place, format!("`{}` {}", self.name(path), rest.as_ref()))
    }

    /// The path of a value; the stage's own table has the stage's name.
    pub(super) fn name(&self, path: &[String]) -> String {
        if path.is_empty() { format!("stages.{}", self.subject.stage) } else { path.join(".") }
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

    /// What was given and what is wanted.
    pub(super) fn wrong_type(&self, schema: &Json, node: &Node, path: &[String]) -> Box<Diagnostic> {
        let wanted = type_words_of(self.root, schema);
        let given = match &node.value {
            Value::Table(_) | Value::Array(_) => node.type_words().to_owned(),
            Value::Text(_) => format!("the string `{}`", self.texts.written(&node.place)),
            Value::Float(_) if wanted.contains("whole") => format!("`{}`", self.texts.written(&node.place)),
            _ => format!("`{}`, {}", self.texts.written(&node.place), node.type_words()),
        };
        let problem = self.problem("recipe-wrong-type", &node.place, path, format!("is {given}; it must be {wanted}"));
        let text_wanted = wanted.starts_with("a string");
        let problem = match &node.value {
            Value::Text(text) if !text_wanted && text.trim().parse::<f64>().is_ok_and(f64::is_finite) => {
                problem.hint(format!("leave the quotes away: `{}`", text.trim()))
            }
            Value::Text(text) if text == "true" || text == "false" => {
                problem.hint(format!("leave the quotes away: `{text}`"))
            }
            Value::Integer(_) | Value::Float(_) | Value::Bool(_) if text_wanted => problem.hint("put it in quotes"),
            _ => problem,
        };
        self.documented(problem, schema, path)
    }

    /// Adds what the parameter means and its default, when the schema says so.
    pub(super) fn documented(&self, problem: Box<Diagnostic>, schema: &Json, path: &[String]) -> Box<Diagnostic> {
        let rule = rule_at(self.root, path).unwrap_or(schema);
        let Some(sentence) = rule
            .get("description")
            .or_else(|| resolve(self.root, rule).get("description"))
            .and_then(Json::as_str)
            .map(first_sentence)
            .filter(|_| !path.is_empty())
        else {
            return problem;
        };
        let default = match rule.get("default") {
            Some(default) if !default.is_object() && !default.is_null() => {
                format!(" (default `{}`)", show_toml(default))
            }
            _ => String::new(),
        };
        problem.hint(format!("`{}`: {sentence}{default}", self.name(path)))
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
                problems.push(self.unknown_key(known, key, &entry.key, path));
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

    fn unknown_key(
        &self,
        known: Option<&serde_json::Map<String, Json>>,
        key: &str,
        place: &Place,
        path: &[String],
    ) -> Box<Diagnostic> {
        let Subject { stage, kind, ports, .. } = self.subject;
        let names = || known.into_iter().flatten().map(|(name, _)| name.as_str());
        let owner = if path.is_empty() { format!("`{kind}`") } else { format!("`{}` of `{kind}`", path.join(".")) };
        let mut problem =
            self.texts.problem("recipe-unknown-key", place, format!("`{key}` is not a parameter of {owner}"));
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
        problem.hint(format!("{owner} knows {}", list(names(), usize::MAX)))
    }
}
