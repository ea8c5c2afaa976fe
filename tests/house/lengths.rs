//! Lengths: functions of at most 80 code lines; `mod.rs` and `lib.rs` list what is in their folder and do no work.

use super::circles::crates;
use super::tokens::{Token, code_lines, end_of_group, tokens_of_file};
use crate::repository::rust_files;
use crate::support::repository_root;
use std::path::{Path, PathBuf};

/// Most code lines of a function, and of a file that lists its folder.
const MOST_LINES: usize = 80;
/// Most code lines of a list that is a function, such as the tables of a dataset, or of a look-up in a list.
const MOST_OF_LIST: usize = 30;

/// Crates whose functions and lists wait for a rewrite that has begun.
const WAITING: [&str; 0] = [];

/// The files in the folders `src` of all crates that do not wait, without those of tests.
pub fn sources() -> Vec<PathBuf> {
    let mut files = vec![];
    for folder in crates().iter().filter(|folder| !WAITING.iter().any(|waiting| folder.ends_with(waiting))) {
        rust_files(&folder.join("src"), &mut files);
    }
    files.retain(|file| !file.ends_with("tests.rs") && !file.components().any(|part| part.as_os_str() == "tests"));
    files.sort();
    files
}

/// Names and code lines of the functions of a file, bodies included.
fn functions(tokens: &[Token]) -> Vec<(String, usize)> {
    let mut found = vec![];
    for (at, token) in tokens.iter().enumerate() {
        let name = tokens.get(at + 1).filter(|next| token.text == "fn" && next.is_word());
        let Some(name) = name else { continue };
        let body = tokens[at..].iter().position(|token| token.text == "{" || token.text == ";");
        if let Some(start) = body.filter(|offset| tokens[at + offset].text == "{").map(|offset| at + offset) {
            found.push((name.text.clone(), code_lines(&tokens[at..end_of_group(tokens, start)])));
        }
    }
    found
}

fn shown(file: &Path) -> String {
    file.strip_prefix(repository_root()).expect("ours").display().to_string()
}

#[test]
fn no_function_is_longer_than_a_screen() {
    let mut long = vec![];
    for file in sources() {
        let functions = functions(&tokens_of_file(&file));
        let beyond = functions.into_iter().filter(|(_, lines)| *lines > MOST_LINES);
        long.extend(beyond.map(|(name, lines)| format!("{lines} code lines: `{name}` in {}", shown(&file))));
    }
    assert!(long.is_empty(), "functions of more than {MOST_LINES} code lines: name their steps.\n{}", long.join("\n"));
}

#[test]
fn files_that_list_their_folder_do_no_work() {
    let mut working = vec![];
    for file in sources().iter().filter(|file| file.ends_with("mod.rs") || file.ends_with("lib.rs")) {
        let tokens = tokens_of_file(file);
        let lines = code_lines(&tokens);
        let long = functions(&tokens).into_iter().filter(|(_, lines)| *lines > MOST_OF_LIST);
        let work: Vec<_> = long.map(|(name, _)| name).collect();
        if lines > MOST_LINES || !work.is_empty() {
            working.push(format!("{lines} code lines: {}: {}", shown(file), work.join(" ")));
        }
    }
    assert!(
        working.is_empty(),
        "functions of more than {MOST_OF_LIST} code lines, or more than {MOST_LINES} in all, in files that list their folder: \
         move them into named files beside these:\n{}",
        working.join("\n")
    );
}
