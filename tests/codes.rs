//! Codes of diagnostics: literals of one form, and their index in the book.

use crate::repository::rust_files;
use crate::support::repository_root;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Calls whose first argument is the code of a diagnostic.
const CODED_CALLS: [&str; 2] = ["Diagnostic::new(", ".problem("];

/// A code and its uses in the sources.
#[derive(Default)]
struct Code {
    /// Rooms that use the code, `shelf/room`.
    rooms: BTreeSet<String>,
    /// Exit codes: 3 for errors in a recipe, otherwise the one in the call.
    exits: BTreeSet<u8>,
    /// Messages that are literals in the sources, with their placeholders.
    messages: BTreeSet<String>,
}

/// Codes in the engine's sources, and first words of arguments that are not literals, with their files.
fn codes() -> (BTreeMap<String, Code>, Vec<(String, String)>) {
    let engine = repository_root().join("engine");
    let mut files = vec![];
    rust_files(&engine, &mut files);
    let (mut codes, mut others) = (BTreeMap::<String, Code>::new(), vec![]);
    for file in files {
        let place = file.strip_prefix(&engine).expect("below the engine").to_owned();
        let parts: Vec<String> = place.iter().map(|part| part.to_string_lossy().into_owned()).collect();
        if parts[0] == "lab" || parts.iter().any(|part| part == "tests") {
            continue;
        }
        let text = std::fs::read_to_string(&file).expect("UTF-8");
        // Tests at the end of a file use codes of their own.
        let text = text.split("\n#[cfg(test)]\nmod ").next().expect("the text");
        for call in CODED_CALLS {
            for (at, _) in text.match_indices(call) {
                let arguments = text[at + call.len()..].trim_start();
                if arguments.starts_with(')') {
                    continue; // another room's problem, without a code
                }
                let Some(code) = literal(arguments) else {
                    others.push((first_word(arguments), place.display().to_string()));
                    continue;
                };
                let entry = codes.entry(code.to_owned()).or_default();
                entry.rooms.insert(format!("{}/{}", parts[0], parts[1]));
                entry.exits.insert(exit(&arguments[code.len() + 2..]));
                entry.messages.extend(message(text, at, arguments));
            }
        }
    }
    (codes, others)
}

/// Text of the string literal at the start of an expression.
fn literal(expression: &str) -> Option<&str> {
    let rest = expression.strip_prefix('"')?;
    let end = rest.match_indices('"').map(|(at, _)| at).find(|at| !rest[..*at].ends_with('\\'))?;
    Some(&rest[..end])
}

fn first_word(expression: &str) -> String {
    expression.split(|letter: char| !letter.is_alphanumeric()).next().unwrap_or_default().to_owned()
}

/// Exit code of a call, from the text after the code.
fn exit(rest: &str) -> u8 {
    match rest.trim_start_matches([',', ' ', '\n']).strip_prefix("Fault::").map(first_word).as_deref() {
        Some("Input") => 4,
        Some("Machine" | "DiskFull" | "Lost") => 5,
        Some("Bug") => 70,
        Some("Stopped") => 130,
        _ => 3,
    }
}

/// Message of a call at `at`, where it is a literal: among the arguments, or in the preceding `let message`.
fn message(text: &str, at: usize, arguments: &str) -> Option<String> {
    let last = arguments.split(',').take(3).last()?;
    let begin = last.as_ptr() as usize - arguments.as_ptr() as usize;
    let expression = arguments[begin..].trim_start().trim_start_matches('&');
    let of_expression = |expression: &str| {
        let inner = expression.strip_prefix("format!(").unwrap_or(expression).trim_start();
        literal(inner).map(|found| found.split_whitespace().collect::<Vec<_>>().join(" "))
    };
    if let Some(found) = of_expression(expression) {
        return Some(found);
    }
    let second = arguments.split(',').nth(1)?;
    let names_message = [second, last].iter().any(|argument| first_word(argument.trim_start()) == "message");
    let (_, before) = text[..at].rsplit_once("let message =").filter(|_| names_message)?;
    of_expression(before.trim_start()).filter(|_| before.len() < 600)
}

#[test]
fn codes_are_literals_of_one_form() {
    let (codes, others) = codes();
    assert!(codes.len() > 100, "{}", codes.len());
    for (code, Code { rooms, .. }) in &codes {
        let is_word =
            |word: &str| !word.is_empty() && word.bytes().all(|b| b.is_ascii_lowercase() || b.is_ascii_digit());
        assert!(code.split('-').all(is_word), "`{code}` in {rooms:?} is not in kebab case");
    }
    // Functions that pass a code on call it `code`.
    for (word, file) in others {
        assert_eq!(word, "code", "the code of a diagnostic in {file} is no literal");
    }
}

/// `.ci/generate` runs this test with `COSFLY_GENERATE` set, which writes the page.
#[test]
fn the_index_of_codes_is_current() {
    let page = repository_root().join("book/src/reference/codes.md");
    let fresh = index(&codes().0);
    if std::env::var_os("COSFLY_GENERATE").is_some() {
        std::fs::write(&page, &fresh).expect("the book is writable");
    }
    let kept = std::fs::read_to_string(Path::new(&page)).unwrap_or_default();
    assert!(fresh == kept, "`book/src/reference/codes.md` is stale: run `.ci/generate`");
}

fn index(codes: &BTreeMap<String, Code>) -> String {
    let mut page = String::from(
        "# Codes of diagnostics\n\n<!-- Made by .ci/generate. -->\n\nEach error and warning begins with a code in brackets, `error[recipe-unknown-key]`. Codes \
         stay; messages may change. `…` stands for a name or a number. What the exit codes mean: [exit codes](exit-codes.md).\n\n\
         | code | exit code | messages | raised in `engine/` |\n| --- | --- | --- | --- |\n",
    );
    for (code, Code { rooms, exits, messages }) in codes {
        let rooms = rooms.iter().map(|room| format!("`{room}`")).collect::<Vec<_>>().join(", ");
        let exits = exits.iter().map(u8::to_string).collect::<Vec<_>>().join(", ");
        let messages = messages.iter().map(|message| shown(message)).collect::<Vec<_>>().join("; ");
        page.push_str(&format!("| `{code}` | {exits} | {messages} | {rooms} |\n"));
    }
    page
}

/// A message with `…` for its placeholders, escaped for a cell of a table.
fn shown(message: &str) -> String {
    let mut parts = message.replace("{{", "(").replace("}}", ")");
    while let Some(begin) = parts.find('{') {
        let end = parts[begin..].find('}').map_or(parts.len(), |length| begin + length + 1);
        parts.replace_range(begin..end, "…");
    }
    parts.replace("\\\"", "\"").replace("\\n", " ").replace('|', "\\|").replace('<', "&lt;")
}
