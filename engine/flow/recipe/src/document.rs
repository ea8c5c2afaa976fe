//! The recipe as a tree of values with their places in the text.

use cosfly_diagnose::{Diagnostic, Fault, Label};
use serde_json::{Map, Number};
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

/// A text that values come from.
#[derive(Clone, Debug)]
struct Text {
    path: PathBuf,
    text: Arc<str>,
}

/// The recipe's text (first) and the `--set` arguments.
#[derive(Clone, Debug)]
pub(crate) struct Texts(Vec<Text>);

/// Range of bytes in one of the texts.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Place {
    pub(crate) text: usize,
    pub(crate) start: usize,
    pub(crate) end: usize,
}

/// A value and its place.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub(crate) place: Place,
    pub(crate) value: Value,
}

/// Value of a node.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Bool(bool),
    Integer(i64),
    Float(f64),
    Text(String),
    Array(Vec<Node>),
    Table(Table),
    /// A value with an error that is already reported; every check accepts it.
    Refused,
}

/// Entries by key.
pub(crate) type Table = BTreeMap<String, Entry>;

/// A key and its value.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub(crate) key: Place,
    pub(crate) node: Node,
}

/// Errors found so far.
pub(crate) type Problems = Vec<Box<Diagnostic>>;

impl Texts {
    pub(crate) fn new(path: PathBuf, text: Arc<str>) -> Self {
        Self(vec![Text { path, text }])
    }

    /// Adds a `--set` argument; returns its number.
    pub(crate) fn add_override(&mut self, argument: &str) -> usize {
        self.0.push(Text { path: PathBuf::from("--set"), text: argument.into() });
        self.0.len() - 1
    }

    pub(crate) fn label(&self, place: &Place, note: impl Into<String>) -> Label {
        let Text { path, text } = &self.0[place.text];
        Label { path: path.clone(), text: text.clone(), span: place.start..place.end, note: note.into() }
    }

    /// Text at `place`, shortened to one line for a message.
    pub(crate) fn written(&self, place: &Place) -> String {
        let text = self.0[place.text].text.get(place.start..place.end).unwrap_or_default();
        let line = text.lines().next().unwrap_or_default().trim_end();
        let short: String = line.chars().take(60).collect();
        if short.len() < text.len() { format!("{short}...") } else { short }
    }

    /// Creates a diagnostic for an error in the recipe at `place`.
    pub(crate) fn problem(&self, code: &'static str, place: &Place, message: impl Into<String>) -> Box<Diagnostic> {
        Diagnostic::new(code, Fault::Recipe, message).at(self.label(place, ""))
    }
}

impl Place {
    pub(crate) fn new(text: usize, span: Range<usize>) -> Self {
        Self { text, start: span.start, end: span.end }
    }
}

impl Node {
    pub(crate) fn as_text(&self) -> Option<&str> {
        match &self.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    pub(crate) fn as_table(&self) -> Option<&Table> {
        match &self.value {
            Value::Table(table) => Some(table),
            _ => None,
        }
    }

    /// Type of the value in words.
    pub(crate) fn type_words(&self) -> &'static str {
        match self.value {
            Value::Bool(_) => "a boolean",
            Value::Integer(_) => "a whole number",
            Value::Float(_) => "a number",
            Value::Text(_) => "a string",
            Value::Array(_) => "a list",
            Value::Table(_) => "a table",
            Value::Refused => "nothing",
        }
    }

    /// The value as JSON, without places; tables have sorted keys.
    pub(crate) fn json(&self) -> serde_json::Value {
        match &self.value {
            Value::Bool(value) => (*value).into(),
            Value::Integer(value) => (*value).into(),
            Value::Float(value) => Number::from_f64(*value).map_or(serde_json::Value::Null, Into::into),
            Value::Text(value) => value.as_str().into(),
            Value::Array(values) => values.iter().map(Node::json).collect(),
            Value::Table(table) => table_json(table).into(),
            Value::Refused => serde_json::Value::Null,
        }
    }

    /// Node at `path` below this one, or the deepest existing one on the way there.
    pub(crate) fn deepest<'a>(&self, path: impl IntoIterator<Item = &'a str>) -> &Node {
        let mut node = self;
        for key in path {
            let next = match &node.value {
                Value::Table(table) => table.get(key).map(|entry| &entry.node),
                Value::Array(items) => key.parse().ok().and_then(|index: usize| items.get(index)),
                _ => None,
            };
            match next {
                Some(next) => node = next,
                None => break,
            }
        }
        node
    }
}

/// A table as JSON, without places.
pub(crate) fn table_json(table: &Table) -> Map<String, serde_json::Value> {
    table.iter().map(|(key, entry)| (key.clone(), entry.node.json())).collect()
}

/// Names in back-ticks, separated by commas, at most `most` of them.
pub(crate) fn list<T: fmt::Display>(names: impl IntoIterator<Item = T>, most: usize) -> String {
    let names: Vec<T> = names.into_iter().collect();
    let mut shown: Vec<String> = names.iter().take(most).map(|name| format!("`{name}`")).collect();
    if names.len() > most {
        shown.push(format!("and {} more", names.len() - most));
    }
    shown.join(", ")
}
