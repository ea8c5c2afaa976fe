//! Commands, options and keys of recipes that messages, helps and the book name are there.

use crate::house::lengths::sources;
use crate::house::tokens::texts_of_file;
use crate::support::{cosfly, repository_root};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Options of other programs.
const OF_OTHERS: [&str; 2] = ["--fcd-output.geo", "--journal"];

/// The command line: options of each command, by its words; and all helps.
#[derive(Default)]
struct CommandLine {
    options: BTreeMap<String, BTreeSet<String>>,
    helps: Vec<String>,
}

impl CommandLine {
    fn read() -> Self {
        let mut all = Self::default();
        all.add(&[]);
        assert!(all.options.len() > 30, "{:?}", all.options.keys());
        all
    }

    fn add(&mut self, words: &[&str]) {
        let help = cosfly(&[words, &["--help"]].concat()).run_ok().stdout;
        let described = help.lines().filter(|line| line.trim_start().starts_with('-'));
        let options = described.flat_map(options_in).collect();
        self.options.insert(words.join(" "), options);
        let commands =
            help.split("\nCommands:\n").nth(1).and_then(|rest| rest.split("\n\n").next()).unwrap_or_default();
        for line in commands.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   ")) {
            if let Some(name) = line.split_whitespace().next().filter(|name| *name != "help") {
                self.add(&[words, &[name]].concat());
            }
        }
        self.helps.push(help);
    }

    /// What is wrong with a call in a text, such as `cosfly fly bundle RESULT`.
    fn fault_of_call(&self, call: &str) -> Option<String> {
        let words: Vec<&str> = call.split_whitespace().skip(1).collect();
        let known = |count: usize| self.options.get(&words[..count].join(" "));
        let plain =
            words.iter().take_while(|word| word.bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'-')).count();
        let depth = (0..=plain).rev().find(|count| known(*count).is_some()).unwrap_or(0);
        if depth == 0 && plain > 0 && !words[0].starts_with('-') {
            return Some(format!("there is no command `{}`", words[0]));
        }
        let options = known(depth)?;
        let strange = options_in(call).find(|option| !options.contains(option))?;
        Some(format!("`cosfly {}` has no option `{strange}`", words[..depth].join(" ")))
    }

    fn has_option(&self, option: &str) -> bool {
        self.options.values().any(|of_one| of_one.contains(option))
    }
}

/// The long options that a text names.
fn options_in(text: &str) -> impl Iterator<Item = String> {
    let words = text.split(|sign: char| sign.is_whitespace() || ",[]()'".contains(sign));
    let options = words.filter_map(|word| word.split('=').next());
    options.filter(|word| word.starts_with("--") && word.len() > 2).map(str::to_owned)
}

/// The names of all keys of recipes.
fn keys() -> BTreeSet<String> {
    fn collect(value: &Value, keys: &mut BTreeSet<String>) {
        if let Some(properties) = value.get("properties").and_then(Value::as_object) {
            keys.extend(properties.keys().cloned());
        }
        match value {
            Value::Object(entries) => entries.values().for_each(|entry| collect(entry, keys)),
            Value::Array(entries) => entries.iter().for_each(|entry| collect(entry, keys)),
            _ => {}
        }
    }
    let text = std::fs::read_to_string(repository_root().join("schemas/recipe.schema.json")).expect("the schema");
    let mut keys = BTreeSet::new();
    collect(&serde_json::from_str(&text).expect("JSON"), &mut keys);
    keys
}

/// The key that a piece such as `splits.by = "area"` sets.
fn key_of(piece: &str) -> Option<&str> {
    let path = piece.split_once(" = ")?.0;
    let is_path = path.bytes().all(|byte| byte.is_ascii_lowercase() || b"_.".contains(&byte));
    path.rsplit('.').next().filter(|name| is_path && !name.is_empty())
}

#[test]
fn messages_name_commands_options_and_keys_that_are_there() {
    let (command_line, keys) = (CommandLine::read(), keys());
    let mut faults = vec![];
    let mut named = 0;
    let mut check = |place: String, text: &str| {
        for piece in text.split('`').skip(1).step_by(2) {
            let fault = if piece.starts_with("cosfly ") {
                command_line.fault_of_call(piece)
            } else if piece.starts_with("--") {
                let option = options_in(piece).next().unwrap_or_default();
                let is_known = command_line.has_option(&option) || OF_OTHERS.contains(&&*option);
                (!is_known).then(|| format!("no command has an option `{option}`"))
            } else if let Some(key) = key_of(piece) {
                (!keys.contains(key)).then(|| format!("recipes have no key `{key}`"))
            } else {
                continue;
            };
            named += 1;
            faults.extend(fault.map(|fault| format!("{place}: {fault}")));
        }
    };
    for file in sources().iter().filter(|file| !file.components().any(|part| part.as_os_str() == "lab")) {
        let place = file.strip_prefix(repository_root()).expect("ours").display().to_string();
        texts_of_file(file).iter().for_each(|text| check(place.clone(), text));
    }
    command_line.helps.iter().for_each(|help| check("a help".into(), help));
    assert!(named > 200 && faults.is_empty(), "{named} names\n{}", faults.join("\n"));
}

fn pages(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("the book").map(|entry| entry.expect("an entry").path()) {
        if entry.is_dir() {
            pages(&entry, found);
        } else if entry.extension().is_some_and(|ending| ending == "md") {
            found.push(entry);
        }
    }
}

#[test]
fn calls_in_the_book_and_the_helps_have_commands_and_options_that_are_there() {
    let command_line = CommandLine::read();
    let root = repository_root();
    let mut files: Vec<PathBuf> =
        ["README.md", "CONTRIBUTING.md", "ARCHITECTURE.md"].map(|name| root.join(name)).into();
    pages(&root.join("book/src"), &mut files);
    // Pages "How to add ..." call what their readers add; they are carried out on their own.
    files.retain(|file| !file.parent().is_some_and(|folder| folder.ends_with("add")));
    let texts = files.iter().map(|file| {
        let text = std::fs::read_to_string(file).expect("a page");
        // Parts with odd numbers are in fences.
        let fences: String = text.split("```").skip(1).step_by(2).collect();
        (file.strip_prefix(&root).expect("ours").display().to_string(), fences)
    });
    let helps = command_line.helps.iter().map(|help| ("a help".to_owned(), help.clone()));
    let (mut calls, mut faults) = (0, vec![]);
    for (place, text) in texts.chain(helps) {
        for line in text.replace("\\\n", " ").lines() {
            let line = line.trim_start().trim_start_matches("$ ");
            let call = line.split(" #").next().unwrap_or_default().split("   ").next().unwrap_or_default();
            if call.starts_with("cosfly ") && !call.contains(" = ") {
                calls += 1;
                faults.extend(command_line.fault_of_call(call).map(|fault| format!("{place}: {fault} in `{call}`")));
            }
        }
    }
    assert!(calls > 180 && faults.is_empty(), "{calls} calls\n{}", faults.join("\n"));
}
