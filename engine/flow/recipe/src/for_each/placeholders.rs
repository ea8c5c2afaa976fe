//! `{LIST}` and `{LIST.FIELD}` in the table of a stage.

use super::lists::{Choice, Lists};
use crate::document::{Node, Place, Problems, Texts, Value, list};
use cosfly_diagnose::nearest_name;
use std::collections::BTreeSet;

/// Replaces placeholders by the values chosen for one stage.
pub(super) struct Filler<'a> {
    pub(super) lists: &'a Lists,
    pub(super) choices: &'a [Choice],
    pub(super) texts: &'a Texts,
    pub(super) problems: &'a mut Problems,
    /// Fields of lists that were read: `(list, field)`.
    pub(super) read: &'a mut BTreeSet<(String, String)>,
}

impl Filler<'_> {
    /// Fills a value: a text that is one placeholder becomes the value itself, number or table.
    pub(super) fn fill(&mut self, node: &mut Node) {
        match &mut node.value {
            Value::Array(nodes) => nodes.iter_mut().for_each(|node| self.fill(node)),
            Value::Table(table) => table.values_mut().for_each(|entry| self.fill(&mut entry.node)),
            Value::Text(text) if text.contains('{') => {
                let text = std::mem::take(text);
                *node = self.filled(&text, &node.place);
            }
            _ => {}
        }
    }

    fn filled(&mut self, text: &str, place: &Place) -> Node {
        let refused = || Node { place: place.clone(), value: Value::Refused };
        let mut out = String::new();
        let mut rest = text;
        while let Some(start) = rest.find('{') {
            let Some(end) = rest[start..].find('}').map(|at| start + at) else { break };
            let inside = &rest[start + 1..end];
            out.push_str(&rest[..start]);
            match self.value_of(inside, place) {
                // Braces of other meanings, such as `{towns}` in a title.
                None => out.push_str(&rest[start..=end]),
                Some(Err(())) => return refused(),
                Some(Ok(value)) if out.is_empty() && rest.len() == text.len() && end + 1 == text.len() => return value,
                Some(Ok(value)) => match words(&value) {
                    Some(words) => out.push_str(&words),
                    None => {
                        let message =
                            format!("`{{{inside}}}` is {}, which has no place within a text", value.type_words());
                        self.problems.push(self.texts.problem("recipe-list-value", place, message));
                        return refused();
                    }
                },
            }
            rest = &rest[end + 1..];
        }
        out.push_str(rest);
        Node { place: place.clone(), value: Value::Text(out) }
    }

    /// Value of a placeholder; none when it names no list, an error when it is reported.
    fn value_of(&mut self, inside: &str, place: &Place) -> Option<Result<Node, ()>> {
        let (name, field) = match inside.split_once('.') {
            Some((name, field)) => (name, Some(field)),
            None => (inside, None),
        };
        self.lists.get(name)?;
        let Some(choice) = self.choices.iter().find(|choice| choice.list == name) else {
            let message =
                format!("`{{{inside}}}` is a value of the list `{name}`, but the stage is not made for each of them");
            let problem = self.texts.problem("recipe-unknown-list", place, message);
            self.problems.push(problem.hint(format!("add `for_each = \"{name}\"` to the stage")));
            return Some(Err(()));
        };
        let Some(field) = field else {
            return Some(match &choice.node.value {
                Value::Table(table) => {
                    let message = format!("`{{{name}}}` is a table");
                    let fields = list(table.keys().map(|key| format!("{{{name}.{key}}}")), 20);
                    let problem = self.texts.problem("recipe-list-value", place, message);
                    self.problems.push(problem.hint(format!("write one of {fields}")));
                    Err(())
                }
                _ => Ok(choice.node.clone()),
            });
        };
        let first = field.split('.').next().unwrap_or_default();
        self.read.insert((name.to_owned(), first.to_owned()));
        let mut node = &choice.node;
        for key in field.split('.') {
            match node.as_table().and_then(|table| table.get(key)) {
                Some(entry) => node = &entry.node,
                None => {
                    self.problems.push(self.lacking(choice, (inside, key), node, place));
                    return Some(Err(()));
                }
            }
        }
        Some(Ok(node.clone()))
    }

    /// Error for a value without the field that a stage reads.
    fn lacking(
        &self,
        choice: &Choice,
        (inside, key): (&str, &str),
        node: &Node,
        place: &Place,
    ) -> Box<cosfly_diagnose::Diagnostic> {
        let message = format!("`{}` of the list `{}` has no `{key}`", choice.label, choice.list);
        let problem = self.texts.problem("recipe-list-value", &choice.node.place, message);
        let problem = problem.at(self.texts.label(place, format!("`{{{inside}}}` is read here")));
        let Some(table) = node.as_table() else {
            return problem
                .hint(format!("write the value as a table: `{{ name = \"{}\", {key} = ... }}`", choice.label));
        };
        match nearest_name(key, table.keys().map(String::as_str)) {
            Some(near) => problem.hint(format!("did you mean `{near}`?")),
            None => problem.hint(format!("its fields are {}", list(table.keys(), 20))),
        }
    }
}

/// A value within a text.
fn words(node: &Node) -> Option<String> {
    match &node.value {
        Value::Text(text) => Some(text.clone()),
        Value::Integer(value) => Some(value.to_string()),
        Value::Float(value) => Some(value.to_string()),
        Value::Bool(value) => Some(value.to_string()),
        Value::Array(_) | Value::Table(_) | Value::Refused => None,
    }
}
