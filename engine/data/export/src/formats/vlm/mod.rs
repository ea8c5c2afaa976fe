//! Fine-tuning of vision-language models: a line of JSON per window, as LLaMA-Factory and ms-swift both read it.

mod conversation;
mod options;

use crate::card::Card;
use crate::folder::OutFolder;
use crate::format::Format;
use crate::media::{ending, picture_path};
use crate::pixels::{rgb_jpeg, rgb_of, smaller_size};
use crate::shared_options::Axes;
use crate::source::{Episode, Source};
use conversation::conversation;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_images::read::averaged;
use options::{Input, Options};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Write as _};

/// Conversations about windows.
pub struct Vlm;

/// JPEG quality of pictures that are made smaller.
const QUALITY: u8 = 90;

impl Format for Vlm {
    const NAME: &'static str = "vlm";
    const DOC: &'static str =
        "JSON lines for LLaMA-Factory and ms-swift: pictures, poses, boxes, instruction -> waypoint_deltas";
    type Options = Options;

    fn write(options: &Options, source: &Source<'_>, out: &OutFolder) -> Result<Vec<String>> {
        let window = options.window();
        let is_seen = |flight: &cosfly_read::PublishedFlight| {
            flight.expert_id.is_some() == (options.input == Input::Perturbed) && window.count(flight.frames) > 0
        };
        if !source.flights().any(is_seen) {
            let (size, input) = (window.size(), options.input.word());
            let message = format!("no chosen flight is {input} and has the {size} frames of a window");
            return Err(Diagnostic::new("export-windows", Fault::Recipe, message)
                .hint("choose with `--input`, `--history` and `--horizon`"));
        }
        let language = options.instructions.language;
        let instructions = source.dataset.window_instructions(language.of_windows(), window.history)?;
        let mut files: BTreeMap<String, BufWriter<File>> = BTreeMap::new();
        let (mut flight, mut windows) = (0, 0);
        source.each_flight_of(&is_seen, &mut |episode| {
            let split = &episode.flight.split;
            let name = format!("{split}.jsonl");
            if !files.contains_key(split) {
                files.insert(split.clone(), out.create(&name)?);
            }
            let pictures = write_pictures(episode, options, out, flight)?;
            let expert = episode.expert_poses()?;
            let Some(file) = files.get_mut(split) else { return Ok(()) };
            let own = instructions.get(&episode.flight.trajectory_id);
            for start in window.starts(episode.frames.len()) {
                let instruction = own.and_then(|own| own.get(&start)).map(String::as_str);
                let instruction = instruction.unwrap_or_else(|| episode.instruction(language));
                let line = conversation(episode, options, &expert, &pictures, start, instruction);
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

/// Entry of a file in LLaMA-Factory's `dataset_info.json`.
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
    let (frames, window) = (episode.frames.len(), options.window());
    let mut shown: Vec<usize> = window.starts(frames).flat_map(|start| start..start + window.history).collect();
    shown.sort_unstable();
    shown.dedup();
    let id = &episode.flight.trajectory_id;
    let mut paths = BTreeMap::new();
    episode.each_picture(
        &shown,
        |frame, logged| {
            let full = [logged.width, logged.height];
            let size = smaller_size(full, options.width);
            let in_usize = |size: [u32; 2]| size.map(|side| side as usize);
            let (ending, file) = match size == full {
                true => (ending(&logged.rgb_format), logged.rgb_file),
                false => {
                    ("jpg", rgb_jpeg(&averaged(&rgb_of(&logged)?, in_usize(full), in_usize(size)), size, QUALITY)?)
                }
            };
            let path = format!("images/{}", picture_path(flight, id, frame, ending));
            out.put(&path, &file)?;
            Ok(path)
        },
        |frame, path| {
            paths.insert(frame, path);
            Ok(())
        },
    )?;
    Ok(paths)
}

fn card<'a>(options: &Options, splits: impl Iterator<Item = &'a str>) -> Card {
    let mut front_matter =
        String::from("task_categories:\n- image-text-to-text\nconfigs:\n- config_name: default\n  data_files:\n");
    for split in splits {
        let _ = write!(front_matter, "  - split: {split}\n    path: {split}.jsonl\n");
    }
    let (shape, input) = (options.window(), options.input.word());
    let frame = match options.increments.frame {
        Axes::World => "world",
        Axes::Body => "body",
    };
    let settings = format!(
        "Windows: {} frames of {input} flights, then {} waypoints of the expert, one window every {} frames; increments in the \
         {frame} frame. A model's answers are scored with\n\n```sh\ncosfly eval answers.jsonl --dataset DATASET --frame {frame} \
         --input {input} --history {} --horizon {} --stride {}\n```\n\nwhere a line of answers has `trajectory_id` and `frame` of \
         the line here, and `text`, what the model wrote. The first increment starts at the drone's own pose, from which a drone \
         flies on (`--anchor input`). The paper's untrained models have the scores of `--anchor expert`, where it starts at the \
         expert's pose: the report has both.\n\n",
        shape.history, shape.horizon, shape.stride, shape.history, shape.horizon, shape.stride
    );
    let pictures = format!(
        "\nPictures are at most {} pixels wide (`--width` of `cosfly export`), and boxes are in pixels of these pictures or in \
         thousandths. With patches of 28 x 28 pixels, as Qwen2-VL has them, a picture of 448 x 252 takes 144 tokens, and one of \
         1280 x 720 takes 777 after LLaMA-Factory's own limit. Five small ones with their texts fit into 2,048 tokens, LLaMA-Factory's default `cutoff_len`, \
         beyond which it drops the end of the question without a word: set `cutoff_len` for larger ones.\n",
        options.width
    );
    Card { format: "VLM fine-tuning", front_matter, body: settings + BODY + &pictures }
}

const BODY: &str = "\
```sh
llamafactory-cli train --dataset_dir . --dataset cosfly_train --media_dir . ...   # in this folder
swift sft --dataset train.jsonl ...                                              # in this folder, too
```

A line has `messages` (system, user, assistant), `images` (one path for each `<image>`, from this folder), and `id`,
`trajectory_id` and `frame` (the window's first) to find it again. Metres have three decimals, degrees two; every increment is
counted from where the rounded ones before lead, so that rounding does not add up. The instruction holds in the current picture: it
singles the person out by clothes, by the people around, by the way across the picture. Windows that table `windows` of the
dataset does not have (`--history`, `--stride`) have the instruction of the whole flight.
";
