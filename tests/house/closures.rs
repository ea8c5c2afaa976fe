//! Sizes: what a crate and the crates of ours below it have in code lines, and all crates together.

use super::edges::{Room, rooms};
use super::lengths::sources;
use super::tokens::{code_lines, tokens_of_file};
use std::collections::{BTreeMap, BTreeSet};

/// Most code lines of crates that others use alone, with all crates of ours that they need.
const OF_CLOSURES: [(&str, usize); 3] = [("cosfly-read", 10_000), ("cosfly-images", 3_000), ("cosfly-planner", 13_000)];
/// Most code lines of a crate.
const OF_CRATE: usize = 8_000;
/// Most code lines of a crate that adapts others.
const OF_ADAPTERS: [(&str, usize); 1] = [("cosfly-stages", 3_000)];

/// Code lines of each crate on a shelf, without those of tests.
fn lines_of_crates(rooms: &BTreeMap<String, Room>) -> BTreeMap<&str, usize> {
    let mut lines = BTreeMap::new();
    for file in sources() {
        if let Some((name, _)) = rooms.iter().find(|(_, room)| file.starts_with(&room.folder)) {
            *lines.entry(name.as_str()).or_default() += code_lines(&tokens_of_file(&file));
        }
    }
    lines
}

/// A crate and all crates of ours that it needs outside of tests.
fn closure<'a>(rooms: &'a BTreeMap<String, Room>, name: &'a str) -> BTreeSet<&'a str> {
    let (mut found, mut left) = (BTreeSet::new(), vec![name]);
    while let Some(name) = left.pop() {
        let Some(room) = rooms.get(name) else { continue };
        if found.insert(name) {
            left.extend(room.uses.iter().filter(|(_, is_dev)| !**is_dev).map(|(other, _)| other.as_str()));
        }
    }
    found
}

/// `--nocapture` prints the sizes.
#[test]
fn crates_that_others_use_alone_stay_small() {
    let rooms = rooms();
    let lines = lines_of_crates(&rooms);
    println!("{} code lines in {} crates: {lines:#?}", lines.values().sum::<usize>(), lines.len());
    for (name, most) in OF_CLOSURES {
        let crates = closure(&rooms, name);
        let all: usize = crates.iter().map(|name| lines[name]).sum();
        println!("{name} with all that it needs: {all} code lines in {crates:?}");
        assert!(all <= most, "`{name}` needs {all} code lines of ours, {most} are allowed: {crates:?}");
    }
}

#[test]
fn no_crate_grows_without_end() {
    let rooms = rooms();
    for (name, lines) in lines_of_crates(&rooms) {
        let most = OF_ADAPTERS.iter().find(|(adapter, _)| *adapter == name).map_or(OF_CRATE, |(_, most)| *most);
        assert!(
            lines <= most,
            "`{name}` has {lines} code lines, {most} are allowed: give a part of it a crate of its own"
        );
    }
}
