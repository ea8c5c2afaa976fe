//! Grounding: a line of JSON per frame: the target's box and visibility, why it is lost and where it comes back, and the expert's next steps.

mod reason;

use self::reason::{OUT_OF_VIEW, Shown, TOO_SMALL};
use crate::card::ExportCard;
use crate::folder::OutFolder;
use crate::format::Format;
use crate::media::{ending, picture_path};
use crate::sample_text::frame_facts;
use crate::shared_options::{InstructionLanguage, PictureAndTextOptions};
use crate::source::{ExportedFlight, Source};
use cosfly_diagnose::Result;
use cosfly_frames::{DVec3, action, real};
use cosfly_read::{FrameRow, PublishedDataset, PublishedFlight, SightingReader, read};
use cosfly_schema::losses::cause;
use cosfly_schema::tables::Objects;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::Write;
use std::ops::Range;

/// Boxes, visibility, steps and reasons.
pub struct Grounding;

/// Number of steps of the expert.
const STEPS: usize = 5;

impl Format for Grounding {
    const NAME: &'static str = "grounding";
    const DOC: &'static str = "JSON lines of frames: box and visibility of the target, why it is lost, where it comes back, the expert's next steps";
    type Options = PictureAndTextOptions;

    fn write(options: &PictureAndTextOptions, source: &Source<'_>, out: &OutFolder) -> Result<Vec<String>> {
        let mut kinds = Kinds::of(source.dataset)?;
        for split in source.splits() {
            write_split(options, source, out, split, &mut kinds)?;
        }
        let mut front_matter = String::from("configs:\n- config_name: default\n  data_files:\n");
        for split in source.splits() {
            front_matter.push_str(&format!("  - split: {split}\n    path: {split}.jsonl\n"));
        }
        ExportCard { format: "grounding", front_matter, body: BODY.into() }.write(source, out)?;
        Ok(vec![])
    }
}

/// Kinds of what can hide a target.
struct Kinds {
    /// Of objects, by town and by instance id.
    objects: BTreeMap<String, BTreeMap<u32, String>>,
    bodies: SightingReader,
}

impl Kinds {
    fn of(dataset: &PublishedDataset) -> Result<Self> {
        let mut objects: BTreeMap<String, BTreeMap<u32, String>> = BTreeMap::new();
        for (_, path) in dataset.files("objects")? {
            read(&path, &mut |rows| {
                for row in 0..rows.len() {
                    let of_town = objects.entry(rows.get(Objects::town, row)?).or_default();
                    of_town.insert(rows.get(Objects::instance, row)?, rows.get(Objects::kind, row)?);
                }
                Ok(())
            })?;
        }
        Ok(Self { objects, bodies: SightingReader::of(dataset)? })
    }

    /// Kinds of the bodies that a flight shows, by instance id.
    fn bodies(&mut self, dataset: &PublishedDataset, flight: &PublishedFlight) -> Result<BTreeMap<u32, String>> {
        let place = dataset.place(&flight.trajectory_id).unwrap_or_default();
        Ok(self.bodies.at(dataset, place)?.iter().map(|body| (body.instance, body.kind.clone())).collect())
    }
}

fn write_split(
    options: &PictureAndTextOptions,
    source: &Source<'_>,
    out: &OutFolder,
    split: &str,
    kinds: &mut Kinds,
) -> Result<()> {
    let language = options.instructions.language;
    let name = format!("{split}.jsonl");
    let mut file = out.create(&name)?;
    let mut number = 0;
    source.each_flight_of(&|flight| flight.split == split, &mut |episode| {
        let (flight, rows) = (episode.flight, &episode.frames[..]);
        let text = episode.instruction(language);
        let expert = episode.expert_poses()?;
        let losses = losses(episode);
        let bodies = kinds.bodies(source.dataset, flight)?;
        let objects = kinds.objects.get(&flight.town);
        let named = |language, instance| match bodies.get(&instance) {
            Some(kind) => reason::body(language, kind, instance),
            None => reason::object(language, objects.and_then(|it| it.get(&instance)).map(String::as_str), instance),
        };
        episode.each_picture(
            &episode.every_nth_frame(options.pictures.every),
            |frame, logged| {
                let path = format!(
                    "images/{split}/{}",
                    picture_path(number, &flight.trajectory_id, frame, ending(&logged.rgb_format))
                );
                out.put(&path, &logged.rgb_file)?;
                let mut line = frame_facts(flight, &rows[frame], frame, text);
                line["image"] = json!(path);
                let poses = std::iter::once(&rows[frame].pose).chain(expert.iter().skip(frame + 1).take(STEPS));
                let poses: Vec<_> = poses.collect();
                line["expert_steps_in_body"] =
                    poses.windows(2).map(|pair| json!(action::in_body(pair[0], pair[1]))).collect();
                let loss = losses.iter().find(|loss| loss.frames.contains(&frame));
                line["loss"] = loss.map_or(Value::Null, |loss| {
                    loss.facts(rows, frame, flight.dt_s, &named(InstructionLanguage::En, loss.cause_instance))
                });
                let row = &rows[frame];
                let shown = Shown {
                    pixels: row.visible_pixels,
                    hidden_percent: 100.0 * (1.0 - row.visible_by_pixels),
                    hidden_by: (row.occluder_instance != 0).then(|| named(language, row.occluder_instance)),
                    loss: &line["loss"],
                    cause: loss.map_or_else(String::new, |loss| named(language, loss.cause_instance)),
                };
                line["reason"] = json!(shown.in_words(language));
                Ok(line)
            },
            |_, line| writeln!(file, "{line}").map_err(|error| out.refusal(&name, &error)),
        )?;
        number += 1;
        Ok(())
    })?;
    file.flush().map_err(|error| out.refusal(&name, &error))
}

/// Frames in a row without a visible pixel of the target: a row of table `target_losses`.
struct Loss {
    frames: Range<usize>,
    cause_instance: u32,
    frames_out_of_view: usize,
    /// Those of them in which the target is before the camera and covers no pixel's centre.
    frames_too_small: usize,
}

/// The losses of a flight; none for a target without a body.
fn losses(episode: &ExportedFlight<'_>) -> Vec<Loss> {
    let mut begin = 0;
    let mut losses = vec![];
    for rows in episode.frames.chunk_by(|a, b| (a.visible_pixels == 0) == (b.visible_pixels == 0)) {
        if rows[0].visible_pixels == 0 && episode.flight.target_kind.is_some() {
            losses.push(Loss {
                frames: begin..begin + rows.len(),
                cause_instance: cause(rows.iter().map(|row| row.occluder_instance)),
                frames_out_of_view: rows.iter().filter(|row| !row.in_view).count(),
                frames_too_small: rows.iter().filter(|row| !row.in_view && is_in_picture(episode.flight, row)).count(),
            });
        }
        begin += rows.len();
    }
    losses
}

/// Whether the middle of the target is in the picture, whatever hides it.
fn is_in_picture(flight: &PublishedFlight, row: &FrameRow) -> bool {
    let middle = row.target.feet_in_world + DVec3::Z * (0.5 * flight.target_height_m);
    let (camera, seen) = (&flight.camera, row.camera_pose.body_from_world_point(middle));
    flight.lens.project(camera, seen).is_some_and(|(u, v, _)| {
        (0.0..f64::from(camera.width)).contains(&u) && (0.0..f64::from(camera.height)).contains(&v)
    })
}

impl Loss {
    /// The loss as frame `now` knows it in hindsight; where the target comes back is seen from the camera's pose now.
    /// `hidden_by` is what hides it in most frames, in words.
    fn facts(&self, rows: &[FrameRow], now: usize, dt_s: f64, hidden_by: &str) -> Value {
        let is_most = |frames: usize| self.cause_instance == 0 && 2 * frames > self.frames.len();
        let cause = match () {
            () if is_most(self.frames_too_small) => TOO_SMALL,
            () if is_most(self.frames_out_of_view) => OUT_OF_VIEW,
            () => hidden_by,
        };
        let comes_back = rows.get(self.frames.end).map(|row| {
            let place = rows[now].camera_pose.body_from_world_point(row.target.feet_in_world);
            json!({
                "frame": self.frames.end,
                "in_s": tenths((self.frames.end - now) as f64 * dt_s),
                "distance_m": tenths(place.length()),
                "bearing_deg": real::atan2(place.y, place.x).to_degrees().round() + 0.0,
            })
        });
        json!({
            "start_frame": self.frames.start,
            "end_frame": self.frames.end,
            "lost_for_s": tenths((now - self.frames.start) as f64 * dt_s),
            "cause_instance": self.cause_instance,
            "cause": cause,
            "comes_back": comes_back,
        })
    }
}

fn tenths(value: f64) -> f64 {
    (10.0 * value).round() / 10.0 + 0.0
}

const BODY: &str = "\
```python
import json
for line in open(\"train.jsonl\"):
    row = json.loads(line)
    row[\"image\"], row[\"visible_box_px\"], row[\"visible_by_pixels\"], row[\"expert_steps_in_body\"], row[\"reason\"]
```

A line is a frame: path of the picture, facts of tables `trajectories` and `frames`, and

* `visible_box_px`: left, top, right, bottom of what is seen of the target, null where nothing is; `visible_by_pixels`: its share, 0 to 1;
* `expert_steps_in_body`: up to five steps, from the drone's own pose to the expert's next one, and on along the expert: dx ahead, dy right,
  dz up (m), dpitch, dyaw, droll (degrees); fewer at the end of a flight;
* `loss`: null, or the row of table `target_losses` with this `trajectory_id` and `start_frame`: what hides the target in most of its frames
  (`smaller than a pixel`: it is before the camera, and covers no pixel's middle), and where it comes back, from the camera's place now
  (metres to its feet, degrees right of the camera's axis along its picture); `comes_back` is null where the flight ends first;
* `reason`: the same in words, in the language of the option `language`. All numbers in it are in the line. A policy does not know when a target comes back: it is what to learn.
";

#[cfg(test)]
mod tests {
    use crate::laws::{export_with, files, published};
    use crate::source::Choice;
    use cosfly_read::{PublishedDataset, read};
    use cosfly_sample as sample;
    use cosfly_schema::tables::TargetLosses;
    use cosfly_schema::{DatasetConfig, EncodingConfig};
    use serde_json::{Map, Value};
    use std::collections::BTreeSet;
    use std::path::Path;

    #[test]
    fn a_target_before_the_camera_is_not_out_of_view() {
        let home = tempfile::tempdir().unwrap();
        let mut flights = sample::flights();
        flights.truncate(1);
        // Without a pixel in frames 0 and 3, in the latter because the drone looks away.
        flights[0].record.trajectory.poses_in_world[3].yaw_rad += 3.0;
        for frame in [0, 3] {
            let view = &mut flights[0].record.views[frame];
            (view.in_view, view.visible_box, view.full_box, view.pixels) = (false, None, None, 0);
            view.visible_by_pixels = 0.0;
        }
        let (data, out) = (home.path().join("data"), home.path().join("out"));
        sample::write_flights(&data, &DatasetConfig::default(), EncodingConfig::default(), flights).unwrap();
        let dataset = PublishedDataset::open(&data).unwrap();
        export_with(&dataset, "grounding", Map::new(), &Choice::default(), &out).unwrap();
        let written: Vec<u8> =
            files(&out).into_iter().filter(|it| it.0.ends_with("train.jsonl")).flat_map(|it| it.1).collect();
        let rows: Vec<Value> =
            std::str::from_utf8(&written).unwrap().lines().map(|it| serde_json::from_str(it).unwrap()).collect();
        let causes: Vec<&Value> =
            rows.iter().map(|row| &row["loss"]["cause"]).filter(|cause| !cause.is_null()).collect();
        assert_eq!(causes, ["smaller than a pixel", "out of view"]);
        assert!(
            rows[0]["reason"].as_str().unwrap().contains("lost just now: it is smaller than a pixel. It comes back")
        );
    }

    #[test]
    fn losses_are_the_rows_of_the_table() {
        let home = tempfile::tempdir().unwrap();
        let mut flights = sample::flights();
        // One loss at the start, one until the end.
        for (flight, frames) in flights.iter_mut().zip([vec![0, 1], vec![3, 4]]) {
            for frame in frames {
                let view = &mut flight.record.views[frame];
                (view.visible_box, view.pixels, view.occluder_instance, view.visible_by_pixels) = (None, 0, 7, 0.0);
            }
        }
        let (data, out) = (home.path().join("data"), home.path().join("out"));
        sample::write_flights(&data, &DatasetConfig::default(), EncodingConfig::default(), flights).unwrap();
        let dataset = PublishedDataset::open(&data).unwrap();
        export_with(&dataset, "grounding", Map::new(), &Choice::default(), &out).unwrap();
        let (mut told, mut rows_of_table) = (BTreeSet::new(), BTreeSet::new());
        for bytes in files(&out).into_iter().filter(|(path, _)| path.extension().is_some_and(|it| it == "jsonl")) {
            for line in std::str::from_utf8(&bytes.1).unwrap().lines() {
                let row: Value = serde_json::from_str(line).unwrap();
                let loss = &row["loss"];
                if let Some(start) = loss["start_frame"].as_u64() {
                    let id = row["trajectory_id"].as_str().unwrap().to_owned();
                    let numbers =
                        [start, loss["end_frame"].as_u64().unwrap(), loss["cause_instance"].as_u64().unwrap()];
                    told.insert((id, numbers, !loss["comes_back"].is_null()));
                }
            }
        }
        for (_, path) in dataset.files("target_losses").unwrap() {
            read(&path, &mut |rows| {
                for row in 0..rows.len() {
                    let numbers = [TargetLosses::start_frame, TargetLosses::end_frame, TargetLosses::cause_instance]
                        .map(|column| u64::from(rows.get(column, row).unwrap()));
                    let id: String = rows.get(TargetLosses::trajectory_id, row)?;
                    rows_of_table.insert((id, numbers, rows.get(TargetLosses::reacquired, row)?));
                }
                Ok(())
            })
            .unwrap();
        }
        assert!(told.len() > 1, "{told:?}");
        assert_eq!(told, rows_of_table);
    }

    #[test]
    fn every_number_of_a_reason_is_in_the_line() {
        for (language, lost) in [("en", "lost"), ("zh", "丢失")] {
            has_its_numbers(language, lost);
        }
    }

    /// `lost` is the word that all losses have.
    fn has_its_numbers(language: &str, lost: &str) {
        let (home, dataset) = published();
        let out = home.path().join("out");
        let options = Map::from_iter([("language".to_owned(), Value::from(language))]);
        export_with(&dataset, "grounding", options, &Choice::default(), &out).unwrap();
        let written = files(&out);
        let mut lines = 0;
        for (path, bytes) in written.iter().filter(|(path, _)| path.extension().is_some_and(|it| it == "jsonl")) {
            for line in std::str::from_utf8(bytes).unwrap().lines() {
                let row: Value = serde_json::from_str(line).unwrap();
                assert!(written.contains_key(Path::new(row["image"].as_str().unwrap())), "{}: {line}", path.display());
                let reason = row["reason"].as_str().unwrap();
                assert_eq!(row["loss"].is_null(), !reason.contains(lost), "{line}");
                for fact in ["in_s", "distance_m"] {
                    let back = &row["loss"]["comes_back"][fact];
                    assert!(back.is_null() || reason.contains(&back.to_string()), "{line}");
                }
                lines += 1;
            }
        }
        assert!(lines > 0);
    }
}
