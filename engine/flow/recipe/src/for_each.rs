//! `for_each`: stages that the recipe writes once and that are made for every value of a list.
//!
//! `[for_each]` names lists; a stage with `for_each = "town"` becomes a stage for each value of `town`, called
//! `STAGE_VALUE`, and `{town.FIELD}` in its table is the value's field. An input that names such a stage means the stages
//! of the same values; where a list is the upstream stage's only, all of them. Everything after this file sees stages
//! that could have been written out by hand.

mod lists;
mod placeholders;

use crate::document::{Entry, Node, Place, Problems, Table, Texts, Value, list};
use cosfly_diagnose::nearest_name;
use lists::{Choice, Lists};
use placeholders::Filler;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Most stages of a recipe once lists are written out.
const MOST_STAGES: usize = 10_000;

/// A stage as written, and the lists that it is made for.
struct Template {
    entry: Entry,
    /// Names of lists, in the order of the stage.
    lists: Vec<String>,
}

/// One stage made of a template.
struct Made {
    name: String,
    /// The chosen value of each of its lists.
    choices: Vec<Choice>,
}

/// Writes out the stages of `root` that have a `for_each`; files are relative to `directory`. None when lists have errors.
pub(crate) fn expand(root: &mut Table, directory: &Path, texts: &Texts, problems: &mut Problems) -> Option<()> {
    let known_problems = problems.len();
    let lists = root.remove("for_each").map(|entry| Lists::read(entry, directory, texts, problems));
    let Some(Value::Table(stages)) = root.get_mut("stages").map(|entry| &mut entry.node.value) else {
        return Some(());
    };
    if lists.is_none() && !stages.values().any(asks_for_lists) {
        return Some(());
    }
    let lists = lists.unwrap_or_default();
    let mut expansion = Expansion { lists: &lists, texts, problems };
    let templates: BTreeMap<String, Template> = std::mem::take(stages)
        .into_iter()
        .map(|(name, entry)| {
            let template = expansion.template(&name, entry);
            (name, template)
        })
        .collect();
    expansion.check_use(&templates);
    if expansion.problems.len() > known_problems {
        return None;
    }
    let made = expansion.made(&templates)?;
    let mut read = BTreeSet::new();
    *stages = expansion.written_out(&templates, &made, &mut read);
    expansion.check_fields(&read);
    (expansion.problems.len() == known_problems).then_some(())
}

fn asks_for_lists(stage: &Entry) -> bool {
    stage.node.as_table().is_some_and(|table| table.contains_key("for_each"))
}

struct Expansion<'a> {
    lists: &'a Lists,
    texts: &'a Texts,
    problems: &'a mut Problems,
}

impl Expansion<'_> {
    /// Takes `for_each` out of a stage.
    fn template(&mut self, stage: &str, mut entry: Entry) -> Template {
        let Value::Table(table) = &mut entry.node.value else { return Template { entry, lists: vec![] } };
        let Some(asked) = table.remove("for_each") else { return Template { entry, lists: vec![] } };
        let nodes = match &asked.node.value {
            Value::Array(nodes) => nodes.iter().collect(),
            _ => vec![&asked.node],
        };
        let mut names = vec![];
        for node in nodes {
            let Some(name) = node.as_text() else {
                let message = format!("`stages.{stage}.for_each` holds {}; it names lists", node.type_words());
                let problem = self.texts.problem("recipe-wrong-type", &node.place, message);
                self.problems
                    .push(problem.hint("write `for_each = \"town\"`, or `[\"town\", \"weather\"]` for two lists"));
                continue;
            };
            if self.lists.get(name).is_none() {
                self.problems.push(self.unknown_list(name, &node.place));
            } else if names.iter().any(|known| known == name) {
                let message = format!("`stages.{stage}.for_each` names `{name}` twice");
                self.problems.push(self.texts.problem("recipe-input-twice", &node.place, message).hint("name it once"));
            } else {
                names.push(name.to_owned());
            }
        }
        Template { entry, lists: names }
    }

    fn unknown_list(&self, name: &str, place: &Place) -> Box<cosfly_diagnose::Diagnostic> {
        let problem = self.texts.problem("recipe-unknown-list", place, format!("`[for_each]` has no list `{name}`"));
        match nearest_name(name, self.lists.names()) {
            Some(near) => problem.hint(format!("did you mean `{near}`?")),
            None if self.lists.names().next().is_none() => {
                problem.hint(format!("write the list: `[for_each]` with `{name} = [\"FIRST\", \"SECOND\"]`"))
            }
            None => problem.hint(format!("lists of the recipe: {}", list(self.lists.names(), 40))),
        }
    }

    /// A list that no stage is made for is a mistake.
    fn check_use(&mut self, templates: &BTreeMap<String, Template>) {
        let used: BTreeSet<&str> = templates.values().flat_map(|it| &it.lists).map(String::as_str).collect();
        for (name, place) in self.lists.places().filter(|(name, _)| !used.contains(name)) {
            let problem =
                self.texts.problem("recipe-unused-list", place, format!("no stage is made for each `{name}`"));
            self.problems.push(problem.hint(format!("write `for_each = \"{name}\"` in a stage, or remove the list")));
        }
    }

    /// Names and choices of all stages; none when a name is taken or there are too many.
    fn made(&mut self, templates: &BTreeMap<String, Template>) -> Option<BTreeMap<String, Vec<Made>>> {
        let count_of = |template: &Template| {
            let counts = template.lists.iter().filter_map(|name| self.lists.get(name)).map(<[Choice]>::len);
            counts.fold(1_usize, usize::saturating_mul)
        };
        let total = templates.values().map(count_of).fold(0_usize, usize::saturating_add);
        if total > MOST_STAGES {
            let message = format!("the lists make {total} stages; a recipe may have {MOST_STAGES}");
            let place = self.lists.places().next().map_or(Place::new(0, 0..0), |(_, place)| place.clone());
            self.problems.push(
                self.texts
                    .problem("recipe-too-many-stages", &place, message)
                    .hint("shorten a list, make stages for fewer lists at once, or split the recipe"),
            );
            return None;
        }
        let mut owners: BTreeMap<String, &str> = BTreeMap::new();
        let mut all = BTreeMap::new();
        for (written, template) in templates {
            let mut made = vec![Made { name: written.clone(), choices: vec![] }];
            for choices in template.lists.iter().filter_map(|name| self.lists.get(name)) {
                made = made.iter().flat_map(|so_far| choices.iter().map(|choice| so_far.with(choice))).collect();
            }
            for it in &made {
                let Some(other) = owners.insert(it.name.clone(), written) else { continue };
                let message = format!("`{written}` and `{other}` both make a stage `{}`", it.name);
                let problem = self.texts.problem("recipe-name", &template.entry.key, message);
                self.problems.push(problem.hint("rename one of them"));
                return None;
            }
            all.insert(written.clone(), made);
        }
        Some(all)
    }

    /// A field that no stage reads and that some values of the list lack is a mistake, such as a mistyped name. One that all
    /// have may be idle because `--set` replaced what read it.
    fn check_fields(&mut self, read: &BTreeSet<(String, String)>) {
        let mut told = BTreeSet::new();
        for choice in self.lists.choices() {
            let fields = choice.node.as_table().into_iter().flatten();
            for (field, entry) in fields.filter(|(field, _)| *field != lists::NAME && *field != lists::FILE) {
                let list = &choice.list;
                let lacks = |other: &Choice| !other.node.as_table().is_some_and(|table| table.contains_key(field));
                let all_have = !self.lists.get(list).into_iter().flatten().any(lacks);
                if all_have || read.contains(&(list.clone(), field.clone())) || !told.insert((list, field)) {
                    continue;
                }
                let message = format!("no stage reads `{field}` of the list `{list}`");
                let problem = self.texts.problem("recipe-unused-field", &entry.key, message);
                let known = read.iter().filter(|(its, _)| its == list).map(|(_, field)| field.as_str());
                self.problems.push(match nearest_name(field, known) {
                    Some(near) => problem.hint(format!("did you mean `{near}`?")),
                    None => problem.hint(format!("write `{{{list}.{field}}}` in a stage, or remove the field")),
                });
            }
        }
    }

    fn written_out(
        &mut self,
        templates: &BTreeMap<String, Template>,
        all: &BTreeMap<String, Vec<Made>>,
        read: &mut BTreeSet<(String, String)>,
    ) -> Table {
        let mut stages = Table::new();
        for (written, template) in templates {
            for made in &all[written] {
                let mut entry = template.entry.clone();
                if let Value::Table(table) = &mut entry.node.value {
                    let inputs = table.remove("inputs");
                    let mut filler = Filler {
                        lists: self.lists,
                        choices: &made.choices,
                        texts: self.texts,
                        problems: self.problems,
                        read,
                    };
                    table.values_mut().for_each(|entry| filler.fill(&mut entry.node));
                    if let Some(mut inputs) = inputs {
                        connect(&mut inputs.node, made, all);
                        table.insert("inputs".to_owned(), inputs);
                    }
                }
                stages.insert(made.name.clone(), entry);
            }
        }
        stages
    }
}

impl Made {
    fn with(&self, choice: &Choice) -> Self {
        let mut choices = self.choices.clone();
        choices.push(choice.clone());
        Self { name: format!("{}_{}", self.name, choice.label), choices }
    }

    /// Whether two stages have the same value of every list that both are made for.
    fn agrees(&self, other: &Self) -> bool {
        let differs = |own: &Choice, its: &Choice| own.list == its.list && own.label != its.label;
        !self.choices.iter().any(|own| other.choices.iter().any(|its| differs(own, its)))
    }
}

/// Replaces names of written stages in an `inputs` table by those of the stages made of them.
fn connect(inputs: &mut Node, reader: &Made, all: &BTreeMap<String, Vec<Made>>) {
    let Value::Table(ports) = &mut inputs.value else { return };
    for entry in ports.values_mut() {
        let upstreams = |node: &Node| -> Vec<Node> {
            match node.as_text().and_then(|name| all.get(name)) {
                None => vec![node.clone()],
                Some(made) => {
                    let agreeing = made.iter().filter(|it| it.agrees(reader));
                    agreeing.map(|it| Node { place: node.place.clone(), value: Value::Text(it.name.clone()) }).collect()
                }
            }
        };
        match &entry.node.value {
            Value::Array(nodes) => entry.node.value = Value::Array(nodes.iter().flat_map(upstreams).collect()),
            Value::Text(_) => match &upstreams(&entry.node)[..] {
                [only] => entry.node = only.clone(),
                several => entry.node.value = Value::Array(several.to_vec()),
            },
            _ => {}
        }
    }
}
