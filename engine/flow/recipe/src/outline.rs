//! Outline of a recipe, before its stage kinds are looked up: name, seed, stages, kinds and connections.

use crate::document::{Entry, Node, Place, Problems, Table, Texts, Value, list};
use cosfly_diagnose::nearest_name;

/// A recipe as written, with checked keys.
pub(crate) struct Outline {
    pub(crate) name: String,
    pub(crate) seed: u64,
    pub(crate) remove_intermediates: bool,
    /// Tables of other commands, which runs do not read.
    pub(crate) tool: Table,
    /// Stages in the order of the file.
    pub(crate) stages: Vec<StageOutline>,
}

/// One `[stages.NAME]` table.
pub(crate) struct StageOutline {
    pub(crate) name: String,
    /// Place of the name.
    pub(crate) place: Place,
    /// Kind and its place; `None` when its absence is already reported.
    pub(crate) kind: Option<(String, Place)>,
    pub(crate) inputs: Vec<InputOutline>,
    /// Table of the stage without `use` and `inputs`.
    pub(crate) parameters: Table,
}

/// One entry of an `inputs` table.
pub(crate) struct InputOutline {
    pub(crate) port: String,
    pub(crate) place: Place,
    /// Names of stages and their places.
    pub(crate) stages: Vec<(String, Place)>,
    /// Whether the names are written as a list.
    pub(crate) listed: bool,
}

/// Kind whose stages are files: `use = "wasm:FILE"` means `use = "wasm"` with `file = "FILE"`.
pub(crate) const FILE_KIND: &str = "wasm";

const TOP_KEYS: [&str; 6] = ["name", "seed", "intermediates", "for_each", "stages", "tool"];
/// Values of `intermediates`.
pub(crate) const INTERMEDIATES: [&str; 2] = ["keep", "remove"];

impl Outline {
    /// Reads the root table; `None` when nothing more can be checked.
    pub(crate) fn read(root: Table, texts: &Texts, problems: &mut Problems) -> Option<Self> {
        let mut reader = Reader { texts, problems };
        reader.check_top_keys(&root);
        let name = reader.name(root.get("name"));
        let seed = reader.seed(root.get("seed"));
        let remove_intermediates = reader.intermediates(root.get("intermediates"));
        let tool = reader.tool(root.get("tool"));
        let stages = reader.stages(root)?;
        Some(Self { name, seed, remove_intermediates, tool, stages })
    }
}

struct Reader<'a> {
    texts: &'a Texts,
    problems: &'a mut Problems,
}

impl Reader<'_> {
    fn check_top_keys(&mut self, root: &Table) {
        for (key, entry) in root.iter().filter(|(key, _)| !TOP_KEYS.contains(&key.as_str())) {
            let problem =
                self.texts.problem("recipe-unknown-key", &entry.key, format!("`{key}` is not a key of recipes"));
            let problem = match nearest_name(key, TOP_KEYS) {
                Some(near) => problem.hint(format!("did you mean `{near}`?")),
                None if entry.node.as_table().is_some() => problem.hint(format!("did you mean `[stages.{key}]`?")),
                None => problem,
            };
            self.problems.push(problem.hint(format!("a recipe has {}", list(TOP_KEYS, TOP_KEYS.len()))));
        }
    }

    fn name(&mut self, entry: Option<&Entry>) -> String {
        let Some(entry) = entry else {
            let top = Place::new(0, 0..0);
            let problem = self.texts.problem("recipe-missing-key", &top, "the recipe has no `name`");
            self.problems.push(problem.hint("begin it with a line such as `name = \"carla_town\"`"));
            return String::new();
        };
        let Some(name) = self.text("name", &entry.node) else { return String::new() };
        let allowed = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_' || byte == b'-';
        if name.is_empty() || name.len() > 100 || !name.bytes().all(allowed) {
            let message = format!("`name` is `{}`; it must be 1 to 100 of `a-z`, `0-9`, `_` and `-`", short(&name));
            self.problems.push(
                self.texts
                    .problem("recipe-name", &entry.node.place, message)
                    .hint("the dataset and its folder have this name"),
            );
        }
        name
    }

    fn seed(&mut self, entry: Option<&Entry>) -> u64 {
        let Some(node) = entry.map(|entry| &entry.node) else { return 0 };
        match node.value {
            Value::Integer(seed) if seed >= 0 => return seed.unsigned_abs(),
            Value::Integer(seed) => {
                let message = format!("`seed` is `{seed}`; it must be at least `0`");
                self.problems.push(self.texts.problem("recipe-out-of-range", &node.place, message));
            }
            Value::Refused => {}
            _ => self.wrong_type("seed", node, "a whole number"),
        }
        0
    }

    fn tool(&mut self, entry: Option<&Entry>) -> Table {
        let Some(node) = entry.map(|entry| &entry.node) else { return Table::new() };
        let table = node.as_table().cloned();
        table.unwrap_or_else(|| {
            self.wrong_type("tool", node, "a table");
            Table::new()
        })
    }

    fn intermediates(&mut self, entry: Option<&Entry>) -> bool {
        let Some(node) = entry.map(|entry| &entry.node) else { return false };
        let Some(text) = self.text("intermediates", node) else { return false };
        if !INTERMEDIATES.contains(&text.as_str()) {
            let message =
                format!("`intermediates` is `{}`; it must be one of {}", short(&text), list(INTERMEDIATES, 2));
            self.problems.push(self.texts.problem("recipe-not-offered", &node.place, message));
        }
        text == INTERMEDIATES[1]
    }

    fn stages(&mut self, mut root: Table) -> Option<Vec<StageOutline>> {
        let hint = "write one table per stage, such as `[stages.town]` with `use = \"map\"`";
        let Some(entry) = root.remove("stages") else {
            let top = Place::new(0, 0..0);
            self.problems.push(self.texts.problem("recipe-no-stages", &top, "the recipe has no stages").hint(hint));
            return None;
        };
        let Value::Table(table) = entry.node.value else {
            if !matches!(entry.node.value, Value::Refused) {
                self.wrong_type("stages", &entry.node, "a table");
            }
            return None;
        };
        if table.is_empty() {
            self.problems
                .push(self.texts.problem("recipe-no-stages", &entry.key, "the recipe has no stages").hint(hint));
            return None;
        }
        let mut stages: Vec<StageOutline> =
            table.into_iter().filter_map(|(name, entry)| self.stage(name, entry)).collect();
        stages.sort_by(|a, b| a.place.cmp(&b.place));
        Some(stages)
    }

    fn stage(&mut self, name: String, entry: Entry) -> Option<StageOutline> {
        let mut bytes = name.bytes();
        let lower = bytes.next().is_some_and(|byte| byte.is_ascii_lowercase());
        if !lower || name.len() > 100 || !bytes.all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'_') {
            let message = format!(
                "a stage is named `{}`; names are one of `a-z`, then at most 99 of `a-z`, `0-9` and `_`",
                short(&name)
            );
            self.problems.push(self.texts.problem("recipe-name", &entry.key, message));
        }
        let Value::Table(mut parameters) = entry.node.value else {
            if !matches!(entry.node.value, Value::Refused) {
                self.wrong_type(&format!("stages.{name}"), &entry.node, "a table");
            }
            return None;
        };
        let kind = match parameters.remove("use") {
            Some(entry) => self.text(&format!("stages.{name}.use"), &entry.node).map(|kind| (kind, entry.node.place)),
            None => {
                let message = format!("stage `{name}` has no `use`");
                let problem = self.texts.problem("recipe-missing-key", &entry.key, message);
                self.problems.push(problem.hint("add a line such as `use = \"map\"`"));
                None
            }
        };
        let kind =
            kind.map(|(kind, place)| match kind.strip_prefix(FILE_KIND).and_then(|rest| rest.strip_prefix(':')) {
                Some(file) => {
                    let node = Node { place: place.clone(), value: Value::Text(file.to_owned()) };
                    parameters.insert("file".to_owned(), Entry { key: place.clone(), node });
                    (FILE_KIND.to_owned(), place)
                }
                None => (kind, place),
            });
        let inputs = parameters.remove("inputs").map_or_else(Vec::new, |inputs| self.inputs(&name, inputs.node));
        Some(StageOutline { name, place: entry.key, kind, inputs, parameters })
    }

    fn inputs(&mut self, stage: &str, node: Node) -> Vec<InputOutline> {
        let Value::Table(table) = node.value else {
            if !matches!(node.value, Value::Refused) {
                let message = format!("`stages.{stage}.inputs` is {}; it must be a table", node.type_words());
                let problem = self.texts.problem("recipe-wrong-type", &node.place, message);
                self.problems.push(problem.hint("write `inputs.PORT = \"STAGE\"`"));
            }
            return vec![];
        };
        table.into_iter().map(|(port, entry)| self.input(stage, port, entry)).collect()
    }

    fn input(&mut self, stage: &str, port: String, entry: Entry) -> InputOutline {
        let path = format!("stages.{stage}.inputs.{port}");
        let listed = matches!(entry.node.value, Value::Array(_));
        let nodes = match entry.node.value {
            Value::Array(nodes) => nodes,
            Value::Text(_) => vec![entry.node],
            Value::Refused => vec![],
            _ => {
                self.wrong_type(&path, &entry.node, "the name of a stage or a list of names");
                vec![]
            }
        };
        let stages =
            nodes.iter().filter_map(|node| self.text(&path, node).map(|name| (name, node.place.clone()))).collect();
        InputOutline { port, place: entry.key, stages, listed }
    }

    fn text(&mut self, path: &str, node: &Node) -> Option<String> {
        match &node.value {
            Value::Text(text) => return Some(text.clone()),
            Value::Refused => {}
            _ => self.wrong_type(path, node, "a string"),
        }
        None
    }

    fn wrong_type(&mut self, path: &str, node: &Node, wanted: &str) {
        let message = format!("`{path}` is {}; it must be {wanted}", node.type_words());
        let problem = self.texts.problem("recipe-wrong-type", &node.place, message);
        let quotable =
            wanted != "a table" && matches!(node.value, Value::Integer(_) | Value::Float(_) | Value::Bool(_));
        self.problems.push(if quotable && wanted == "a string" { problem.hint("put it in quotes") } else { problem });
    }
}

/// `name` for a message, shortened when it is very long.
fn short(name: &str) -> String {
    let cut: String = name.chars().take(60).collect();
    if cut.len() < name.len() { format!("{cut}...") } else { cut }
}
