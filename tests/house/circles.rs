//! No circles of files within a crate: of two files at most one names the other, through however many steps.

use super::modules::Crate;
use crate::support::repository_root;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Crates whose circles wait for a rewrite that has begun.
const WAITING: [&str; 0] = [];

/// The crates of the house, plugins included, as folders.
pub fn crates() -> Vec<PathBuf> {
    let root = repository_root();
    let folders = |of: &Path| -> Vec<PathBuf> {
        std::fs::read_dir(of).expect("readable").map(|entry| entry.expect("entry").path()).collect()
    };
    let shelves = folders(&root.join("engine"));
    let mut crates: Vec<_> = shelves.iter().flat_map(|shelf| folders(shelf)).collect();
    crates.extend(folders(&root.join("plugins")));
    crates.retain(|folder| folder.join("Cargo.toml").exists());
    crates.sort();
    crates
}

/// The roots of a crate: its library and its programs.
pub fn roots(folder: &Path) -> Vec<PathBuf> {
    ["src/lib.rs", "src/main.rs"].iter().map(|root| folder.join(root)).filter(|root| root.exists()).collect()
}

/// Whether a file lists its folder: what it names is no edge.
fn is_list(file: &Path) -> bool {
    file.ends_with("mod.rs") || file.ends_with("lib.rs") || file.ends_with("main.rs")
}

/// Edges within circles of a crate, as texts: files that reach each other, and whom each of them names.
fn circles(root: &Path) -> Vec<String> {
    let of = Crate::read(root);
    let mut edges = of.edges();
    for (module, edges) in of.modules.iter().zip(&mut edges) {
        if is_list(&module.file) {
            edges.clear();
        }
    }
    let reached: Vec<BTreeSet<usize>> = (0..edges.len()).map(|from| reached_from(&edges, from)).collect();
    let shown = |module: usize| of.modules[module].file.strip_prefix(repository_root()).expect("ours").display();
    let mut found = vec![];
    for (from, to) in edges.iter().enumerate().flat_map(|(from, edges)| edges.iter().map(move |to| (from, *to))) {
        if reached[to].contains(&from) {
            found.push(format!("{} -> {}", shown(from), shown(to)));
        }
    }
    found
}

fn reached_from(edges: &[BTreeSet<usize>], from: usize) -> BTreeSet<usize> {
    let (mut reached, mut next) = (BTreeSet::new(), vec![from]);
    while let Some(at) = next.pop() {
        next.extend(edges[at].iter().filter(|to| reached.insert(**to)));
    }
    reached
}

#[test]
fn no_files_of_a_crate_use_each_other_in_a_circle() {
    let all = crates();
    let folders = all.iter().filter(|folder| !WAITING.iter().any(|waiting| folder.ends_with(waiting)));
    let found: Vec<_> = folders.flat_map(|folder| roots(folder)).flat_map(|root| circles(&root)).collect();
    assert!(
        found.is_empty(),
        "files that use each other, through others or at once: move what both need into a file below both.\n{}",
        found.join("\n")
    );
}
