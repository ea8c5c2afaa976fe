//! Context of a check, and the messages shared by all checks.

use super::schema_words::{first_sentence, resolve, rule_at, show_toml, type_words_of};
use crate::document::{Node, Place, Texts, Value};
use cosfly_diagnose::Diagnostic;
use serde_json::Value as Json;

/// Stage whose parameters are checked, for messages.
pub(crate) struct Subject<'a> {
    /// Name of the table that is checked, such as `stages.frames`.
    pub(crate) table: &'a str,
    /// Name of the stage in the recipe.
    pub(crate) stage: &'a str,
    /// Kind of the stage.
    pub(crate) kind: &'a str,
    /// Place of the stage's name.
    pub(crate) place: &'a Place,
    /// Ports of the kind, for the hint where a port is written among the parameters.
    pub(crate) ports: &'a [&'a str],
}

/// Schema, subject and texts for all checks.
pub(super) struct Context<'a> {
    pub(super) root: &'a Json,
    pub(super) subject: &'a Subject<'a>,
    pub(super) texts: &'a Texts,
}

impl Context<'_> {
    /// Creates a diagnostic at `place` whose message begins with the value's path in back-ticks, with the parameter's
    /// documentation.
    pub(super) fn problem(
        &self,
        code: &'static str,
        place: &Place,
        path: &[String],
        rest: impl AsRef<str>,
    ) -> Box<Diagnostic> {
        self.texts.problem(code, place, format!("`{}` {}", self.name(path), rest.as_ref()))
    }

    /// Path of a value; the whole table has its name.
    pub(super) fn name(&self, path: &[String]) -> String {
        if path.is_empty() { self.subject.table.to_owned() } else { path.join(".") }
    }

    /// Error of a value of the wrong type: the given and the expected type.
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
                problem.hint(format!("leave out the quotes: `{}`", text.trim()))
            }
            Value::Text(text) if text == "true" || text == "false" => {
                problem.hint(format!("leave out the quotes: `{text}`"))
            }
            Value::Integer(_) | Value::Float(_) | Value::Bool(_) if text_wanted => problem.hint("put it in quotes"),
            _ => problem,
        };
        self.documented(problem, schema, path)
    }

    /// Adds the meaning and the default of the parameter, where the schema gives them.
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
}
