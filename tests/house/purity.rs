//! Purity of the shelf `sim`: no files, clock, environment, processes or network; what it computes depends on values alone.

use super::circles::crates;
use super::tokens::{Token, tokens_of_file};
use crate::repository::rust_files;
use crate::support::repository_root;

/// Modules of the standard library that reach outside.
const OUTSIDE: [&str; 7] = ["fs", "env", "time", "net", "os", "path", "process"];
/// Macros that print or read the environment of the build.
const MACROS: [&str; 6] = ["println", "eprintln", "print", "eprint", "dbg", "env"];

/// What a text names that reaches outside.
fn outside(tokens: &[Token]) -> Vec<String> {
    let text = |at: usize| tokens.get(at).map_or("", |token| token.text.as_str());
    let mut found = vec![];
    for at in 0..tokens.len() {
        if text(at) == "std" && text(at + 1) == "::" {
            // `std::fs::File`, or `use std::{fs::File, time::Instant}`.
            let is_tree = text(at + 2) == "{";
            let names = (at + 2..).take_while(|next| if is_tree { text(*next) != ";" } else { *next == at + 2 });
            found.extend(names.map(text).filter(|name| OUTSIDE.contains(name)).map(|name| format!("std::{name}")));
        }
        if MACROS.contains(&text(at)) && text(at + 1) == "!" {
            found.push(format!("{}!", text(at)));
        }
    }
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
            let name = file.strip_prefix(&root).expect("ours").display();
            found.extend(outside(&tokens_of_file(file)).iter().map(|used| format!("{name}: `{used}`")));
        }
    }
    assert!(found.is_empty(), "`sim` computes on values; give it what these read:\n{}", found.join("\n"));
}
