//! Fine-tuning of vision-language models: a line of JSON per window, as LLaMA-Factory and ms-swift both read it.

mod conversation;
mod goals;
mod options;
mod students;

use crate::card::ExportCard;
use crate::folder::OutFolder;
use crate::format::Format;
use crate::media::{ending, picture_path};
use crate::pixels::{rgb_jpeg, rgb_of, smaller_size};
use crate::shared_options::IncrementAxes;
use crate::source::{ExportedFlight, Source};
use conversation::{Shown, as_words, conversation};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_images::read::averaged;
use cosfly_read::InstructionReader;
use options::{Options, Sets};
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
            options.input.shows(flight.expert_id.is_some()) && window.count(flight.frames) > 0
        };
        if !source.flights().any(is_seen) {
            let (size, input) = (window.size(), options.input.word());
            let message = format!("no chosen flight is {input} and has the {size} frames of a window");
            return Err(Diagnostic::new("export-windows", Fault::Recipe, message).hint(
                "choose with `--input`, `--history` and `--horizon`; a stage `perturb` makes perturbed flights",
            ));
        }
        let language = options.instructions.language;
        let mut instructions = InstructionReader::of(source.dataset, language.of_windows(), window.history)?;
        let is_for_students = options.sets == Sets::Students;
        let goals = if is_for_students { source.dataset.goals(language.code())? } else { BTreeMap::new() };
        let mut lines = Lines { out, files: BTreeMap::new() };
        let (mut flight, mut windows) = (0, 0);
        source.each_flight_of(&is_seen, &mut |episode| {
            let split = &episode.flight.split;
            let pictures = write_pictures(episode, options, out, flight)?;
            let expert = episode.expert_poses()?;
            let place = source.dataset.place(&episode.flight.trajectory_id).unwrap_or_default();
            let own = instructions.at(source.dataset, place)?;
            for start in window.starts(episode.frames.len()) {
                let instruction = own.get(&start).map(String::as_str);
                let instruction = &as_words(instruction.unwrap_or_else(|| episode.instruction(language)));
                let line = |shown| conversation(episode, options, &expert, &pictures, start, instruction, shown);
                let whole = line(Shown::ALL);
                lines.put(split, &whole)?;
                windows += 1;
                if is_for_students {
                    for percent in students::SHARES.into_iter().filter(|it| students::is_in_share(episode, *it)) {
                        lines.put(&format!("{split}_{percent}"), &whole)?;
                    }
                    for (name, shown) in students::ABLATIONS {
                        lines.put(&format!("{split}_{name}"), &line(shown))?;
                    }
                }
            }
            if is_for_students {
                let own = goals.get(&episode.flight.trajectory_id).map_or(&[][..], Vec::as_slice);
                for (name, line) in goals::lines(episode, own, language.code(), &pictures) {
                    lines.put(&format!("{split}_{name}"), &line)?;
                }
                for (name, line) in students::texts(episode, options, &pictures) {
                    lines.put(&format!("{split}_{name}"), &line)?;
                }
            }
            flight += 1;
            Ok(())
        })?;
        let names = lines.finish()?;
        // ms-swift takes its file by its path.
        let registered = names.iter().filter(|name| !name.ends_with("_swift"));
        let entries: BTreeMap<String, Value> =
            registered.map(|name| (format!("cosfly_{name}"), registration(name))).collect();
        out.put("dataset_info.json", format!("{:#}\n", json!(entries)).as_bytes())?;
        if is_for_students {
            out.put("README_students.md", students::GUIDE.as_bytes())?;
        }
        let splits: std::collections::BTreeSet<&str> = source.splits().into_iter().collect();
        card(options, names.iter().map(String::as_str).filter(|name| splits.contains(name))).write(source, out)?;
        Ok(vec![format!("{windows} window{}", if windows == 1 { "" } else { "s" })])
    }
}

/// Files of lines, created with their first line.
struct Lines<'a> {
    out: &'a OutFolder,
    files: BTreeMap<String, BufWriter<File>>,
}

impl Lines<'_> {
    fn put(&mut self, name: &str, line: &Value) -> Result<()> {
        let file = format!("{name}.jsonl");
        if !self.files.contains_key(name) {
            self.files.insert(name.to_owned(), self.out.create(&file)?);
        }
        let Some(writer) = self.files.get_mut(name) else { return Ok(()) };
        writeln!(writer, "{line}").map_err(|error| self.out.refusal(&file, &error))
    }

    /// Names of the complete files.
    fn finish(self) -> Result<Vec<String>> {
        let out = self.out;
        let finish = |(name, mut file): (String, BufWriter<File>)| {
            file.flush().map_err(|error| out.refusal(&format!("{name}.jsonl"), &error))?;
            Ok(name)
        };
        self.files.into_iter().map(finish).collect()
    }
}

/// Entry of a file in LLaMA-Factory's `dataset_info.json`.
fn registration(name: &str) -> Value {
    let is_ranking = name.ends_with("_preferences");
    let mut entry = json!({
        "file_name": format!("{name}.jsonl"),
        "formatting": "sharegpt",
        "columns": {"messages": "messages", "images": "images"},
        "tags": {
            "role_tag": "role", "content_tag": "content",
            "user_tag": "user", "assistant_tag": "assistant", "system_tag": "system",
        },
    });
    if is_ranking {
        entry["ranking"] = json!(true);
        entry["columns"] =
            json!({"messages": "messages", "chosen": "chosen", "rejected": "rejected", "images": "images"});
    } else if name.ends_with("_no_pictures") {
        entry["columns"] = json!({"messages": "messages"});
    }
    entry
}

/// Writes the pictures that windows show; their paths by frame.
fn write_pictures(
    episode: &ExportedFlight<'_>,
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
            let size = smaller_size(full, options.width_px);
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

fn card<'a>(options: &Options, splits: impl Iterator<Item = &'a str>) -> ExportCard {
    let mut front_matter =
        String::from("task_categories:\n- image-text-to-text\nconfigs:\n- config_name: default\n  data_files:\n");
    for split in splits {
        let _ = write!(front_matter, "  - split: {split}\n    path: {split}.jsonl\n");
    }
    let (shape, input) = (options.window(), options.input.word());
    let frame = match options.increments.frame {
        IncrementAxes::World => "world",
        IncrementAxes::Body => "body",
    };
    let settings = format!(
        "Windows: {} frames of {input} flights, then {} waypoints of the expert, one window every {} frames; increments in the \
         {frame} frame. A model's answers are scored with\n\n```sh\ncosfly eval DATASET answers.jsonl --frame {frame} \
         --input {input} --history {} --horizon {} --stride {}\n```\n\nwhere a line of answers has `trajectory_id` and `frame` of \
         the line here, and `text`, what the model wrote. The first increment starts at the drone's own pose, from which a drone \
         flies on (`--anchor input`). The paper's untrained models have the scores of `--anchor expert`, where it starts at the \
         expert's pose: the report has both.\n\n",
        shape.history, shape.horizon, shape.stride, shape.history, shape.horizon, shape.stride
    );
    let pictures = format!(
        "\nPictures are at most {} pixels wide (`--width-px` of `cosfly export`), and boxes are in pixels of these pictures or in \
         thousandths. With patches of 28 x 28 pixels, as Qwen2-VL has them, a picture of 448 x 252 takes 144 tokens, and one of \
         1280 x 720 takes 777 after LLaMA-Factory's own limit. Five small ones with their texts fit into 2,048 tokens, LLaMA-Factory's default `cutoff_len`, \
         beyond which it drops the end of the question without a word: set `cutoff_len` for larger ones.\n",
        options.width_px
    );
    ExportCard { format: "VLM fine-tuning", front_matter, body: settings + BODY + &pictures }
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
