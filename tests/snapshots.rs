//! Snapshots of user-visible output: help, plans of the shipped recipes, manifest and tables of the small dataset.

use crate::street::Street;
use crate::support::{cosfly, repository_root, tree_digests};
use parquet::file::reader::{FileReader, SerializedFileReader};
use std::fmt::Write;
use std::path::Path;

#[test]
fn help_reads_as_it_should() {
    for (name, arguments) in [
        ("help", vec!["--help"]),
        ("help_run", vec!["run", "--help"]),
        ("help_why", vec!["why", "--help"]),
        ("help_ask_expert", vec!["ask-expert", "--help"]),
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
    // Redaction: the duration.
    let (before, after) = printed.stdout.split_once(", in ").expect("a time");
    let summary = format!("{before}, in <time>\n{}", after.split_once('\n').expect("more lines").1);
    insta::assert_snapshot!("street_summary", summary);
    let files: Vec<String> = tree_digests(&street.dataset()).into_iter().map(|(name, _)| name).collect();
    insta::assert_snapshot!("street_files", files.join("\n"));
    let card = std::fs::read_to_string(street.dataset().join("README.md")).expect("a card");
    insta::assert_snapshot!("street_card", redacted(&card));
    let manifest = std::fs::read_to_string(street.dataset().join("croissant.json")).expect("a manifest");
    insta::assert_snapshot!("street_croissant", outline(&manifest));
    let verified = cosfly(&["verify", "out/street"]).within(street.path()).run_ok();
    insta::assert_snapshot!("street_verify", verified.stdout);
}

/// Outline of the manifest without its long texts, one line per entry. Redaction: hashes are left out.
fn outline(manifest: &str) -> String {
    let manifest: serde_json::Value = serde_json::from_str(manifest).expect("JSON");
    let mut text = String::new();
    for key in manifest.as_object().expect("an object").keys().filter(|key| *key != "@context") {
        let _ = writeln!(text, "{key}");
    }
    for (list, fields) in [("distribution", "includes"), ("recordSet", "field")] {
        for entry in manifest[list].as_array().expect("a list") {
            let about = match &entry[fields] {
                serde_json::Value::Array(fields) => format!("{} fields", fields.len()),
                serde_json::Value::String(glob) => glob.clone(),
                _ => entry["contentUrl"].as_str().unwrap_or_default().to_owned(),
            };
            let _ = writeln!(text, "{list}: {} {} ({about})", entry["@type"], entry["@id"]);
        }
    }
    text
}

#[test]
fn the_street_dataset_has_these_tables() {
    let street = Street::new();
    let plain = "stages.frames.encoding.previews=false";
    cosfly(&["run", "recipe.toml", "--quiet", "--set", plain]).within(street.path()).run_ok();
    for table in ["trajectories", "frames", "waypoints", "captions", "pairs"] {
        let folder = street.dataset().join("data").join(table);
        let mut files: Vec<_> =
            std::fs::read_dir(folder).expect("a table").map(|file| file.expect("entry").path()).collect();
        files.sort();
        insta::assert_snapshot!(format!("table_{table}"), first_row(&files[0]));
    }
}

/// First row of a table, a column per line. Redactions: digests and hashes, the size of the log.
fn first_row(file: &Path) -> String {
    let reader = SerializedFileReader::new(std::fs::File::open(file).expect("readable")).expect("Parquet");
    let rows = reader.metadata().file_metadata().num_rows();
    let first = reader.get_row_iter(None).expect("rows").next().expect("a row").expect("readable");
    let mut text = format!("{rows} rows, the first:\n");
    for (name, value) in first.get_column_iter() {
        let value = if name.ends_with("_bytes") { "<size>".to_owned() } else { redacted(&value.to_string()) };
        let _ = writeln!(text, "{name}: {}", value.trim_end());
    }
    text
}
