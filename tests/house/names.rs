//! One name, one type: no two crates show types of one name to others, so that a search for a name finds its meaning.

use super::circles::crates;
use super::interfaces::{names_of_uses, text, tops};
use super::modules::Crate;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Names that say what their module says: `schema::tables::Column` is a column of a table. A name that is shown once must leave the list.
const IDIOMS: [&str; 11] =
    ["Baseline", "Claim", "Column", "Format", "Kind", "Metric", "Part", "Plan", "Roof", "Shared", "Source"];

/// Types for builds without plugins: those of `plugin-host` under the same names.
const STAND_IN: &str = "edge/experts/src/plugins/absent.rs";

/// The libraries of the engine; nobody uses those of the lab.
fn libraries() -> Vec<PathBuf> {
    let of_engine = |folder: &PathBuf| {
        let shelf = folder.parent().expect("a shelf");
        shelf.parent().is_some_and(|engine| engine.ends_with("engine")) && !shelf.ends_with("lab")
    };
    let roots = crates().into_iter().filter(of_engine).map(|folder| folder.join("src/lib.rs"));
    roots.filter(|root| root.exists()).collect()
}

/// Names of the types that a crate shows: those of its open modules, and those that open modules hand on.
fn public_types(root: &Path) -> BTreeSet<String> {
    let read = Crate::read(root);
    let open = read.public_modules();
    let handed_on: BTreeSet<String> =
        open.iter().flat_map(|module| names_of_uses(&read.modules[*module].tokens)).collect();
    let mut types = BTreeSet::new();
    for (number, module) in read.modules.iter().enumerate().filter(|(_, module)| !module.file.ends_with(STAND_IN)) {
        let tokens = &module.tokens;
        let is_type = |at: &usize| {
            text(tokens, *at) == "pub" && ["struct", "enum", "trait", "type"].contains(&text(tokens, at + 1))
        };
        let names = tops(tokens).filter(is_type).map(|at| text(tokens, at + 2).to_owned());
        types.extend(names.filter(|name| open.contains(&number) || handed_on.contains(name)));
    }
    types
}

/// Rooms that hand on names of another: file, whose names, why.
const HANDED_ON: [(&str, &str, &str); 4] = [
    ("base/frames/src/lib.rs", "cosfly_random", "poses and seeds are the two things that every engine starts from"),
    (
        "sim/captions/src/lib.rs",
        "cosfly_claims",
        "`data` may see captions, and the words that texts are judged by through them",
    ),
    ("sim/planner/src/config/mod.rs", "cosfly_surroundings", "a front names the types of its own settings"),
    ("edge/experts/src/plugins/mod.rs", "cosfly_plugin_host", "builds without plugins have a stand-in"),
];

#[test]
fn a_use_line_says_whose_names_it_takes() {
    let engine = crate::support::repository_root().join("engine");
    let mut files = vec![];
    crate::repository::rust_files(&engine, &mut files);
    let mut found = BTreeSet::new();
    for file in files {
        let text = std::fs::read_to_string(&file).expect("UTF-8");
        let name = file.strip_prefix(&engine).expect("below").display().to_string();
        let handed = text.lines().filter_map(|line| line.trim_start().strip_prefix("pub use cosfly_"));
        found.extend(handed.map(|rest| (name.clone(), format!("cosfly_{}", rest.split("::").next().unwrap_or("")))));
    }
    let listed = HANDED_ON.iter().map(|(file, whose, _)| ((*file).to_owned(), (*whose).to_owned())).collect();
    assert_eq!(found, listed, "import names from the room that has them, or say in this list why not");
}

#[test]
fn no_two_crates_show_types_of_one_name() {
    let mut shown: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for root in libraries() {
        let room = root.ancestors().nth(2).and_then(Path::file_name).expect("a room").to_string_lossy().into_owned();
        for name in public_types(&root) {
            shown.entry(name).or_default().push(room.clone());
        }
    }
    let twice: BTreeMap<&str, &Vec<String>> =
        shown.iter().filter(|(_, rooms)| rooms.len() > 1).map(|(name, rooms)| (name.as_str(), rooms)).collect();
    let new: BTreeMap<_, _> = twice.iter().filter(|(name, _)| !IDIOMS.contains(name)).collect();
    let gone: Vec<_> = IDIOMS.iter().filter(|name| !twice.contains_key(*name)).collect();
    assert!(new.is_empty(), "types of one name in several rooms; give each a name of its own: {new:#?}");
    assert!(gone.is_empty(), "these names are shown once: take them off the list of idioms: {gone:?}");
}
