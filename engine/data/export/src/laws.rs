//! The laws that every export keeps, over all of them.

use crate::{Choice, Export, FORMATS, OptionKind, Source, joined_options, prepare};
use cosfly_diagnose::Result;
use cosfly_frames::real::wrap_angle_rad;
use cosfly_metrics::{DeltaFrame, DeltaOrigin};
use cosfly_read::PublishedDataset;
use cosfly_sample as sample;
use cosfly_schema::{DatasetConfig, EncodingConfig};
use serde_json::{Map, Value, json};
use std::cell::Cell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

pub(crate) fn published() -> (tempfile::TempDir, PublishedDataset) {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("sample");
    sample::write_to_folder(&folder, &DatasetConfig::default(), EncodingConfig::default()).unwrap();
    let dataset = PublishedDataset::open(&folder).unwrap();
    (home, dataset)
}

/// Options of format `name` that fit the sample's five frames.
fn options(name: &str) -> Map<String, Value> {
    let options = match name {
        "vlm" => json!({"history": 3, "horizon": 2, "stride": 1}),
        "lerobot" => json!({"depth": true, "max_depth_m": 200}),
        _ => json!({}),
    };
    options.as_object().unwrap().clone()
}

/// Formats that write what the sample has: no flight of it has a lidar.
fn formats_of_the_sample() -> impl Iterator<Item = &'static Export> {
    FORMATS.iter().filter(|format| format.name != "clouds")
}

fn export(dataset: &PublishedDataset, name: &str, out: &Path) -> Result<Vec<String>> {
    export_with(dataset, name, options(name), &Choice::default(), out)
}

pub(crate) fn export_with(
    dataset: &PublishedDataset,
    name: &str,
    options: Map<String, Value>,
    choice: &Choice,
    out: &Path,
) -> Result<Vec<String>> {
    let heard = Cell::new((0, 1));
    let progress = |done, all| heard.set((done, all));
    let (_, remarks) = prepare(name, options)?.write(dataset, choice, out, &progress)?;
    assert_eq!(heard.get().0, heard.get().1, "progress of `{name}` ends where it should");
    Ok(remarks)
}

pub(crate) fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(next).unwrap().map(|entry| entry.unwrap().path()) {
            if entry.is_dir() {
                folders.push(entry);
            } else {
                let bytes = std::fs::read(&entry).unwrap();
                found.insert(entry.strip_prefix(folder).unwrap().to_owned(), bytes);
            }
        }
    }
    found
}

#[test]
fn every_export_has_a_card_a_licence_and_the_same_bytes_twice() {
    let (home, dataset) = published();
    for format in formats_of_the_sample() {
        let [first, second] = ["first", "second"].map(|name| home.path().join(format!("{}-{name}", format.name)));
        export(&dataset, format.name, &first).unwrap();
        export(&dataset, format.name, &second).unwrap();
        let files = files(&first);
        assert!(files == self::files(&second), "`{}` differs from itself", format.name);
        let card = String::from_utf8(files[Path::new("README.md")].clone()).unwrap();
        assert!(card.starts_with("---\n") && card.contains("license:"), "{card}");
        assert!(files.contains_key(Path::new("LICENSE")), "`{}`", format.name);
        assert!(!format.doc.is_empty());
    }
}

#[test]
fn a_copy_of_a_dataset_gives_the_same_bytes_and_no_export_names_a_folder() {
    let (home, dataset) = published();
    let copy = home.path().join("a copy (2)");
    for (path, bytes) in files(dataset.folder()) {
        std::fs::create_dir_all(copy.join(&path).parent().unwrap()).unwrap();
        std::fs::write(copy.join(path), bytes).unwrap();
    }
    let copied = PublishedDataset::open(&copy).unwrap();
    let host = std::env::var("HOSTNAME").unwrap_or_default();
    let folders =
        [home.path().display().to_string(), "a copy (2)".to_owned(), host, env!("CARGO_MANIFEST_DIR").to_owned()];
    for format in formats_of_the_sample() {
        let [first, second] = ["first", "second"].map(|name| home.path().join(format!("{}-{name}", format.name)));
        export(&dataset, format.name, &first).unwrap();
        export(&copied, format.name, &second).unwrap();
        let (first, second) = (files(&first), files(&second));
        let differing = first.iter().find(|(path, bytes)| second.get(*path) != Some(*bytes));
        assert!(
            first.len() == second.len() && differing.is_none(),
            "`{}`: {:?}",
            format.name,
            differing.map(|it| it.0)
        );
        for (path, bytes) in &second {
            for folder in folders.iter().filter(|it| it.len() > 7) {
                let is_named = bytes.windows(folder.len()).any(|part| part == folder.as_bytes());
                assert!(!is_named, "`{}` of `{}` names `{folder}`", path.display(), format.name);
            }
        }
    }
}

#[test]
fn every_episode_of_lerobot_has_its_own_statistics() {
    let (home, dataset) = published();
    let out = home.path().join("lerobot");
    export(&dataset, "lerobot", &out).unwrap();
    let splits: Vec<PathBuf> =
        std::fs::read_dir(&out).unwrap().map(|it| it.unwrap().path()).filter(|it| it.is_dir()).collect();
    assert!(!splits.is_empty());
    for split in splits {
        let json = |name: &str| -> Value { serde_json::from_slice(&std::fs::read(split.join(name)).unwrap()).unwrap() };
        let (info, whole) = (json("meta/info.json"), json("meta/stats.json"));
        let path = split.join("meta/episodes/chunk-000/file-000.parquet");
        let names = cosfly_read::columns::column_names(&path).unwrap();
        let rows = cosfly_read::foreign_rows(&path, false).unwrap();
        for feature in info["features"].as_object().unwrap().keys() {
            for figure in ["min", "max", "mean", "std", "q01", "q10", "q50", "q90", "q99", "count"] {
                assert!(names.contains(&format!("stats/{feature}/{figure}")), "{feature} {figure}: {names:?}");
                assert_eq!(whole[feature].as_object().unwrap().len(), 10, "{feature}");
            }
            let counts = &rows.numbers[&format!("stats/{feature}/count")];
            let frames: f64 = counts.iter().map(|count| count[0]).sum();
            assert_eq!(whole[feature]["count"][0].as_f64(), Some(frames), "{feature}");
            // Pictures have nested lists, which this reader passes over.
            let Some(means) = rows.numbers.get(&format!("stats/{feature}/mean")) else { continue };
            for (at, mean) in whole[feature]["mean"].as_array().unwrap().iter().enumerate() {
                let sum: f64 = means.iter().zip(counts).map(|(mean, count)| mean[at] * count[0]).sum();
                assert!((sum / frames - mean.as_f64().unwrap()).abs() < 1e-9, "{feature} {at}");
            }
        }
    }
}

#[test]
fn the_list_is_sorted_and_an_option_of_several_formats_is_the_same_in_all() {
    assert!(FORMATS.is_sorted_by_key(|format| format.name));
    for (option, formats) in joined_options() {
        assert!(!option.doc.is_empty(), "`{}` has no doc", option.name);
        let has_default = option.kind == OptionKind::Texts || !option.default.is_null();
        assert!(has_default, "`{}` shows no default", option.name);
        for format in FORMATS {
            let own = format.options().into_iter().find(|own| own.name == option.name);
            assert_eq!(own.is_some(), formats.contains(&format.name));
            assert!(own.is_none_or(|own| own == option), "`{}` of `{}` differs", option.name, format.name);
        }
    }
}

#[test]
fn options_of_other_formats_and_values_out_of_range_are_refused() {
    let refused = |format: &str, options: Value| {
        let refusal = prepare(format, options.as_object().unwrap().clone()).err().unwrap();
        assert_eq!(refusal.code, "export-option");
        format!("{refusal}; {}", refusal.hints.join("; "))
    };
    let text = refused("v7", json!({"every": 2}));
    assert!(
        text.contains("`v7` has no option `--every`")
            && text.contains("an option of `coco`, `grounding`, `imagefolder`, `lasot`, `mot`"),
        "{text}"
    );
    let text = refused("v7", json!({"town": ["street"]}));
    assert!(text.contains("`street` is not a town of the dataset and a name for it"), "{text}");
    assert!(prepare("v7", json!({"town": ["street=Town01"]}).as_object().unwrap().clone()).is_ok());
    assert_eq!(prepare("v8", Map::new()).err().unwrap().code, "export-format");
}

#[test]
fn a_refused_export_leaves_nothing_behind() {
    let (home, dataset) = published();
    for flight in dataset.flights() {
        let log = dataset.folder().join(&flight.mcap_path);
        let bytes = std::fs::read(&log).unwrap();
        std::fs::write(&log, &bytes[..bytes.len() / 2]).unwrap();
    }
    for format in FORMATS {
        let refusal = export(&dataset, format.name, &home.path().join("out")).unwrap_err();
        assert!(refusal.code.starts_with("dataset-"), "`{}`: {refusal:?}", format.name);
        assert_eq!(std::fs::read_dir(home.path()).unwrap().count(), 1, "`{}` left something", format.name);
    }
}

/// The bytes of a log with one changed.
fn with_another_byte(bytes: &[u8], at: usize) -> Vec<u8> {
    let mut changed = bytes.to_vec();
    changed[at] ^= 0x10;
    changed
}

#[test]
fn an_export_of_a_log_with_a_changed_byte_is_refused_or_the_same() {
    let (home, dataset) = published();
    let log = dataset.folder().join(&dataset.flights()[0].mcap_path);
    let bytes = std::fs::read(&log).unwrap();
    let out = |name: &str| home.path().join(name);
    let mut refused = 0;
    for format in ["ros2", "webdataset"] {
        export(&dataset, format, &out(format)).unwrap();
        let whole = files(&out(format));
        for (number, at) in (0..bytes.len()).step_by(bytes.len() / 30).enumerate() {
            std::fs::write(&log, with_another_byte(&bytes, at)).unwrap();
            let name = format!("{format}-{number}");
            match export(&dataset, format, &out(&name)) {
                Ok(_) => assert!(files(&out(&name)) == whole, "`{format}`: byte {at} of the log changed the export"),
                Err(refusal) => {
                    assert!(refusal.code.starts_with("dataset-"), "`{format}`, byte {at}: {refusal:?}");
                    refused += 1;
                }
            }
        }
        std::fs::write(&log, &bytes).unwrap();
    }
    assert!(refused > 15, "{refused} of 60 changes were seen");
}

#[test]
fn channels_on_request_are_files_of_every_export_of_pictures() {
    let home = tempfile::tempdir().unwrap();
    let mut flights = sample::flights();
    flights.iter_mut().for_each(sample::SampleFlight::draw_on_request);
    let (config, encoding) = (DatasetConfig::default(), EncodingConfig::default());
    sample::write_flights(&home.path().join("given"), &config, encoding, flights).unwrap();
    let dataset = PublishedDataset::open(&home.path().join("given")).unwrap();
    let [shards, folder] = ["webdataset", "imagefolder"].map(|name| {
        let out = home.path().join(name);
        export(&dataset, name, &out).unwrap();
        files(&out)
    });
    let tar = shards.iter().find(|(path, _)| path.extension().is_some_and(|it| it == "tar")).unwrap().1;
    assert!(tar.windows(12).any(|name| name == b".normals.png"));
    assert!(tar.windows(9).any(|name| name == b".mask.png"));
    for kind in ["mask", "normals"] {
        assert!(folder.keys().any(|path| path.components().any(|part| part.as_os_str() == kind)), "{kind}");
    }
    for files in [shards, folder] {
        let card = String::from_utf8_lossy(&files[Path::new("README.md")]).into_owned();
        assert!(card.contains("unit normals"), "{card}");
    }
}

#[test]
fn an_export_that_would_hold_nothing_is_refused() {
    let (home, dataset) = published();
    let out = home.path().join("clouds");
    assert_eq!(export(&dataset, "clouds", &out).unwrap_err().code, "export-no-cloud");
    assert!(!out.exists());
}

#[test]
fn flights_are_chosen_by_split_and_name() {
    let (home, dataset) = published();
    let split = dataset.flights()[0].split.clone();
    let chosen = |splits: &[&str], trajectories: &[&str]| {
        let owned = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
        let choice = Choice { splits: owned(splits), trajectories: owned(trajectories) };
        let source = Source::new(&dataset, &choice, &|_, _| {})?;
        Ok::<_, Box<cosfly_diagnose::Diagnostic>>(source.flights().count())
    };
    assert_eq!(chosen(&[], &[]).unwrap(), 4);
    let of_split = dataset.flights().iter().filter(|flight| flight.split == split).count();
    assert_eq!(chosen(&[&split], &[]).unwrap(), of_split);
    assert_eq!(chosen(&[&split], &[&dataset.flights()[0].trajectory_id]).unwrap(), 1);
    assert_eq!(chosen(&[], &["expert-p00001"]).unwrap(), 1);
    assert_eq!(chosen(&[], &["expert-*"]).unwrap(), 2);
    assert_eq!(chosen(&[], &["*-p00001", "expert-p00001"]).unwrap(), 2);
    assert_eq!(chosen(&[], &["*-right"]).unwrap_err().code, "dataset-no-flight");
    assert_eq!(chosen(&["dev"], &[]).unwrap_err().code, "export-split");
    assert_eq!(chosen(&[], &["expert"]).unwrap_err().code, "dataset-no-flight");
    let alone = Choice { trajectories: vec!["expert-p00000".into()], ..Choice::default() };
    let refusal = export_with(&dataset, "v7", Map::new(), &alone, &home.path().join("x")).unwrap_err();
    assert_eq!(refusal.code, "export-pairs");
}

#[test]
fn a_v7_export_is_read_back_by_the_strict_reader() {
    let (home, dataset) = published();
    let out = home.path().join("v7");
    let remarks = export(&dataset, "v7", &out).unwrap();
    assert!(remarks.len() == 1 && remarks[0].contains("`plain` is called `Town01`"), "{remarks:?}");
    let root = out.join(crate::formats::v7::ROOT);
    let reading = crate::formats::v7::reader::read(&root).unwrap();
    assert_eq!((reading.pairs, reading.frames, reading.problems), (2, 4 * sample::FRAMES, vec![]));
    let picture = files(&root).into_keys().find(|path| path.ends_with("rgb.png")).unwrap();
    std::fs::write(root.join(picture), b"no picture").unwrap();
    assert_eq!(crate::formats::v7::reader::read(&root).unwrap().problems.len(), 1);
}

#[test]
fn no_folder_of_pictures_has_more_than_a_thousand_entries() {
    let paths: Vec<String> = (0..2500).map(|i| crate::media::picture_path(i, &format!("e{i}"), 0, "jpg")).collect();
    let frames: Vec<String> = (0..2500).map(|i| crate::media::picture_path(7, "e7", i, "jpg")).collect();
    let mut entries: BTreeMap<String, std::collections::BTreeSet<String>> = BTreeMap::new();
    for path in paths.iter().chain(&frames) {
        let parts: Vec<&str> = path.split('/').collect();
        for (depth, part) in parts.iter().enumerate() {
            entries.entry(parts[..depth].join("/")).or_default().insert((*part).to_owned());
        }
    }
    assert!(entries.values().all(|entries| entries.len() <= crate::media::FOLDER_LIMIT));
}

#[test]
fn what_a_vision_language_model_learns_to_say_leads_to_the_expert() {
    let (home, dataset) = published();
    let index = dataset.row_index("frames").unwrap();
    for (delta_frame, name) in [(DeltaFrame::World, "world"), (DeltaFrame::Body, "body")] {
        let out = home.path().join(name);
        let mut options = options("vlm");
        options.insert("frame".into(), name.into());
        export_with(&dataset, "vlm", options, &Choice::default(), &out).unwrap();
        let mut rows = 0;
        for (path, bytes) in
            files(&out).into_iter().filter(|(path, _)| path.extension().is_some_and(|it| it == "jsonl"))
        {
            let text = String::from_utf8(bytes).unwrap();
            for line in text.lines() {
                let row: serde_json::Value = serde_json::from_str(line).unwrap();
                let answer = row["messages"][2]["content"].as_str().unwrap();
                let answer: serde_json::Value = serde_json::from_str(answer).unwrap();
                let deltas: Vec<[f64; 6]> = serde_json::from_value(answer["waypoint_deltas"].clone()).unwrap();
                let id = row["trajectory_id"].as_str().unwrap();
                let current = row["frame"].as_u64().unwrap() as usize + 2;
                let own = dataset.frames(&index, dataset.flight(id).unwrap()).unwrap();
                let expert =
                    dataset.frames(&index, dataset.flight(&id.replace("perturbed", "expert")).unwrap()).unwrap();
                let mut reached = vec![];
                cosfly_metrics::waypoints(
                    &own[current].pose,
                    &deltas,
                    delta_frame,
                    DeltaOrigin::Previous,
                    &mut reached,
                );
                for (pose, truth) in reached.iter().zip(&expert[current + 1..]) {
                    let gap = (pose.position_in_world - truth.pose.position_in_world).length();
                    let turn = wrap_angle_rad(pose.yaw_rad - truth.pose.yaw_rad).to_degrees();
                    assert!(gap < 0.01 && turn.abs() < 0.02, "{}: {gap} m, {turn} degrees", path.display());
                }
                let images = row["images"].as_array().unwrap();
                let prompt = row["messages"][1]["content"].as_str().unwrap();
                assert_eq!((images.len(), prompt.matches("<image>").count()), (3, 3));
                assert!(images.iter().all(|image| out.join(image.as_str().unwrap()).is_file()));
                rows += 1;
            }
        }
        assert_eq!(rows, 2);
    }
}

#[test]
fn sets_for_students_are_registered_and_nested() {
    let (home, dataset) = published();
    let out = home.path().join("students");
    let mut options = options("vlm");
    options.insert("sets".into(), "students".into());
    options.insert("input".into(), "mixed".into());
    export_with(&dataset, "vlm", options, &Choice::default(), &out).unwrap();
    let registered: Map<String, Value> =
        serde_json::from_slice(&std::fs::read(out.join("dataset_info.json")).unwrap()).unwrap();
    let ids = |name: &str| -> std::collections::BTreeSet<String> {
        let text = std::fs::read_to_string(out.join(format!("{name}.jsonl"))).unwrap_or_default();
        let row = |line: &str| serde_json::from_str::<Value>(line).unwrap();
        text.lines().map(|line| row(line)["id"].as_str().unwrap().to_owned()).collect()
    };
    let splits: Vec<&str> = registered.keys().filter_map(|name| name.strip_prefix("cosfly_")).collect();
    for name in &splits {
        assert!(!ids(name).is_empty(), "{name}");
    }
    for split in splits.iter().filter(|name| !name.contains('_')) {
        let whole = ids(split);
        assert!(ids(&format!("{split}_25")).is_subset(&ids(&format!("{split}_50"))));
        assert!(ids(&format!("{split}_50")).is_subset(&whole));
        for name in ["no_pictures", "no_boxes", "no_poses", "pictures_only"] {
            assert_eq!(ids(&format!("{split}_{name}")), whole, "{split}_{name}");
        }
        assert!(!ids(&format!("{split}_texts")).is_empty());
    }
}
