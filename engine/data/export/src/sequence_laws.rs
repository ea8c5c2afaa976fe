//! Sequences for trackers say what the tables say, in the words of each benchmark.

use crate::Choice;
use crate::laws::{export_with, files, published};
use cosfly_domain::TargetView;
use cosfly_read::{PublishedDataset, SightingReader};
use cosfly_sample as sample;
use cosfly_schema::{DatasetConfig, EncodingConfig, RgbEncoding};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

type Files = BTreeMap<PathBuf, Vec<u8>>;

fn export(dataset: &PublishedDataset, format: &str, options: Value, out: &Path) -> (Files, Vec<String>) {
    let options = options.as_object().unwrap().clone();
    let remarks = export_with(dataset, format, options, &Choice::default(), out).unwrap();
    (files(out), remarks)
}

fn text(files: &Files, path: &str) -> String {
    String::from_utf8(files.get(Path::new(path)).unwrap_or_else(|| panic!("no `{path}`")).clone()).unwrap()
}

fn list(files: &Files) -> Vec<Value> {
    text(files, "sequences.jsonl").lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// Flights whose target is out of view in frames 0 and 3 and hidden in frame 2, but the second, which never shows it.
fn absent(home: &Path, encoding: EncodingConfig) -> PublishedDataset {
    let mut flights = sample::flights();
    let unseen = |view: &mut TargetView, in_view: bool| {
        (view.in_view, view.visible_box, view.pixels, view.visible_by_pixels) = (in_view, None, 0, 0.0);
        view.full_box = view.full_box.filter(|_| in_view);
    };
    for (number, flight) in flights.iter_mut().enumerate() {
        for (frame, view) in flight.record.views.iter_mut().enumerate() {
            match (number, frame) {
                (1, _) | (_, 0 | 3) => unseen(view, false),
                (_, 2) => unseen(view, true),
                _ => {}
            }
        }
        let dense = flight.record.visible_by_dense_rays.iter_mut().zip(&flight.record.views);
        dense.for_each(|(share, view)| *share = share.filter(|_| view.in_view));
    }
    sample::write_flights(&home.join("absent"), &DatasetConfig::default(), encoding, flights).unwrap();
    PublishedDataset::open(&home.join("absent")).unwrap()
}

#[test]
fn every_body_of_the_tables_has_its_line_in_a_sequence_of_many_bodies() {
    let (home, dataset) = published();
    let (files, _) = export(&dataset, "mot", json!({}), &home.path().join("mot"));
    let (with_classes, _) = export(&dataset, "mot", json!({"detections": "all"}), &home.path().join("all"));
    let (index, mut bodies) = (dataset.row_index("frames").unwrap(), SightingReader::of(&dataset).unwrap());
    for (place, flight) in dataset.flights().iter().enumerate() {
        let folder = format!("{}/{}", flight.split, flight.trajectory_id);
        let info = text(&files, &format!("{folder}/seqinfo.ini"));
        assert!(info.contains("frameRate=2\nseqLength=5\nimWidth=64\nimHeight=48\nimExt=.jpg\n"), "{info}");
        let mut expected: Vec<[f64; 9]> = vec![];
        for (row, number) in dataset.frames(&index, flight).unwrap().iter().zip(1..) {
            let [left, top, right, bottom] = row.visible_box_px.unwrap().map(f64::from);
            let share = (1e4 * row.visible_by_pixels).round() / 1e4;
            expected.push([f64::from(number), 1.0, left + 1.0, top + 1.0, right - left, bottom - top, 1.0, 1.0, share]);
        }
        for body in bodies.at(&dataset, place).unwrap() {
            let [left, top, right, bottom] = body.visible_box_px.map(f64::from);
            let (number, id) = (f64::from(body.frame) + 1.0, f64::from(body.instance));
            expected.push([number, id, left + 1.0, top + 1.0, right - left, bottom - top, 1.0, 1.0, -1.0]);
        }
        assert!(expected.len() > 5, "the companion is seen");
        let lines = text(&files, &format!("{folder}/gt/gt.txt"));
        let rows = lines.lines().map(|line| line.split(',').map(|it| it.parse().unwrap()).collect::<Vec<f64>>());
        assert_eq!(rows.collect::<Vec<_>>(), expected.iter().map(|row| row.to_vec()).collect::<Vec<_>>());
        assert!(files.contains_key(Path::new(&format!("{folder}/img1/000005.jpg"))));
        // Detections are the same boxes of whom nobody knows.
        expected.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let told = |class: &str| {
            let line =
                |row: &[f64; 9]| format!("{},-1,{},{},{},{},1,{class},-1,-1\n", row[0], row[2], row[3], row[4], row[5]);
            expected.iter().map(line).collect::<String>()
        };
        assert_eq!(text(&files, &format!("{folder}/det/det.txt")), told("-1"));
        assert_eq!(text(&with_classes, &format!("{folder}/det/det.txt")), told("1"));
    }
    let maps = dataset.flights().iter().filter(|flight| flight.split == "train").map(|it| &*it.trajectory_id);
    assert_eq!(
        text(&files, "seqmaps/train.txt"),
        ["name"].into_iter().chain(maps).collect::<Vec<_>>().join("\n") + "\n"
    );
}

#[test]
fn every_nth_frame_is_numbered_without_gaps_at_a_lower_rate() {
    let (home, dataset) = published();
    let (files, _) = export(&dataset, "mot", json!({"every": 3}), &home.path().join("mot"));
    let flight = &dataset.flights()[0];
    let folder = format!("{}/{}", flight.split, flight.trajectory_id);
    assert!(text(&files, &format!("{folder}/seqinfo.ini")).contains("frameRate=0.666667\nseqLength=2\n"));
    let numbers = files.keys().filter(|path| path.starts_with(format!("{folder}/img1")));
    assert_eq!(numbers.map(|path| path.file_name().unwrap()).collect::<Vec<_>>(), ["000001.jpg", "000002.jpg"]);
    assert_eq!(list(&files)[0]["every"], 3);
}

#[test]
fn a_sequence_of_one_target_begins_when_it_is_seen_and_says_when_it_is_not() {
    let home = tempfile::tempdir().unwrap();
    let dataset = absent(home.path(), EncodingConfig::default());
    let index = dataset.row_index("frames").unwrap();
    let exports = [("otb", json!({}), "a"), ("otb", json!({"layout": "uav123"}), "b"), ("lasot", json!({}), "c")];
    let [otb, uav, lasot] = exports.map(|(format, options, name)| {
        let (files, remarks) = export(&dataset, format, options, &home.path().join(name));
        assert_eq!(remarks, ["1 flight without a picture of the target: left out"]);
        files
    });
    assert_eq!(list(&lasot).len(), 3);
    for (row, of_lasot) in list(&otb).iter().zip(list(&lasot)) {
        let flight = dataset.flight(row["trajectory_id"].as_str().unwrap()).unwrap();
        let (split, id) = (&flight.split, &flight.trajectory_id);
        assert_eq!((&row["first_frame"], &row["pictures"]), (&json!(1), &json!(4)));
        let rows = dataset.frames(&index, flight).unwrap();
        let shown = |place: usize| crate::sequence::box_text(rows[place].visible_box_px.unwrap());
        let expected = |absent: &str| [&shown(1), absent, absent, &shown(4), ""].join("\n");
        assert_eq!(text(&otb, &format!("{split}/{id}/groundtruth_rect.txt")), expected("NaN,NaN,NaN,NaN"));
        assert_eq!(text(&uav, &format!("{split}/anno/UAV123/{id}.txt")), expected("NaN,NaN,NaN,NaN"));
        let name = of_lasot["sequence"].as_str().unwrap();
        let folder = format!("{split}/pedestrian/{name}");
        assert_eq!(text(&lasot, &format!("{folder}/groundtruth.txt")), expected("0,0,0,0"));
        assert_eq!(text(&lasot, &format!("{folder}/full_occlusion.txt")), "0,1,0,0\n");
        assert_eq!(text(&lasot, &format!("{folder}/out_of_view.txt")), "0,0,1,0\n");
        assert_eq!(text(&lasot, &format!("{folder}/nlp.txt")), "Follow the pedestrian for 2 metres.\n");
        for (files, first, last) in [
            (&otb, format!("{split}/{id}/img/0001.jpg"), format!("{split}/{id}/img/0004.jpg")),
            (
                &uav,
                format!("{split}/data_seq/UAV123/{id}/000001.jpg"),
                format!("{split}/data_seq/UAV123/{id}/000004.jpg"),
            ),
            (&lasot, format!("{folder}/img/00000001.jpg"), format!("{folder}/img/00000004.jpg")),
        ] {
            let mut log = dataset.log(flight).unwrap();
            assert!(files[Path::new(&first)] == log.frame(1).unwrap().rgb_file, "picture 1 is frame 1");
            assert!(files[Path::new(&last)] == log.frame(4).unwrap().rgb_file, "picture 4 is frame 4");
        }
    }
}

#[test]
fn flights_without_a_caption_have_a_sentence_that_fits_vehicles_in_the_language_asked_for() {
    let home = tempfile::tempdir().unwrap();
    let mut flights = sample::flights();
    flights.iter_mut().for_each(|flight| flight.captions.clear());
    let encoding = EncodingConfig::default();
    sample::write_flights(&home.path().join("wordless"), &DatasetConfig::default(), encoding, flights).unwrap();
    let dataset = PublishedDataset::open(&home.path().join("wordless")).unwrap();
    for (language, said) in [("en", "Follow the target and keep it in view."), ("zh", "跟随目标，让它一直在画面里。")]
    {
        let (files, _) = export(&dataset, "lasot", json!({"language": language}), &home.path().join(language));
        assert!(list(&files).iter().all(|row| {
            let (split, name) = (row["split"].as_str().unwrap(), row["sequence"].as_str().unwrap());
            text(&files, &format!("{split}/pedestrian/{name}/nlp.txt")).trim_end() == said
        }));
    }
}

#[test]
fn flights_that_follow_nobody_are_not_told_to_follow() {
    let home = tempfile::tempdir().unwrap();
    let mut flights = sample::flights();
    for flight in &mut flights {
        flight.captions.clear();
        flight.record.trajectory.track.radius_m = 0.0;
    }
    let encoding = EncodingConfig::default();
    sample::write_flights(&home.path().join("rounds"), &DatasetConfig::default(), encoding, flights).unwrap();
    let dataset = PublishedDataset::open(&home.path().join("rounds")).unwrap();
    for (language, said) in [("en", "Fly the planned way."), ("zh", "按计划的路线飞行。")] {
        let (files, _) = export(&dataset, "imagefolder", json!({"language": language}), &home.path().join(language));
        let lines = files.iter().filter(|(path, _)| path.ends_with("metadata.jsonl"));
        let lines: Vec<&str> = lines.flat_map(|(_, bytes)| std::str::from_utf8(bytes).unwrap().lines()).collect();
        assert!(!lines.is_empty() && lines.iter().all(|it| it.contains(&format!("\"instruction\":\"{said}\""))));
    }
    let options = json!({"history": 3, "horizon": 2, "stride": 1, "input": "expert"});
    let (files, _) = export(&dataset, "vlm", options, &home.path().join("asked"));
    let lines = files.iter().filter(|(path, _)| path.extension().is_some_and(|it| it == "jsonl"));
    let words: String = lines.map(|(_, bytes)| std::str::from_utf8(bytes).unwrap()).collect();
    assert!(words.contains("a drone that flies a planned way. Answer") && !words.contains("follows"), "{words}");
    assert!(!words.contains("Boxes of the target"), "{words}");
}

#[test]
fn a_choice_without_a_target_is_refused_and_pictures_are_jpeg_whatever_the_dataset_has() {
    let home = tempfile::tempdir().unwrap();
    let encoding = EncodingConfig { rgb: RgbEncoding::Png, ..EncodingConfig::default() };
    let dataset = absent(home.path(), encoding);
    let (files, _) = export(&dataset, "otb", json!({}), &home.path().join("otb"));
    let mut pictures = files.iter().filter(|(path, _)| path.extension().is_some_and(|it| it == "jpg"));
    assert!(pictures.all(|(_, bytes)| bytes.starts_with(&[0xff, 0xd8])));
    let is_left_out = |id: &str| list(&files).iter().all(|row| row["trajectory_id"] != *id);
    let hidden = dataset.flights().iter().map(|flight| flight.trajectory_id.clone()).filter(|id| is_left_out(id));
    let never = Choice { trajectories: hidden.collect(), ..Choice::default() };
    for format in ["otb", "lasot"] {
        let out = home.path().join("never");
        let refusal = export_with(&dataset, format, serde_json::Map::new(), &never, &out).unwrap_err();
        assert_eq!(refusal.code, "export-no-target");
        assert!(!out.exists());
    }
}
