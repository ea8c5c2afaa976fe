//! The law of the shelves, over every edge of the dependency graph: normal, optional, for builds and for tests.

use crate::support::repository_root;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

/// A room: its shelf, and the packages that it names.
pub struct Room {
    /// `base`, `sim`, `flow`, `data`, `edge` or `lab`.
    pub shelf: String,
    /// The folder of its sources.
    pub folder: PathBuf,
    /// Names of all packages that it depends on; true for those of its tests alone.
    pub uses: BTreeMap<String, bool>,
}

/// What each shelf may see beside itself.
const LAW: [(&str, &[&str]); 6] = [
    ("base", &[]),
    ("sim", &["base"]),
    ("flow", &["base"]),
    ("data", &["base"]),
    ("edge", &["base", "sim", "flow", "data"]),
    ("lab", &["base", "sim", "flow", "data", "edge"]),
];

/// Fixtures: rooms that tests may use, and the lab; nothing that a user runs.
const FIXTURES: [&str; 2] = ["cosfly-sample", "cosfly-toys"];

/// Rooms of `sim` that the shelf `data` may see: all of it the first, the rooms that check or draw again what was filmed the others.
const SIM_FOR_DATA: [(&[&str], &[&str]); 2] = [
    (&["cosfly-metrics"], &["*"]),
    (&["cosfly-geometry", "cosfly-town"], &["cosfly-verify", "cosfly-doctor", "cosfly-evaluate", "cosfly-preview"]),
];

/// Edges beyond the law: who, whom, why. An edge that is gone must leave the list.
const BEYOND: &[(&str, &[&str], &str)] = &[
    ("cosfly-doctor", &["cosfly-captions"], "judges texts of others against the world"),
    ("cosfly-env", &["cosfly-scenes"], "tests: seeded streets"),
    ("cosfly-export", &["cosfly-captions"], "names bodies in the languages of captions"),
    ("cosfly-planner", &["cosfly-scenes"], "tests: seeded streets"),
    ("cosfly-report", &["cosfly-captions"], "counts what texts say"),
    ("cosfly-sample", &["cosfly-captions", "cosfly-figures", "cosfly-planner"], "makes a dataset for tests"),
    ("cosfly-verify", &["cosfly-optics"], "places rows of a rolling shutter at their moments"),
    ("cosfly-verify", &["cosfly-sensors"], "casts points of lidars again from the airframe of their time"),
    ("cosfly-write", &["cosfly-captions"], "words goals, phrases and instructions of windows"),
    ("cosfly-write", &["cosfly-optics"], "tells logs when rows of a rolling shutter were taken"),
];

/// All rooms by their names, from the resolved graph and from what manifests declare (the graph lacks what features leave out).
pub fn rooms() -> BTreeMap<String, Room> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--offline"])
        .current_dir(repository_root())
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).expect("cargo metadata is JSON");
    let list = |value: &serde_json::Value| value.as_array().expect("a list").clone();
    let text = |value: &serde_json::Value| value.as_str().expect("a text").to_owned();
    let packages = list(&metadata["packages"]);
    let names: BTreeMap<String, String> = packages.iter().map(|it| (text(&it["id"]), text(&it["name"]))).collect();
    let mut rooms = BTreeMap::new();
    for package in &packages {
        let manifest = text(&package["manifest_path"]);
        let Some((_, rest)) = manifest.split_once("/engine/").filter(|_| package["source"].is_null()) else { continue };
        let shelf = rest.split('/').next().expect("a shelf").to_owned();
        let folder = Path::new(&manifest).with_file_name("src");
        let mut uses = BTreeMap::new();
        let mut add =
            |name: String, is_dev: bool| _ = uses.entry(name).and_modify(|dev| *dev &= is_dev).or_insert(is_dev);
        for declared in list(&package["dependencies"]) {
            add(text(&declared["name"]), declared["kind"].as_str() == Some("dev"));
        }
        let nodes = list(&metadata["resolve"]["nodes"]);
        for edge in nodes.iter().filter(|node| node["id"] == package["id"]).flat_map(|node| list(&node["deps"])) {
            let is_dev = list(&edge["dep_kinds"]).iter().all(|kind| kind["kind"].as_str() == Some("dev"));
            add(names[&text(&edge["pkg"])].clone(), is_dev);
        }
        rooms.insert(text(&package["name"]), Room { shelf, folder, uses });
    }
    rooms
}

/// Whether the law allows an edge, the list of exceptions aside.
fn is_lawful(name: &str, room: &Room, other: &str, of_other: &Room, is_dev: bool) -> bool {
    if FIXTURES.contains(&other) {
        return is_dev || room.shelf == "lab";
    }
    let seen = LAW.iter().find(|(shelf, _)| *shelf == room.shelf).map_or(&[][..], |(_, seen)| seen);
    let of_sim =
        SIM_FOR_DATA.iter().any(|(rooms, by)| rooms.contains(&other) && (by.contains(&"*") || by.contains(&name)));
    of_other.shelf == room.shelf || seen.contains(&of_other.shelf.as_str()) || room.shelf == "data" && of_sim
}

#[test]
fn the_architecture_names_every_room() {
    let text = std::fs::read_to_string(repository_root().join("ARCHITECTURE.md")).expect("readable");
    let words: BTreeSet<&str> = text.split(|sign: char| !sign.is_ascii_alphanumeric() && sign != '-').collect();
    let folders = rooms().into_values().filter_map(|room| room.folder.parent().map(Path::to_owned));
    let names = folders.filter_map(|folder| Some(folder.file_name()?.to_str()?.to_owned()));
    let unnamed: Vec<_> = names.filter(|name| !words.contains(name.as_str())).collect();
    assert!(unnamed.is_empty(), "say in ARCHITECTURE.md what is in these rooms: {unnamed:?}");
}

#[test]
fn shelves_see_what_the_law_allows() {
    let rooms = rooms();
    let mut beyond = BTreeSet::new();
    for (name, room) in &rooms {
        for (other, is_dev) in &room.uses {
            if rooms.get(other).is_some_and(|of_other| !is_lawful(name, room, other, of_other, *is_dev)) {
                beyond.insert(format!("{name} -> {other}"));
            }
        }
    }
    let listed =
        BEYOND.iter().flat_map(|(name, others, _)| others.iter().map(move |other| format!("{name} -> {other}")));
    let listed: BTreeSet<String> = listed.collect();
    let new: Vec<_> = beyond.difference(&listed).collect();
    let gone: Vec<_> = listed.difference(&beyond).collect();
    assert!(new.is_empty(), "edges against the law of ARCHITECTURE.md; move what both need below both: {new:#?}");
    assert!(gone.is_empty(), "these edges are gone: take them off the list of exceptions: {gone:#?}");
}
