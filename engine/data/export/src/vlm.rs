//! Fine-tuning of vision-language models: a line of JSON per window, as LLaMA-Factory and ms-swift both read it.

use crate::card::Card;
use crate::exporter::{BoxScale, Exporter, Input, Options};
use crate::folder::OutFolder;
use crate::media::{ending, picture_path};
use crate::sample_text::pose_numbers;
use crate::source::{Episode, Source};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_frames::{Pose, action};
use cosfly_metrics::DeltaFrame;
use cosfly_read::FrameRow;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Write as _};

/// Conversations about windows.
pub struct Vlm;

impl Exporter for Vlm {
    fn name(&self) -> &'static str {
        "vlm"
    }

    fn about(&self) -> &'static str {
        "JSON lines for LLaMA-Factory and ms-swift: pictures, poses, boxes, instruction -> waypoint_deltas"
    }

    fn export(&self, source: &Source<'_>, out: &OutFolder) -> Result<Vec<String>> {
        let options = source.options;
        let is_seen = |flight: &cosfly_read::PublishedFlight| {
            flight.expert_id.is_some() == (options.input == Input::Perturbed) && options.window.count(flight.frames) > 0
        };
        if !source.flights().any(is_seen) {
            let (size, kind) =
                (options.window.size(), if options.input == Input::Expert { "expert" } else { "perturbed" });
            let message = format!("no chosen flight is {kind} and has the {size} frames of a window");
            return Err(Diagnostic::new("export-windows", Fault::Recipe, message)
                .hint("choose with `--input`, `--history` and `--horizon`"));
        }
        let experts = source.expert_poses()?;
        let mut files: BTreeMap<String, BufWriter<File>> = BTreeMap::new();
        let (mut flight, mut windows) = (0, 0);
        source.each_flight_of(&is_seen, &mut |episode| {
            let split = &episode.flight.split;
            let name = format!("{split}.jsonl");
            if !files.contains_key(split) {
                files.insert(split.clone(), out.create(&name)?);
            }
            let pictures = write_pictures(episode, options, out, flight)?;
            let expert = episode.expert_poses(&experts)?;
            let Some(file) = files.get_mut(split) else { return Ok(()) };
            for start in options.window.starts(episode.frames.len()) {
                let line = conversation(episode, options, &expert, &pictures, start);
                writeln!(file, "{line}").map_err(|error| out.refusal(&name, &error))?;
                windows += 1;
            }
            flight += 1;
            Ok(())
        })?;
        let mut entries = BTreeMap::new();
        for (split, mut file) in files {
            file.flush().map_err(|error| out.refusal(&format!("{split}.jsonl"), &error))?;
            entries.insert(format!("cosfly_{split}"), registration(&split));
        }
        out.put("dataset_info.json", format!("{:#}\n", json!(entries)).as_bytes())?;
        card(options, entries.keys().filter_map(|name| name.strip_prefix("cosfly_"))).write(source, out)?;
        Ok(vec![format!("{windows} window{}", if windows == 1 { "" } else { "s" })])
    }
}

/// How LLaMA-Factory is told of a file.
fn registration(split: &str) -> Value {
    json!({
        "file_name": format!("{split}.jsonl"),
        "formatting": "sharegpt",
        "columns": {"messages": "messages", "images": "images"},
        "tags": {
            "role_tag": "role", "content_tag": "content",
            "user_tag": "user", "assistant_tag": "assistant", "system_tag": "system",
        },
    })
}

/// Writes the pictures that windows show; their paths by frame.
fn write_pictures(
    episode: &Episode<'_>,
    options: &Options,
    out: &OutFolder,
    flight: usize,
) -> Result<BTreeMap<usize, String>> {
    let frames = episode.frames.len();
    let mut shown: Vec<usize> =
        options.window.starts(frames).flat_map(|start| start..start + options.window.history).collect();
    shown.sort_unstable();
    shown.dedup();
    let id = &episode.flight.trajectory_id;
    let mut paths = BTreeMap::new();
    episode.each_picture(
        &shown,
        |frame, logged| {
            let path = format!("images/{}", picture_path(flight, id, frame, ending(&logged.rgb_format)));
            out.put(&path, &logged.rgb_file)?;
            Ok(path)
        },
        |frame, path| {
            paths.insert(frame, path);
            Ok(())
        },
    )?;
    Ok(paths)
}

fn conversation(
    episode: &Episode<'_>,
    options: &Options,
    expert: &[Pose],
    pictures: &BTreeMap<usize, String>,
    start: usize,
) -> Value {
    let first_unseen = start + options.window.history;
    let seen = &episode.frames[start..first_unseen];
    let current = seen[seen.len() - 1].pose;
    let deltas = increments(current, &expert[first_unseen..first_unseen + options.window.horizon], options.delta_frame);
    let images: Vec<&String> = (start..first_unseen).filter_map(|frame| pictures.get(&frame)).collect();
    json!({
        "id": format!("{}_{start:06}", episode.flight.trajectory_id),
        "trajectory_id": episode.flight.trajectory_id,
        "frame": start,
        "messages": [
            {"role": "system", "content": system(options)},
            {"role": "user", "content": question(episode, options, seen)},
            {"role": "assistant", "content": json!({"waypoint_deltas": deltas}).to_string()},
        ],
        "images": images,
    })
}

/// Increments to the expert's poses, each rounded and counted from where the rounded ones before lead.
fn increments(current: Pose, expert: &[Pose], delta_frame: DeltaFrame) -> Vec<[f64; 6]> {
    let mut from = current;
    let increment = |to: &Pose| {
        let exact = match delta_frame {
            DeltaFrame::World => action::in_world(&from, to),
            DeltaFrame::Body => action::in_body(&from, to),
        };
        let [dx, dy, dz, pitch, yaw, roll] = exact;
        let rounded =
            [thousandths(dx), thousandths(dy), thousandths(dz), hundredths(pitch), hundredths(yaw), hundredths(roll)];
        from = match delta_frame {
            DeltaFrame::World => action::moved_in_world(&from, &rounded),
            DeltaFrame::Body => action::moved_in_body(&from, &rounded),
        };
        rounded
    };
    expert.iter().map(increment).collect()
}

/// To millimetres; never minus zero.
fn thousandths(value: f64) -> f64 {
    (1000.0 * value).round_ties_even() / 1000.0 + 0.0
}

/// To hundredths of degrees; never minus zero.
fn hundredths(value: f64) -> f64 {
    (100.0 * value).round_ties_even() / 100.0 + 0.0
}

fn system(options: &Options) -> String {
    let axes = match options.delta_frame {
        DeltaFrame::World => "the world's axes (x east, y south, z up)",
        DeltaFrame::Body => "the body's axes at the waypoint before (x ahead, y right, z up)",
    };
    format!(
        "You steer a drone that follows a person without losing sight of them. Answer with one JSON object: \
         {{\"waypoint_deltas\": [[dx, dy, dz, dpitch, dyaw, droll], ...]}} with {} increments, each from the waypoint \
         before, the first from the current pose. dx, dy, dz are metres along {axes}; angles are degrees, positive: \
         nose up, to the right, right side down.",
        options.window.horizon
    )
}

fn question(episode: &Episode<'_>, options: &Options, seen: &[FrameRow]) -> String {
    let flight = episode.flight;
    let dt_s = flight.dt_s;
    let history = "<image>".repeat(seen.len() - 1);
    let unit = match options.box_scale {
        BoxScale::Pixels => format!("pixels of {} x {}", flight.camera.width, flight.camera.height),
        BoxScale::Thousandths => "thousandths of width and height".into(),
    };
    let mut text = if seen.len() > 1 { format!("History, every {dt_s} s: {history}\n") } else { String::new() };
    let _ = writeln!(text, "Current: <image>\nInstruction: {}", episode.instruction());
    let _ = writeln!(
        text,
        "Poses, oldest first, [x, y, z, pitch, yaw, roll], metres along the world's axes from the current place, degrees:"
    );
    let current = seen[seen.len() - 1].pose.position_in_world;
    for row in seen {
        let pose = &row.pose;
        let [x, y, z, pitch, yaw, roll] =
            pose_numbers(&Pose { position_in_world: pose.position_in_world - current, ..*pose });
        let numbers = [x, y, z, pitch, yaw, roll].map(hundredths);
        let _ = writeln!(text, "{}", json!(numbers));
    }
    let _ =
        writeln!(text, "Boxes of the person, [left, top, right, bottom] in {unit}, null where they cannot be seen:");
    for row in seen {
        let _ = writeln!(text, "{}", box_text(row, options.box_scale, flight.camera.width, flight.camera.height));
    }
    let _ = write!(text, "Where are the next {} waypoints, {dt_s} s apart?", options.window.horizon);
    text
}

fn box_text(row: &FrameRow, scale: BoxScale, width: u32, height: u32) -> Value {
    let Some(edges) = row.visible_box_px else { return Value::Null };
    let size = [width, height, width, height];
    let numbers: Vec<i64> = edges
        .iter()
        .zip(size)
        .map(|(edge, size)| match scale {
            BoxScale::Pixels => f64::from(*edge).round_ties_even() as i64,
            BoxScale::Thousandths => (1000.0 * f64::from(*edge) / f64::from(size)).round_ties_even() as i64,
        })
        .collect();
    json!(numbers)
}

fn card<'a>(options: &Options, splits: impl Iterator<Item = &'a str>) -> Card {
    let mut front_matter =
        String::from("task_categories:\n- image-text-to-text\nconfigs:\n- config_name: default\n  data_files:\n");
    for split in splits {
        let _ = write!(front_matter, "  - split: {split}\n    path: {split}.jsonl\n");
    }
    let shape = options.window;
    let (frame, input) = match (options.delta_frame, options.input) {
        (DeltaFrame::World, Input::Perturbed) => ("world", "perturbed"),
        (DeltaFrame::World, Input::Expert) => ("world", "expert"),
        (DeltaFrame::Body, Input::Perturbed) => ("body", "perturbed"),
        (DeltaFrame::Body, Input::Expert) => ("body", "expert"),
    };
    let settings = format!(
        "Windows: {} frames of {input} flights, then {} waypoints of the expert, one window every {} frames; increments in the \
         {frame} frame. A model's answers are scored with\n\n```sh\ncosfly eval answers.jsonl --dataset DATASET --frame {frame} \
         --input {input} --history {} --horizon {} --stride {}\n```\n\nwhere a line of answers has `trajectory_id` and `frame` of \
         the line here, and `text`, what the model wrote.\n\n",
        shape.history, shape.horizon, shape.stride, shape.history, shape.horizon, shape.stride
    );
    Card { format: "VLM fine-tuning", front_matter, body: settings + BODY }
}

const BODY: &str = "\
```sh
llamafactory-cli train --dataset_dir . --dataset cosfly_train --media_dir . ...   # in this folder
swift sft --dataset train.jsonl ...                                              # in this folder, too
```

A line has `messages` (system, user, assistant), `images` (one path for each `<image>`, from this folder), and `id`,
`trajectory_id` and `frame` (the window's first) to find it again. Metres have three decimals, degrees two; every increment is
counted from where the rounded ones before lead, so that rounding does not add up.
";
