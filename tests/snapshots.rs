//! Snapshots of what people see: help, plans of the shipped recipes, manifest and tables of the small dataset.

use crate::street::Street;
use crate::support::{cosfly, repository_root};

#[test]
fn help_reads_as_it_should() {
    for (name, arguments) in [
        ("help", vec!["--help"]),
        ("help_run", vec!["run", "--help"]),
        ("help_why", vec!["why", "--help"]),
        ("help_gc", vec!["gc", "--help"]),
    ] {
        insta::assert_snapshot!(name, cosfly(&arguments).run_ok().stdout);
    }
}

#[test]
fn every_shipped_recipe_has_a_plan_and_a_graph() {
    let mut recipes: Vec<_> = std::fs::read_dir(repository_root().join("recipes"))
        .expect("recipes")
        .map(|entry| entry.expect("entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    recipes.sort();
    for recipe in recipes {
        let name = recipe.file_stem().expect("a name").to_string_lossy().into_owned();
        let path = format!("recipes/{name}.toml");
        let store = tempfile::tempdir().expect("scratch");
        let store = store.path().join("store").display().to_string();
        let plan = cosfly(&["plan", &path, "--store", &store]).run_ok().stdout.replace(&store, "<store>");
        insta::assert_snapshot!(format!("plan_{name}"), plan);
        insta::assert_snapshot!(format!("graph_{name}"), cosfly(&["graph", &path]).run_ok().stdout);
    }
}

/// Redactions: digests of 64 hex digits become `<digest>`, the version of cosfly `<version>`.
fn redacted(text: &str) -> String {
    let mut out = String::new();
    let mut hex = String::new();
    for letter in text.chars().chain(['\n']) {
        if letter.is_ascii_hexdigit() && !letter.is_ascii_uppercase() {
            hex.push(letter);
            continue;
        }
        out.push_str(if hex.len() == 64 { "<digest>" } else { &hex });
        hex.clear();
        out.push(letter);
    }
    out.replace(env!("CARGO_PKG_VERSION"), "<version>")
}

#[test]
fn the_street_dataset_has_this_card_and_these_files() {
    let street = Street::new();
    let printed = cosfly(&["run", "recipe.toml", "--jobs", "1"]).within(street.path()).run_ok();
    // Redaction: the time it took.
    let (before, after) = printed.stdout.split_once(", in ").expect("a time");
    let summary = format!("{before}, in <time>\n{}", after.split_once('\n').expect("more lines").1);
    insta::assert_snapshot!("street_summary", summary);
    let files: Vec<String> =
        crate::support::tree_digests(&street.dataset()).into_iter().map(|(name, _)| name).collect();
    insta::assert_snapshot!("street_files", files.join("\n"));
    let card = std::fs::read_to_string(street.dataset().join("README.md")).expect("a card");
    insta::assert_snapshot!("street_card", redacted(&card));
    let verified = cosfly(&["verify", "out/street"]).within(street.path()).run_ok();
    insta::assert_snapshot!("street_verify", verified.stdout);
}
