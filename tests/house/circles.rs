//! No circles of files within a crate: of two files at most one names the other, through however many steps.

use super::modules::Crate;
use crate::support::repository_root;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Crates whose circles wait for a rewrite that has begun.
const WAITING: [&str; 4] = ["engine/sim/captions", "engine/sim/claims", "engine/edge/stages", "engine/edge/fly"];

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

/// Groups of files of a crate that reach each other.
fn circles(root: &Path) -> Vec<Vec<PathBuf>> {
    let of = Crate::read(root);
    let mut edges = of.edges();
    for (module, edges) in of.modules.iter().zip(&mut edges) {
        if is_list(&module.file) {
            edges.clear();
        }
    }
    let reached: Vec<BTreeSet<usize>> = (0..edges.len()).map(|from| reached_from(&edges, from)).collect();
    let mut circles = BTreeSet::new();
    for (from, reached_here) in reached.iter().enumerate().filter(|(from, reached)| reached.contains(from)) {
        let circle: BTreeSet<usize> =
            reached_here.iter().copied().filter(|other| reached[*other].contains(&from)).collect();
        if std::env::var("SHOW").is_ok() {
            for b in edges[from].iter().filter(|b| circle.contains(b)) {
                println!("   {} -> {}", of.modules[from].file.display(), of.modules[*b].file.display());
            }
        }
        circles.insert(circle);
    }
    circles.iter().map(|circle| circle.iter().map(|module| of.modules[*module].file.clone()).collect()).collect()
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
    let root = repository_root();
    let mut found = vec![];
    for folder in crates().iter().filter(|folder| !WAITING.iter().any(|waiting| folder.ends_with(waiting))) {
        for circle in roots(folder).iter().flat_map(|root| circles(root)) {
            let names: Vec<_> =
                circle.iter().map(|file| file.strip_prefix(&root).expect("ours").display().to_string()).collect();
            found.push(names.join("\n    "));
        }
    }
    assert!(
        found.is_empty(),
        "files that use each other: move what both need into a file below both.\n{} circles:\n{}",
        found.len(),
        found.join("\n\n")
    );
}
