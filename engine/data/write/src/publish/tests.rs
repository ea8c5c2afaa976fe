//! A published dataset is complete, the same twice, and hashes to what it says.

use cosfly_fingerprint::sha256::sha256_of;
use cosfly_sample as sample;
use cosfly_schema::{DatasetConfig, EncodingConfig};
use std::collections::BTreeMap;
use std::path::Path;

fn files_below(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().to_str().unwrap().to_owned();
                files.insert(name, std::fs::read(path).unwrap());
            }
        }
    }
    files
}

fn publish() -> BTreeMap<String, Vec<u8>> {
    let folder = tempfile::tempdir().unwrap();
    sample::write_to_folder(folder.path(), &DatasetConfig::default(), EncodingConfig::default()).unwrap();
    files_below(folder.path())
}

#[test]
fn the_same_dataset_has_the_same_bytes() {
    assert!(publish() == publish());
}

#[test]
fn words_of_a_recipe_are_text_in_card_page_and_manifest() {
    let foreign = "<script>x</script>: \"a\" }{ | `b`\n---\n# c\u{1b}[31m\u{202e}";
    let mut config = DatasetConfig { title: foreign.into(), url: foreign.into(), ..DatasetConfig::default() };
    (config.creator.name, config.license.name, config.license.url) = (foreign.into(), foreign.into(), foreign.into());
    let folder = tempfile::tempdir().unwrap();
    sample::write_to_folder(folder.path(), &config, EncodingConfig::default()).unwrap();
    let text = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let (card, page) = (text("README.md"), text("report/index.html"));
    for (name, text) in [("card", &card), ("page", &page)] {
        assert!(!text.contains(['\u{1b}', '\u{202e}']), "{name}");
    }
    assert!(!card.contains("\n# c"));
    assert!(!page.contains("<script"));
    let (front, body) = card.strip_prefix("---\n").unwrap().split_once("\n---\n").unwrap();
    let keys = |line: &&str| !line.starts_with([' ', '-']);
    let keys: Vec<&str> = front.lines().filter(keys).map(|line| line.split(':').next().unwrap()).collect();
    let known = [
        "pretty_name",
        "license",
        "license_name",
        "license_link",
        "size_categories",
        "language",
        "task_categories",
        "tags",
        "configs",
    ];
    assert_eq!(keys, known);
    let citation = body.split("```bibtex\n").nth(1).unwrap().split("\n```").next().unwrap();
    assert_eq!(citation.matches('{').count(), citation.matches('}').count(), "{citation}");
    let manifest: serde_json::Value = serde_json::from_str(&text("croissant.json")).unwrap();
    assert_eq!(manifest["creator"]["name"], foreign);
}

#[test]
fn the_layout_is_the_documented_one() {
    let files = publish();
    let names: Vec<&str> = files.keys().map(String::as_str).filter(|name| !name.starts_with("data/")).collect();
    assert_eq!(
        names,
        [
            "LICENSE",
            "README.md",
            "SHA256SUMS",
            "croissant.json",
            "files.parquet",
            "layouts/foxglove.json",
            "layouts/show_in_rerun.py",
            "mcap/plain/000/expert-p00000.mcap",
            "mcap/plain/000/expert-p00001.mcap",
            "mcap/plain/000/perturbed-p00000.mcap",
            "mcap/plain/000/perturbed-p00001.mcap",
            "report/index.html",
            "schemas/cosfly.proto",
            "splits.json",
        ]
    );
    for table in ["trajectories", "frames", "waypoints", "captions", "pairs", "bodies", "windows", "rejected"] {
        assert!(files.keys().any(|name| name.starts_with(&format!("data/{table}/"))), "{table}");
    }
}

#[test]
fn the_sums_are_right_and_croissant_names_the_hash_of_the_file_table() {
    let files = publish();
    let sums = std::str::from_utf8(&files["SHA256SUMS"]).unwrap();
    assert_eq!(sums.lines().count(), 2);
    for line in sums.lines() {
        let (sum, name) = line.split_once("  ").unwrap();
        assert_eq!(sum, sha256_of(&files[name]), "{name}");
    }
    let croissant: serde_json::Value = serde_json::from_slice(&files["croissant.json"]).unwrap();
    let objects = croissant["distribution"].as_array().unwrap();
    let table = objects.iter().find(|object| object["@id"] == "files.parquet").unwrap();
    assert_eq!(table["sha256"], sha256_of(&files["files.parquet"]));
}

#[test]
fn the_card_keeps_the_configs_of_tables_without_rows_and_says_which_they_are() {
    let experts = sample::flights().into_iter().filter(|flight| flight.record.pair.is_none()).collect();
    let folder = tempfile::tempdir().unwrap();
    sample::write_flights(folder.path(), &DatasetConfig::default(), EncodingConfig::default(), experts).unwrap();
    let card = std::fs::read_to_string(folder.path().join("README.md")).unwrap();
    assert!(card.contains("# tables: frames, trajectories, waypoints, captions, bodies, phrases, goals\n"), "{card}");
    // A loader that was written for a dataset with pairs finds the config in this one, too.
    let configs: Vec<&str> = card.lines().filter_map(|line| line.strip_prefix("- config_name: ")).collect();
    let all = cosfly_schema::tables::of_trajectories();
    for table in all.iter().map(|table| table.name).chain(["objects", "rejected", "files"]) {
        assert!(configs.contains(&table), "{table}: {configs:?}");
    }
    assert!(card.contains("Tables without rows in this dataset: `pairs`"), "{card}");
    assert!(card.contains("    path: data/pairs/"), "{card}");
    // Parquet files without a row group: loaders take the size of the first one for a batch.
    for entry in std::fs::read_dir(folder.path().join("data/pairs")).unwrap() {
        let file = std::fs::File::open(entry.unwrap().path()).unwrap();
        let read = parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder::try_new(file).unwrap();
        assert_eq!(read.metadata().num_row_groups(), 0);
    }
}

#[test]
fn card_and_manifest_call_those_who_are_followed_targets() {
    let files = publish();
    let card = String::from_utf8(files["README.md"].clone()).unwrap();
    assert!(card.contains("keeps a moving target in view") && card.contains("\n| targets | "), "{card}");
    let croissant: serde_json::Value = serde_json::from_slice(&files["croissant.json"]).unwrap();
    assert!(!croissant["description"].as_str().unwrap().contains("pedestrian"));
    assert!(!croissant["rai:dataCollectionMissingData"].to_string().contains("pedestrian"), "{croissant}");
}

#[test]
fn the_card_says_where_no_flight_is_as_long_as_a_window() {
    let card = |size| {
        let mut config = DatasetConfig::default();
        (config.windows.size, config.windows.history) = (size, 1);
        let folder = tempfile::tempdir().unwrap();
        sample::write_flights(folder.path(), &config, EncodingConfig::default(), sample::flights()).unwrap();
        std::fs::read_to_string(folder.path().join("README.md")).unwrap()
    };
    assert!(card(900).contains("| training windows | none: no flight has the 900 frames of one |"));
    assert!(!card(2).contains("training windows | none"));
}

#[test]
fn a_dataset_without_a_flight_is_refused_with_the_reasons() {
    let folder = tempfile::tempdir().unwrap();
    let outcome = sample::write_flights(folder.path(), &DatasetConfig::default(), EncodingConfig::default(), vec![]);
    let error = outcome.unwrap_err();
    assert!(error.message.contains("no flight to publish") && error.causes[0].contains("cannot be reached"), "{error}");
}

#[test]
fn flights_in_a_guard_band_are_left_out_with_a_reason_and_the_areas_are_written_down() {
    use cosfly_schema::Split;
    use cosfly_schema::config::{AreaCut, CutAxis, SplitBy, SplitShares};
    let cut = |at_m| AreaCut { axis: CutAxis::X, splits: vec![Split::Train, Split::Test], at_m: vec![at_m] };
    let config = |at_m, guard_m| DatasetConfig {
        splits: SplitShares {
            by: SplitBy::Area,
            guard_m,
            areas: BTreeMap::from([("plain".to_owned(), cut(at_m))]),
            ..SplitShares::default()
        },
        ..DatasetConfig::default()
    };
    // Both pedestrians start at x = 0; one walks to x = 2.4 m, the other to 0.5 m.
    let folder = tempfile::tempdir().unwrap();
    let summary = sample::write_to_folder(folder.path(), &config(1.0, 0.2), EncodingConfig::default()).unwrap();
    assert_eq!((summary.experts, summary.perturbed, summary.rejected), (1, 1, 3));
    assert!(summary.warnings[0].starts_with("2 of 4 flights were left out"), "{:?}", summary.warnings);
    let policy = std::fs::read_to_string(folder.path().join("splits.json")).unwrap();
    assert!(policy.contains("\"plain\""), "{policy}");
    let refusal = sample::write_to_folder(folder.path(), &config(0.3, 0.2), EncodingConfig::default()).unwrap_err();
    assert!(refusal.to_string().contains("no flight to publish"), "{refusal}");
}
