//! Parses TOML text into the tree with places; the only file that uses the `toml` crate.

use crate::document::{Entry, Node, Place, Problems, Table, Texts, Value};
use cosfly_diagnose::{Diagnostic, counted};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

/// Deepest nesting of tables: no recipe needs more, and every check recurses.
const MOST_LEVELS: usize = 32;
/// Longest text, bytes.
const MOST_BYTES: usize = 4 << 20;
/// Most syntax errors that are reported: one error often causes others further down.
const MOST_SYNTAX_ERRORS: usize = 5;

/// Parses the recipe's root table.
pub(crate) fn parse_document(text: &str, texts: &Texts, problems: &mut Problems) -> Option<Table> {
    if let Some(message) = too_long(text) {
        problems.push(texts.problem("recipe-syntax", &Place::new(0, 0..0), message));
        return None;
    }
    let (root, errors) = DeTable::parse_recoverable(text);
    if !errors.is_empty() {
        problems.extend(syntax_problems(&errors, text, texts));
        return None;
    }
    let mut reader = TreeReader { text: 0, offset: 0, texts, problems };
    Some(reader.table(root.get_ref(), &mut vec![]))
}

/// Parses the value of a `--set`, which starts at byte `offset` of text number `text`.
pub(crate) fn parse_value(
    value: &str,
    path: &[String],
    (text, offset): (usize, usize),
    texts: &Texts,
    problems: &mut Problems,
) -> Option<Node> {
    let whole = Place::new(text, offset..offset + value.len());
    if value.is_empty() {
        let problem = texts.problem("override-syntax", &Place::new(text, 0..offset), "there is no value after `=`");
        problems.push(problem.hint("an empty text is written `\"\"`"));
        return None;
    }
    let parsed = match too_long(value) {
        Some(message) => Err(message),
        None => DeValue::parse(value).map_err(|error| error.message().to_owned()),
    };
    match parsed {
        // Quotes inside shell quotes are easily forgotten: `--set stages.tables.released=2026-05-01` means the text.
        Ok(parsed) if parsed.get_ref().is_datetime() => {
            Some(Node { place: whole, value: Value::Text(value.to_owned()) })
        }
        Ok(parsed) => {
            let mut reader = TreeReader { text, offset, texts, problems };
            Some(reader.node(&parsed, &mut path.to_vec()))
        }
        Err(message) if value.starts_with(['"', '\'', '[', '{']) => {
            let problem =
                texts.problem("override-syntax", &whole, format!("`{}` is not a TOML value", texts.written(&whole)));
            problems.push(problem.because(message));
            None
        }
        Err(_) => Some(Node { place: whole, value: Value::Text(value.to_owned()) }),
    }
}

/// Message for a text that is too long. (The parser limits the depth itself.)
fn too_long(text: &str) -> Option<String> {
    (text.len() > MOST_BYTES)
        .then(|| format!("the text has {}; a recipe may have {MOST_BYTES}", counted(text.len(), "byte")))
}

/// First error of every line, without those that follow from a broken table header above them.
fn syntax_problems(errors: &[Error], text: &str, texts: &Texts) -> Problems {
    let mut problems = Problems::new();
    let (mut last_line, mut broken_table) = (None, None);
    for error in errors {
        let span = error.span().unwrap_or(text.len()..text.len());
        let before = text.get(..span.start).unwrap_or(text);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let headers = text[..line_start].lines().filter(|line| line.starts_with('[')).count();
        if last_line == Some(line_start) || broken_table == Some(headers) {
            continue;
        }
        last_line = Some(line_start);
        if text[line_start..].starts_with('[') {
            broken_table = Some(headers + 1);
        }
        let place = Place::new(0, span);
        problems.push(match error.message() {
            "duplicate key" => given_twice(&place, line_start, text, texts),
            message => texts.problem("recipe-syntax", &place, message),
        });
    }
    problems.truncate(MOST_SYNTAX_ERRORS);
    problems
}

/// Error of a key that is given twice in its table; the first place is shown as well, where a line begins with the key.
fn given_twice(place: &Place, line_start: usize, text: &str, texts: &Texts) -> Box<Diagnostic> {
    let problem = texts.problem("recipe-syntax", place, format!("`{}` is given twice", texts.written(place)));
    let Some(key) = text.get(line_start..place.end) else { return problem };
    let section = if key.starts_with('[') { 0 } else { text[..line_start].rfind("\n[").unwrap_or(0) };
    let mut start = section;
    for line in text[section..line_start].split_inclusive('\n') {
        if line.strip_prefix(key).is_some_and(|rest| rest.starts_with([' ', '\t', '=', '.', ']'])) {
            let span = start + (place.start - line_start)..start + key.len();
            return problem.at(texts.label(&Place::new(0, span), "first here"));
        }
        start += line.len();
    }
    problem
}

struct TreeReader<'a> {
    text: usize,
    offset: usize,
    texts: &'a Texts,
    problems: &'a mut Problems,
}

impl TreeReader<'_> {
    fn place(&self, span: Range<usize>) -> Place {
        Place::new(self.text, span.start + self.offset..span.end + self.offset)
    }

    fn table(&mut self, table: &DeTable<'_>, path: &mut Vec<String>) -> Table {
        let mut entries = Table::new();
        for (key, value) in table {
            path.push(key.get_ref().to_string());
            let node = self.node(value, path);
            path.pop();
            entries.insert(key.get_ref().to_string(), Entry { key: self.place(key.span()), node });
        }
        entries
    }

    fn node(&mut self, value: &Spanned<DeValue<'_>>, path: &mut Vec<String>) -> Node {
        let place = self.place(value.span());
        let value = if path.len() > MOST_LEVELS {
            let message = format!("tables and lists are nested more than {MOST_LEVELS} deep");
            self.refuse(self.texts.problem("recipe-too-deep", &place, message))
        } else {
            self.value(value.get_ref(), &place, path)
        };
        Node { place, value }
    }

    fn value(&mut self, value: &DeValue<'_>, place: &Place, path: &mut Vec<String>) -> Value {
        match value {
            DeValue::String(text) => Value::Text(text.to_string()),
            DeValue::Boolean(value) => Value::Bool(*value),
            DeValue::Integer(digits) => match i64::from_str_radix(digits.as_str(), digits.radix()) {
                Ok(value) => Value::Integer(value),
                Err(_) => {
                    let message = format!(
                        "`{}` is `{}`; whole numbers must fit into 64 bits with a sign",
                        path.join("."),
                        digits.as_str()
                    );
                    self.refuse(self.texts.problem("recipe-out-of-range", place, message))
                }
            },
            DeValue::Float(digits) => match digits.as_str().parse::<f64>() {
                Ok(value) if value.is_finite() => Value::Float(value),
                _ => {
                    let message =
                        format!("`{}` is `{}`; numbers must be finite", path.join("."), self.texts.written(place));
                    self.refuse(self.texts.problem("recipe-not-finite", place, message))
                }
            },
            DeValue::Datetime(_) => {
                let message = format!("`{}` is a date; recipes have no dates", path.join("."));
                self.refuse(self.texts.problem("recipe-wrong-type", place, message).hint("put it in quotes"))
            }
            DeValue::Array(items) => {
                let mut nodes = Vec::with_capacity(items.len());
                for (index, item) in items.iter().enumerate() {
                    path.push(index.to_string());
                    nodes.push(self.node(item, path));
                    path.pop();
                }
                Value::Array(nodes)
            }
            DeValue::Table(table) => Value::Table(self.table(table, path)),
        }
    }

    fn refuse(&mut self, problem: Box<Diagnostic>) -> Value {
        self.problems.push(problem);
        Value::Refused
    }
}
