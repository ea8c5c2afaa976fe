//! The lists of `[for_each]`: values written out, or files of a pattern.

use crate::document::{Entry, Node, Place, Problems, Table, Texts, Value};
use std::collections::BTreeMap;
use std::path::Path;

/// Field of a value that names it.
pub(super) const NAME: &str = "name";
/// Field of a list with a pattern, and of its values.
const FILES: &str = "files";
pub(super) const FILE: &str = "file";
/// Longest label, characters: labels become parts of names of stages.
const LONGEST_LABEL: usize = 60;

/// A value of a list.
#[derive(Clone)]
pub(super) struct Choice {
    /// Name of the list.
    pub(super) list: String,
    /// End of the names of stages that are made for the value: `a-z`, `0-9`, `_`.
    pub(super) label: String,
    pub(super) node: Node,
}

/// The lists by name.
#[derive(Default)]
pub(super) struct Lists(BTreeMap<String, (Place, Vec<Choice>)>);

impl Lists {
    /// Reads the table `[for_each]`.
    pub(super) fn read(entry: Entry, directory: &Path, texts: &Texts, problems: &mut Problems) -> Self {
        let mut lists = Self::default();
        let node = entry.node;
        let words = node.type_words();
        let Value::Table(table) = node.value else {
            if !matches!(node.value, Value::Refused) {
                let problem = texts.problem(
                    "recipe-wrong-type",
                    &node.place,
                    format!("`for_each` is {words}; it must be a table of lists"),
                );
                problems.push(problem.hint("write `[for_each]` and lists such as `town = [\"towns/a.xodr\", \"towns/b.xodr\"]`; stages name the list"));
            }
            return lists;
        };
        let mut reader = Reader { directory, texts, problems };
        for (name, entry) in table {
            let nodes = reader.values(&name, &entry);
            let choices = reader.choices(&name, nodes);
            lists.0.insert(name, (entry.key, choices));
        }
        lists
    }

    pub(super) fn get(&self, name: &str) -> Option<&[Choice]> {
        self.0.get(name).map(|(_, choices)| &choices[..])
    }

    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }

    /// All values of all lists.
    pub(super) fn choices(&self) -> impl Iterator<Item = &Choice> {
        self.0.values().flat_map(|(_, choices)| choices)
    }

    pub(super) fn places(&self) -> impl Iterator<Item = (&str, &Place)> {
        self.0.iter().map(|(name, (place, _))| (name.as_str(), place))
    }
}

struct Reader<'a> {
    directory: &'a Path,
    texts: &'a Texts,
    problems: &'a mut Problems,
}

impl Reader<'_> {
    fn values(&mut self, name: &str, entry: &Entry) -> Vec<Node> {
        let node = &entry.node;
        let values = match &node.value {
            Value::Array(nodes) => nodes.clone(),
            Value::Text(pattern) => self.files(pattern, node),
            Value::Table(table) if table.contains_key(FILES) => return self.files_with_fields(name, table),
            Value::Refused => return vec![],
            _ => {
                let message =
                    format!("`for_each.{name}` is {}; it must be a list, or a pattern of files", node.type_words());
                let problem = self.texts.problem("recipe-wrong-type", &node.place, message);
                self.problems.push(problem.hint(format!("write `{name} = [1, 2, 3]`, `{name} = \"towns/*.xodr\"` or `{name} = {{ files = \"towns/*.xodr\", walks = 50 }}`")));
                return vec![];
            }
        };
        if values.is_empty() && matches!(node.value, Value::Array(_)) {
            let problem = self.texts.problem("recipe-empty-list", &node.place, format!("`for_each.{name}` is empty"));
            self.problems.push(problem.hint("a list has at least one value"));
        }
        values
    }

    /// One value for each file of a pattern, with the other fields of the table.
    fn files_with_fields(&mut self, name: &str, table: &Table) -> Vec<Node> {
        let node = &table[FILES].node;
        let Some(pattern) = node.as_text() else {
            let message = format!(
                "`for_each.{name}.files` is {}; it must be a pattern such as `\"towns/*.xodr\"`",
                node.type_words()
            );
            self.problems.push(self.texts.problem("recipe-wrong-type", &node.place, message));
            return vec![];
        };
        let value_of = |file: Node| {
            let mut fields = table.clone();
            let entry = Entry { key: node.place.clone(), node: file };
            fields.remove(FILES);
            fields.insert(FILE.to_owned(), entry);
            Node { place: node.place.clone(), value: Value::Table(fields) }
        };
        self.files(pattern, node).into_iter().map(value_of).collect()
    }

    /// Files of a pattern, relative to the recipe's folder, sorted by name.
    fn files(&mut self, pattern: &str, node: &Node) -> Vec<Node> {
        let base = glob::Pattern::escape(&self.directory.to_string_lossy());
        let whole = Path::new(&base).join(pattern);
        let found = match glob::glob(&whole.to_string_lossy()) {
            Ok(found) => found,
            Err(error) => {
                let message = format!("`{pattern}` is not a pattern of files");
                self.problems.push(self.texts.problem("recipe-pattern", &node.place, message).because(error.msg));
                return vec![];
            }
        };
        let relative = |path: &Path| path.strip_prefix(self.directory).unwrap_or(path).to_string_lossy().into_owned();
        let mut files: Vec<String> =
            found.flatten().filter(|path| path.is_file()).map(|path| relative(&path)).collect();
        files.sort_unstable();
        if files.is_empty() {
            let problem = self.texts.problem("input-missing", &node.place, format!("no file matches `{pattern}`"));
            let folder = if self.directory.as_os_str().is_empty() { Path::new(".") } else { self.directory };
            self.problems.push(problem.hint(format!(
                "patterns are relative to the recipe's folder, here `{}`; `*` is any part of a name, `**` any folders",
                folder.display()
            )));
        }
        files.into_iter().map(|file| Node { place: node.place.clone(), value: Value::Text(file) }).collect()
    }

    fn choices(&mut self, name: &str, nodes: Vec<Node>) -> Vec<Choice> {
        let mut known: BTreeMap<String, Place> = BTreeMap::new();
        let mut choices = vec![];
        for node in nodes {
            if matches!(node.value, Value::Refused) {
                continue;
            }
            let label = label_of(&node);
            if label.is_empty() || label.len() > LONGEST_LABEL {
                let message = format!("a value of `for_each.{name}` has no name for its stages");
                let problem = self.texts.problem("recipe-list-value", &node.place, message);
                self.problems.push(problem.hint("write it as a table with a name: `{ name = \"a\", source = \"...\" }`; names are `a-z`, `0-9`, `_`, at most 60"));
                continue;
            }
            if known.insert(label.clone(), node.place.clone()).is_some() {
                let message = format!("two values of `for_each.{name}` are called `{label}`");
                let problem = self.texts.problem("recipe-list-value", &node.place, message);
                self.problems
                    .push(problem.hint("write them as tables with a `name` each: `{ name = \"a\", file = \"...\" }`"));
                continue;
            }
            choices.push(Choice { list: name.to_owned(), label, node });
        }
        choices
    }
}

/// Name of a value within names of stages: its `name`; of files, the name without folder and extension.
fn label_of(node: &Node) -> String {
    let text = match &node.value {
        Value::Table(table) => match [NAME, FILE].iter().find_map(|key| table.get(*key)) {
            Some(entry) if entry.node.as_table().is_none() => return label_of(&entry.node),
            _ => return String::new(),
        },
        Value::Text(text) => stem(text).to_owned(),
        Value::Integer(value) => value.to_string(),
        Value::Float(value) => value.to_string(),
        Value::Bool(value) => value.to_string(),
        Value::Array(_) | Value::Refused => return String::new(),
    };
    let plain = |letter: char| if letter.is_ascii_alphanumeric() { letter.to_ascii_lowercase() } else { '_' };
    let label: String = text.chars().map(plain).collect();
    label.trim_matches('_').to_owned()
}

/// A file's name without folder and extension; any other text as it is.
fn stem(text: &str) -> &str {
    let file = text.rsplit(['/', '\\']).next().unwrap_or(text);
    match file.split_once('.') {
        Some((stem, extension)) if !stem.is_empty() && extension.starts_with(|it: char| it.is_ascii_alphabetic()) => {
            stem
        }
        _ => file,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_called_by_their_name_or_file() {
        let node = |value| Node { place: Place::new(0, 0..0), value };
        let text = |text: &str| label_of(&node(Value::Text(text.to_owned())));
        assert_eq!(text("towns/Town01.xodr"), "town01");
        assert_eq!(text("a/krems.osm.gz"), "krems");
        assert_eq!(text("Hard Rain"), "hard_rain");
        assert_eq!(text("0.5"), "0_5");
        assert_eq!(text("***"), "");
        assert_eq!(label_of(&node(Value::Integer(7))), "7");
        assert_eq!(label_of(&node(Value::Float(0.25))), "0_25");
    }
}
