//! Overrides from the command line: `--set stages.expert.weights.visibility=5` replaces one value of the recipe.

use crate::document::{Entry, Node, Place, Problems, Table, Texts, Value, list};
use crate::toml_text::parse_value;
use cosfly_diagnose::nearest_name;

/// Most keys of a path: no parameter lies deeper.
const MOST_KEYS: usize = 16;

/// Applies every override to `root`, in the order given; invalid ones are reported.
pub(crate) fn apply(root: &mut Table, overrides: &[String], texts: &mut Texts, problems: &mut Problems) {
    for argument in overrides {
        let text = texts.add_override(argument);
        if let Some(assignment) = read(argument, text, texts, problems) {
            place_value(root, assignment, texts, problems);
        }
    }
}

struct Assignment {
    /// Keys from the root, and their places.
    path: Vec<(String, Place)>,
    node: Node,
}

fn read(argument: &str, text: usize, texts: &Texts, problems: &mut Problems) -> Option<Assignment> {
    let whole = Place::new(text, 0..argument.len());
    let Some(equals) = argument.find('=') else {
        let problem = texts.problem("override-syntax", &whole, format!("`{}` has no `=`", texts.written(&whole)));
        problems.push(problem.hint("write `--set stages.STAGE.PARAMETER=VALUE`"));
        return None;
    };
    let mut path = vec![];
    let mut start = 0;
    for piece in argument[..equals].split('.') {
        let from = start + (piece.len() - piece.trim_start().len());
        let key = piece.trim();
        let place = Place::new(text, from..from + key.len());
        start += piece.len() + 1;
        if key.is_empty() || !key.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_' || byte == b'-') {
            let message = if key.is_empty() { "a key is empty".to_owned() } else { format!("`{key}` is not a key") };
            let problem = texts.problem("override-syntax", &place, message);
            problems.push(problem.hint("keys are letters, digits, `_` and `-`, joined by dots"));
            return None;
        }
        path.push((key.to_owned(), place));
    }
    if path.len() > MOST_KEYS {
        problems.push(texts.problem("override-syntax", &whole, format!("more than {MOST_KEYS} keys in one path")));
        return None;
    }
    let value = &argument[equals + 1..];
    let offset = equals + 1 + (value.len() - value.trim_start().len());
    let keys: Vec<String> = path.iter().map(|(key, _)| key.clone()).collect();
    let node = parse_value(value.trim(), &keys, (text, offset), texts, problems)?;
    Some(Assignment { path, node })
}

fn place_value(root: &mut Table, assignment: Assignment, texts: &Texts, problems: &mut Problems) {
    let Assignment { path, node } = assignment;
    if let [(top, _), (stage, place), _, ..] = &path[..]
        && top == "stages"
        && let Some(Value::Table(stages)) = root.get("stages").map(|entry| &entry.node.value)
        && !stages.contains_key(stage)
    {
        problems.push(no_such_stage(stage, place, stages, texts));
        return;
    }
    if let [(top, place)] | [(top, _), (_, place)] = &path[..]
        && top == "stages"
    {
        let problem = texts.problem("override-syntax", place, "a whole stage cannot be replaced by `--set`");
        problems.push(problem.hint("name one of its parameters: `--set stages.STAGE.PARAMETER=VALUE`"));
        return;
    }
    let ((first, first_place), rest) = path.split_first().expect("splitting a text gives at least one piece");
    if rest.is_empty() {
        root.insert(first.clone(), Entry { key: first_place.clone(), node });
        return;
    }
    let mut here = &mut root.entry(first.clone()).or_insert_with(|| empty_table(first_place)).node;
    for (index, (key, place)) in rest.iter().enumerate() {
        let words = here.type_words();
        let is_last = index + 1 == rest.len();
        // Elements of lists are named by their numbers.
        let position = match &here.value {
            Value::Array(items) => key.parse().ok().filter(|position: &usize| *position < items.len()),
            _ => None,
        };
        here = match (&mut here.value, position) {
            (Value::Table(table), _) if is_last => {
                table.insert(key.clone(), Entry { key: place.clone(), node });
                return;
            }
            (Value::Table(table), _) => &mut table.entry(key.clone()).or_insert_with(|| empty_table(place)).node,
            (Value::Array(items), Some(position)) => &mut items[position],
            _ => {
                let walked: Vec<&str> = path[..=index].iter().map(|(key, _)| key.as_str()).collect();
                let message = format!("`{}` is {words}; it has no `{key}`", walked.join("."));
                problems.push(texts.problem("override-syntax", place, message));
                return;
            }
        };
    }
    *here = node;
}

fn empty_table(place: &Place) -> Entry {
    Entry { key: place.clone(), node: Node { place: place.clone(), value: Value::Table(Table::new()) } }
}

fn no_such_stage(stage: &str, place: &Place, stages: &Table, texts: &Texts) -> Box<cosfly_diagnose::Diagnostic> {
    let known = || stages.keys().map(String::as_str);
    let problem = texts.problem("override-unknown-stage", place, format!("the recipe has no stage `{stage}`"));
    match nearest_name(stage, known()) {
        Some(name) => problem.hint(format!("did you mean `{name}`?")),
        None => problem,
    }
    .hint(format!("stages of the recipe: {}", list(known(), 40)))
}
