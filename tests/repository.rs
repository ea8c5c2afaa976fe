//! Repository rules: heavy crates in their rooms, file headers, generated files, links of the book.

use crate::house::edges;
use crate::support::{cosfly, repository_root};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

#[test]
fn heavy_crates_stay_in_their_one_room() {
    let rooms: BTreeMap<&str, &[&str]> = BTreeMap::from([
        ("toml", &["cosfly-recipe"][..]),
        ("arrow-array", &["shelf data"][..]),
        ("parquet", &["shelf data"][..]),
        ("mcap", &["shelf data"][..]),
        ("clap", &["cosfly", "shelf lab"][..]),
        ("cosfly-stages", &["cosfly", "shelf lab"][..]),
        ("indicatif", &["cosfly", "cosfly-lab"][..]),
        ("roxmltree", &["cosfly-maps"][..]),
        ("obvhs", &["cosfly-lab"][..]),
        ("wasmtime", &["cosfly-plugin-host"][..]),
        ("parry3d", &["cosfly-lab"][..]),
        ("pyo3", &["cosfly-python"][..]),
        ("numpy", &["cosfly-python"][..]),
        ("object_store", &["cosfly-remote"][..]),
        ("tokio", &["cosfly-remote"][..]),
        ("ureq", &["cosfly-remote", "cosfly-teacher"][..]),
        ("tungstenite", &["cosfly-fly"][..]),
        ("rmpv", &["cosfly-fly"][..]),
    ]);
    for (name, room) in edges::rooms() {
        let places = [name.clone(), format!("shelf {}", room.shelf)];
        for dependency in room.uses.iter().filter(|(_, is_dev)| !**is_dev).map(|(dependency, _)| dependency) {
            if let Some(rooms) = rooms.get(dependency.as_str()) {
                let is_allowed = places.iter().any(|place| rooms.contains(&place.as_str()));
                assert!(is_allowed, "`{name}` uses `{dependency}`, which belongs in {}", rooms.join(", "));
            }
        }
    }
}

/// Crates with the features that one command builds them with, as Cargo prints both.
fn crates_and_features(selection: &[&str]) -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--offline", "--prefix", "none", "--format", "{p} [{f}]"])
        .args(selection)
        .current_dir(repository_root())
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    text.lines().map(|line| line.trim_end_matches(" (*)").to_owned()).collect()
}

#[test]
fn the_program_its_tests_and_the_wheel_are_one_build() {
    let of_all = crates_and_features(&["--workspace", "--edges", "normal,build,dev"]);
    for package in ["cosfly", "cosfly-python"] {
        let of_one = crates_and_features(&["--package", package, "--edges", "normal,build"]);
        let built_twice: Vec<_> = of_one.difference(&of_all).collect();
        assert!(
            built_twice.is_empty(),
            "`cargo build -p {package}` and `cargo test --workspace` build these crates with other features, and all that \
             stand on them twice: name the missing features in engine/edge/one-build/Cargo.toml: {built_twice:#?}"
        );
    }
}

#[test]
fn the_tests_of_the_readme_are_those_of_ci() {
    let readme = std::fs::read_to_string(repository_root().join("README.md")).expect("a README");
    let run = std::fs::read_to_string(repository_root().join(".ci/run")).expect("the checks");
    let after = readme.split("## Test it\n\n```sh\n").nth(1).expect("a command");
    let command = after.lines().next().expect("a line");
    assert!(run.contains(&format!("tests() {{ {command}; }}")), "`.ci/run tests` is not `{command}`");
}

/// Appends the Rust files below a folder.
pub fn rust_files(dir: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(dir).expect("readable").map(|entry| entry.expect("entry").path()) {
        if entry.is_dir() {
            rust_files(&entry, found);
        } else if entry.extension().is_some_and(|extension| extension == "rs") {
            found.push(entry);
        }
    }
}

#[test]
fn every_file_says_what_is_in_its_room_and_none_is_called_utils() {
    let mut files = vec![];
    rust_files(&repository_root().join("engine"), &mut files);
    rust_files(&repository_root().join("tests"), &mut files);
    for file in files {
        let text = std::fs::read_to_string(&file).expect("UTF-8");
        assert!(text.starts_with("//! ") || text.starts_with("#!["), "{} has no `//!` first line", file.display());
        let stem = file.file_stem().and_then(|stem| stem.to_str()).unwrap_or("");
        assert!(!["util", "utils", "helper", "helpers", "common", "misc"].contains(&stem), "{}", file.display());
    }
}

/// Folders of rooms whose documentation waits for a rewrite that has begun.
const WAITING: [&str; 2] = ["engine/sim/materials", "engine/sim/render"];

/// Columns, whose documentation is published with every dataset: other words are other bytes.
const PUBLISHED: &str = "engine/data/schema/src/tables";

#[test]
fn documentation_begins_with_a_noun_not_with_a_pronoun() {
    let root = repository_root();
    let mut files = vec![];
    rust_files(&root.join("engine"), &mut files);
    let mut found = vec![];
    for file in files {
        let name = file.strip_prefix(&root).expect("below").display().to_string();
        if name.contains("/tests/") || WAITING.iter().chain([&PUBLISHED]).any(|folder| name.starts_with(folder)) {
            continue;
        }
        let text = std::fs::read_to_string(&file).expect("UTF-8");
        let mut is_inside = false;
        for (number, line) in text.lines().map(str::trim_start).enumerate() {
            let said = line.strip_prefix("/// ").or_else(|| line.strip_prefix("//! "));
            let first = said.filter(|_| !is_inside).and_then(|said| said.split([' ', ',']).next());
            if first.is_some_and(|word| ["It", "They", "What", "There", "That", "These"].contains(&word)) {
                found.push(format!("{name}:{}: {line}", number + 1));
            }
            is_inside = line.starts_with("///") || line.starts_with("//!");
        }
    }
    assert!(found.is_empty(), "documentation names its thing first: {found:#?}");
}

#[test]
fn no_room_knows_a_kind_of_stage_by_its_name() {
    let registry = cosfly_stages::registry();
    let kinds: Vec<String> = registry.iter().map(|kind| format!("\"{}\"", kind.name())).collect();
    let compares = |line: &str| {
        let names_kind = kinds.iter().any(|kind| line.contains(kind.as_str()));
        let is_about_kinds = line.contains("kind") && !line.contains(".kind()");
        let is_compared = ["==", "!=", "=>", "matches!"].iter().any(|word| line.contains(word));
        names_kind && is_about_kinds && is_compared
    };
    let mut files = vec![];
    rust_files(&repository_root().join("engine"), &mut files);
    rust_files(&repository_root().join("tests"), &mut files);
    for file in files {
        let text = std::fs::read_to_string(&file).expect("UTF-8");
        if let Some(line) = text.lines().find(|line| compares(line)) {
            panic!("{}: `{}`: ask the stage for its role (`StageProperties::role`)", file.display(), line.trim());
        }
    }
}

#[test]
fn generated_files_are_current() {
    for (arguments, path) in [
        (vec!["schema"], "schemas/recipe.schema.json"),
        (vec!["schema", "--reference"], "book/src/reference/recipe.md"),
        (vec!["schema", "--tables"], "book/src/reference/tables.md"),
        (vec!["town", "--seed", "1"], "recipes/towns/downtown.xodr"),
        (vec!["town", "--seed", "7"], "recipes/towns/uptown.xodr"),
    ] {
        let fresh = cosfly(&arguments).run_ok().stdout;
        let kept = std::fs::read_to_string(repository_root().join(path)).unwrap_or_default();
        assert!(fresh == kept, "`{path}` is stale: run `cargo run --release -- {} > {path}`", arguments.join(" "));
    }
}

/// The workspace of libFuzzer is built by nobody here: its manifest must name what its sources use.
#[test]
fn the_manifest_of_the_fuzz_targets_names_the_rooms_that_they_use() {
    let folder = repository_root().join("tests/fuzz");
    let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).expect("readable");
    let declared = manifest.lines().filter_map(|line| line.split_once(" = { path")).map(|it| it.0.to_owned());
    let mut files = vec![];
    ["src", "fuzz_targets"].iter().for_each(|part| rust_files(&folder.join(part), &mut files));
    let is_named = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut used = BTreeSet::new();
    for file in files {
        let text = std::fs::read_to_string(&file).expect("UTF-8");
        let words = text.split(|c| !is_named(c)).filter(|word| word.starts_with("cosfly_") && *word != "cosfly_fuzz");
        used.extend(words.map(|word| word.replace('_', "-")));
    }
    assert_eq!(declared.collect::<BTreeSet<_>>(), used);
}

#[test]
fn every_link_and_page_of_the_book_exists() {
    let book = repository_root().join("book/src");
    let summary = std::fs::read_to_string(book.join("SUMMARY.md")).expect("the book has a summary");
    let mut pages = vec![book.join("SUMMARY.md"), repository_root().join("README.md")];
    for target in links(&summary) {
        pages.push(book.join(target));
    }
    for page in pages {
        let text = std::fs::read_to_string(&page).unwrap_or_else(|_| panic!("{} is missing", page.display()));
        for target in links(&text) {
            let path = page.parent().expect("a folder").join(target.split('#').next().expect("a path"));
            assert!(path.exists(), "{} links to {}, which is not there", page.display(), path.display());
        }
    }
}

#[test]
fn nothing_says_that_an_index_has_the_package() {
    // None has it yet; whoever took the name there would be installed.
    let told = concat!("pip install ", "cosfly");
    let mut folders = ["book/src", "recipes", "engine/edge/python"].map(|it| repository_root().join(it)).to_vec();
    let mut files = vec![repository_root().join("README.md")];
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).expect("readable").map(|entry| entry.expect("entry").path()) {
            if path.is_dir() { &mut folders } else { &mut files }.push(path);
        }
    }
    for file in files {
        // A wheel of a release is a file.
        let Ok(text) = std::fs::read_to_string(&file) else { continue };
        let named = text.match_indices(told).find(|(at, _)| !text[at + told.len()..].starts_with("-*.whl"));
        assert!(named.is_none(), "{}: `{told}`; in a clone it is `pip install .`", file.display());
    }
}

#[test]
fn the_summary_lists_every_page_of_the_book_once() {
    let book = repository_root().join("book/src");
    let listed = links(&std::fs::read_to_string(book.join("SUMMARY.md")).expect("the book has a summary"));
    let once: BTreeSet<&String> = listed.iter().collect();
    assert_eq!(once.len(), listed.len(), "SUMMARY.md lists a page twice, which mdBook refuses");
    let mut folders = vec![book.clone()];
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).expect("readable").map(|entry| entry.expect("entry").path()) {
            let name = path.strip_prefix(&book).expect("below the book").display().to_string();
            if path.is_dir() {
                folders.push(path);
            } else if name.ends_with(".md") && name != "SUMMARY.md" {
                assert!(once.contains(&name), "SUMMARY.md does not list {name}");
            }
        }
    }
}

/// Relative targets of links and pictures in a Markdown text.
fn links(text: &str) -> Vec<String> {
    text.split("](")
        .skip(1)
        .filter_map(|rest| rest.split(')').next())
        .filter(|target| !target.starts_with("http") && !target.starts_with('#') && !target.is_empty())
        .map(str::to_owned)
        .collect()
}
