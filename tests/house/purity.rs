//! Purity of the shelf `sim`: no files, clock, environment, processes or network; what it computes depends on values alone.

use super::circles::crates;
use super::tokens::{Token, tokens_of_file};
use crate::repository::rust_files;
use crate::support::repository_root;

/// Modules of the standard library that reach outside.
const OUTSIDE: [&str; 6] = ["fs", "env", "time", "net", "process", "os"];
/// Types and macros that reach outside, however they were imported.
const NAMES: [&str; 11] = [
    "File", "Path", "PathBuf", "OpenOptions", "Instant", "SystemTime", "Stdin", "Stdout", "Command", "println", "eprintln",
];
/// Uses with a reason: file and name.
const ALLOWED: [(&str, &str); 0] = [];

/// Names in a text that reach outside.
fn impure(tokens: &[Token]) -> Vec<String> {
    let text = |at: usize| tokens.get(at).map_or("", |token| token.text.as_str());
    let mut found = vec![];
    for at in 0..tokens.len() {
        if text(at) == "std" && text(at + 1) == "::" {
            let names = if text(at + 2) == "{" { at + 3..at + 40 } else { at + 2..at + 3 };
            let names = names.take_while(|at| text(*at) != ";").filter(|at| text(*at - 1) != "::" || text(*at - 2) == "std");
            found.extend(names.map(text).filter(|name| OUTSIDE.contains(name)).map(|name| format!("std::{name}")));
        }
        if NAMES.contains(&text(at)) && (at == 0 || !["::", "."].contains(&text(at - 1)) || text(at.saturating_sub(2)) != "Self") {
            found.push(text(at).to_owned());
        }
    }
    found.sort();
    found.dedup();
    found
}

#[test]
fn the_simulation_has_no_files_clock_or_environment() {
    let root = repository_root();
    let mut found = vec![];
    for folder in crates().iter().filter(|folder| folder.starts_with(root.join("engine/sim"))) {
        let mut files = vec![];
        rust_files(&folder.join("src"), &mut files);
        for file in files.iter().filter(|file| !file.ends_with("tests.rs")) {
            let name = file.strip_prefix(&root).expect("ours").display().to_string();
            let names = impure(&tokens_of_file(file));
            let names = names.into_iter().filter(|used| !ALLOWED.contains(&(name.as_str(), used.as_str())));
            found.extend(names.map(|used| format!("{name}: `{used}`")));
        }
    }
    assert!(found.is_empty(), "`sim` computes on values; give it what these read:\n{}", found.join("\n"));
}
