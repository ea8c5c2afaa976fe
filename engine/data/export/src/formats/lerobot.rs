//! LeRobot v3.0: episodes in Parquet files with pictures inside, tasks as strings, statistics of every feature.

mod depth;
mod episodes;
mod eyes;
mod motion;
mod statistics;
mod tables;

use crate::card::ExportCard;
use crate::films::Films;
use crate::folder::OutFolder;
use crate::format::Format;
use crate::pixels::rgb_of;
use crate::sample_text::pose_numbers;
use crate::shared_options::{InstructionLanguage, InstructionOptions};
use crate::source::{ExportedFlight, SensorReadings, Source};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_frames::Pose;
use cosfly_images::float_tiff;
use cosfly_read::PublishedFlight;
use cosfly_schema::log::reading::LoggedSensor;
use cosfly_schema::tables::Table;
use cosfly_write::table_file::TableWriter;
use episodes::EpisodeFile;
use eyes::Eye;
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Value, json};
use statistics::Statistics;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use tables::{DataRows, EpisodeRow, TaskRow, VECTORS};

/// Largest number of files of a folder, and size from which a new file begins, MB.
const CHUNK_FILES: usize = 1000;
const FILE_MB: u64 = 100;
/// Steps between the frames at most, and between the pixels, that count for the statistics; frames of an episode at least.
const SAMPLED_FRAMES: usize = 10;
const SAMPLED_PIXELS: usize = 16;
const LEAST_FRAMES: usize = 10;

/// Greatest depth, metres.
const MAX_DEPTH_M: u32 = 1000;

/// Episodes for robot learning.
pub struct LeRobot;

/// Options of `lerobot`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
pub struct Options {
    #[serde(flatten)]
    instructions: InstructionOptions,
    /// With depth as TIFF files, metres
    #[serde(default)]
    depth: bool,
    /// Greatest depth, which the sky has, too, metres
    #[serde(default = "max_depth_m")]
    #[schemars(range(min = 1, max = 10_000), title = "M")]
    max_depth_m: u32,
}

fn max_depth_m() -> u32 {
    MAX_DEPTH_M
}

impl Format for LeRobot {
    const NAME: &'static str = "lerobot";
    const DOC: &'static str =
        "LeRobot v3.0: a dataset per split; episodes with pictures, motion, the way to the expert, tasks as strings";
    type Options = Options;

    fn write(options: &Options, source: &Source<'_>, out: &OutFolder) -> Result<Vec<String>> {
        if options.max_depth_m != MAX_DEPTH_M && !options.depth {
            let message = "`--max-depth-m` limits depth, which this export leaves out";
            return Err(Diagnostic::new("export-lerobot", Fault::Recipe, message).hint("add `--depth`"));
        }
        let max_depth_m = options.depth.then_some(options.max_depth_m as f32);
        let films = Films::of(source);
        let (eyes, dt_s) = Eye::of_all(source, &films, options.depth)?;
        let kind = Kind { fps: fps(dt_s)?, sensed: sensed(source, &films)?, films, eyes, max_depth_m };
        for split in source.splits() {
            write_split(options.instructions.language, source, out, split, &kind)?;
        }
        card(&source.splits(), max_depth_m).write(source, out)?;
        Ok(vec![])
    }
}

/// Properties that all episodes share.
struct Kind<'a> {
    /// The films of each, and their cameras.
    films: Films<'a>,
    eyes: Vec<Eye>,
    /// Frames per second.
    fps: u32,
    /// Names of the numbers of all sensors that are no cameras.
    sensed: Vec<String>,
    /// Greatest depth, metres; none without depth.
    max_depth_m: Option<f32>,
}

/// Names of the numbers that the sensors of the first flight measured.
fn sensed(source: &Source<'_>, films: &Films<'_>) -> Result<Vec<String>> {
    let Some(flight) = source.flights().next() else { return Ok(vec![]) };
    let film = sensing(source, films.of_flight(flight))?.unwrap_or(flight);
    Ok(source.dataset.log(film)?.sensors().iter().flat_map(names_of).collect())
}

/// The first film with readings.
fn sensing<'a>(source: &Source<'_>, films: &[&'a PublishedFlight]) -> Result<Option<&'a PublishedFlight>> {
    for film in films {
        if !source.dataset.log(film)?.sensors().is_empty() {
            return Ok(Some(film));
        }
    }
    Ok(None)
}

fn names_of(sensor: &LoggedSensor) -> Vec<String> {
    sensor.measured().map(|(_, quantity)| format!("{}.{quantity}", sensor.name)).collect()
}

/// The last readings at each frame, those of all sensors one after the other.
fn sensed_by_frame(source: &Source<'_>, episode: &ExportedFlight<'_>, kind: &Kind<'_>) -> Result<Vec<Vec<f64>>> {
    let film = sensing(source, kind.films.of_flight(episode.flight))?;
    let sensors = film.map_or(Ok(vec![]), |film| source.readings(film))?;
    let names: Vec<String> = sensors.iter().flat_map(|(sensor, _)| names_of(sensor)).collect();
    let begins = |(_, readings): &SensorReadings| {
        readings.first().is_some_and(|(time_ns, _)| *time_ns == episode.flight.begins_ns)
    };
    if names != kind.sensed || !sensors.iter().all(begins) {
        let id = &episode.flight.trajectory_id;
        let message =
            format!("`{id}` differs from the first flight in its sensors, or lacks readings at its first frame");
        return Err(Diagnostic::new("export-lerobot", Fault::Input, message)
            .hint("LeRobot has one list of sensors; choose flights with `--trajectory` or `--split`"));
    }
    let at = |frame: usize| {
        let time_ns = episode.flight.times().ns(frame);
        let last = |(sensor, readings): &SensorReadings| -> Vec<f64> {
            let until = readings.partition_point(|(at_ns, _)| *at_ns <= time_ns);
            let values = readings.get(until.saturating_sub(1)).map_or(&[][..], |(_, values)| &values[..]);
            sensor.measured().filter_map(|(place, _)| values.get(place).copied()).collect()
        };
        sensors.iter().flat_map(last).collect()
    };
    Ok((0..episode.frames.len()).map(at).collect())
}

/// Writes the dataset of a split, into a folder of its own: LeRobot reads all episodes of a folder, whatever their split.
fn write_split(
    language: InstructionLanguage,
    source: &Source<'_>,
    out: &OutFolder,
    split: &str,
    kind: &Kind<'_>,
) -> Result<()> {
    let table = tables::data(&kind.eyes, kind.sensed.len(), kind.max_depth_m.is_some());
    let mut data = DataFiles { out, split, table: &table, file: 0, bytes: 0, open: None };
    let mut statistics = Statistics::default();
    let mut tasks: BTreeMap<String, usize> = BTreeMap::new();
    let (mut task_names, mut count, mut index) = (vec![], 0, 0);
    let path = |name: &str| format!("{split}/meta/{name}");
    let mut episodes = EpisodeFile::new(out.create(&path("episodes/chunk-000/file-000.parquet"))?);
    source.each_flight_of(&|flight| flight.split == split && kind.films.is_first(flight), &mut |episode| {
        let task = episode.instruction(language).to_owned();
        let task_index = *tasks.entry(task.clone()).or_insert_with(|| {
            task_names.push(task.clone());
            task_names.len() - 1
        });
        let expert = episode.expert_poses()?;
        let mut own = Statistics::default();
        let mut rows = rows_of(episode, &expert, [count, index, task_index], &mut [&mut own, &mut statistics])?;
        rows.readings = sensed_by_frame(source, episode, kind)?;
        for (film, eye) in kind.films.of_flight(episode.flight).iter().zip(&kind.eyes) {
            append_pictures((episode, film), eye, kind.max_depth_m, &mut rows, &mut [&mut own, &mut statistics])?;
        }
        for statistics in [&mut own, &mut statistics].into_iter().filter(|_| !kind.sensed.is_empty()) {
            rows.readings.iter().for_each(|numbers| statistics.push(tables::SENSORS, numbers));
        }
        let length = rows.vectors.len();
        let file = data.append(&rows)?;
        let row = EpisodeRow {
            trajectory_id: episode.flight.trajectory_id.clone(),
            expert_id: episode.flight.expert_id.clone().unwrap_or_default(),
            split: episode.flight.split.clone(),
            episode: count,
            task,
            from: index,
            to: index + length,
            chunk: file / CHUNK_FILES,
            file: file % CHUNK_FILES,
        };
        episodes.append(&row, &own)?;
        (count, index) = (count + 1, index + length);
        Ok(())
    })?;
    data.end()?;
    episodes.finish()?;
    let tasks: Vec<TaskRow> = task_names.into_iter().enumerate().map(|(index, task)| TaskRow { index, task }).collect();
    write_table(out, &path("tasks.parquet"), &tables::tasks(), &tasks, &[("pandas", tables::pandas_index())])?;
    out.put(&path("stats.json"), format!("{:#}\n", statistics.to_json()).as_bytes())?;
    out.put(&path("info.json"), format!("{:#}\n", info(split, kind, [count, index, tasks.len()])).as_bytes())
}

/// The whole number of frames per second.
fn fps(dt_s: f64) -> Result<u32> {
    let fps = (1.0 / dt_s).round_ties_even();
    if !(1.0..=1000.0).contains(&fps) || (fps * dt_s - 1.0).abs() > 1e-9 {
        let message = format!("{dt_s} s between frames is not a whole number of frames per second");
        return Err(Diagnostic::new("export-lerobot", Fault::Recipe, message).hint(
            "LeRobot counts whole frames per second: film with another `dt_s`, such as 0.1, 0.25 or 0.5, or with `every`",
        ));
    }
    Ok(fps as u32)
}

/// The rows of a flight without its pictures; its numbers count in both `statistics`. `numbers` are those of the episode, of its first
/// frame and of its task.
fn rows_of(
    episode: &ExportedFlight<'_>,
    expert: &[Pose],
    numbers: [usize; 3],
    statistics: &mut [&mut Statistics; 2],
) -> Result<DataRows> {
    let [number, first, task] = numbers;
    let dt_s = episode.flight.dt_s;
    let mut rows = DataRows { number, first, task, dt_s, ..DataRows::default() };
    for (frame, row) in episode.frames.iter().enumerate() {
        let pose = &row.pose;
        let numbers = pose_numbers(pose);
        let before = frame.checked_sub(1).map_or(pose, |before| &episode.frames[before].pose);
        let edges = row.visible_box_px.unwrap_or([-1.0; 4]).map(f64::from);
        let vectors = [
            [&motion::along(pose, before, pose)[..], &[numbers[3], numbers[5]]].concat(),
            numbers.to_vec(),
            row.target.feet_in_world.to_array().to_vec(),
            edges.to_vec(),
            motion::chunk(pose, expert, frame),
        ];
        for ((name, ..), values) in VECTORS.iter().zip(&vectors) {
            statistics.iter_mut().for_each(|it| it.push(name, values));
        }
        let counts =
            [("frame_index", frame), ("episode_index", number), ("index", first + frame), ("task_index", task)];
        for statistics in statistics.iter_mut() {
            counts.into_iter().for_each(|(name, count)| statistics.push(name, &[count as f64]));
            statistics.push("timestamp", &[frame as f64 * dt_s]);
        }
        rows.vectors.push(vectors);
    }
    Ok(rows)
}

/// Appends the pictures of a film to the rows of its episode; those of some frames count in both `statistics`.
fn append_pictures(
    (episode, film): (&ExportedFlight<'_>, &PublishedFlight),
    eye: &Eye,
    max_depth_m: Option<f32>,
    rows: &mut DataRows,
    statistics: &mut [&mut Statistics; 2],
) -> Result<()> {
    let step = (episode.frames.len() / LEAST_FRAMES).clamp(1, SAMPLED_FRAMES);
    let (mut pictures, mut depths) = (vec![], vec![]);
    episode.each_picture_of(
        film,
        &episode.all_frames(),
        |frame, mut logged| {
            let is_sampled = frame % step == 0;
            let sampled = if is_sampled { Some(rgb_of(&logged)?) } else { None };
            let Some(most) = max_depth_m else { return Ok((logged.rgb_file, sampled, None)) };
            logged.depth_m.iter_mut().for_each(|depth| *depth = depth.min(most));
            let file = float_tiff::file(&logged.depth_m, [logged.width, logged.height])?;
            Ok((logged.rgb_file, sampled, Some((file, if is_sampled { logged.depth_m } else { vec![] }))))
        },
        |_, (file, rgb, depth)| {
            let (depth, sampled) = depth.unzip();
            for it in statistics.iter_mut().filter(|_| rgb.is_some()) {
                let pixels = rgb.iter().flat_map(|rgb| rgb.as_chunks::<3>().0).step_by(SAMPLED_PIXELS);
                it.push_picture(eye.colours, 255.0, pixels.map(|pixel| pixel.map(usize::from)));
                let Some(depths) = &sampled else { continue };
                let steps = |depth: &f32| [(f64::from(*depth) * depth::STATISTICS_PER_M).round_ties_even() as usize];
                let pixels = depths.iter().step_by(SAMPLED_PIXELS).map(steps);
                it.push_picture(eye.depths, depth::STATISTICS_PER_M, pixels);
            }
            pictures.push(file);
            depths.extend(depth);
            Ok(())
        },
    )?;
    rows.pictures.push(pictures);
    rows.depths.push(depths);
    Ok(())
}

/// The files of `data`, one of them open.
struct DataFiles<'a> {
    out: &'a OutFolder,
    split: &'a str,
    table: &'a Table<DataRows>,
    file: usize,
    bytes: u64,
    open: Option<TableWriter<'a, DataRows, BufWriter<File>>>,
}

impl DataFiles<'_> {
    /// Writes an episode; returns the number of its file.
    fn append(&mut self, rows: &DataRows) -> Result<usize> {
        if self.bytes >= FILE_MB * 1_000_000 {
            self.end()?;
            (self.file, self.bytes) = (self.file + 1, 0);
        }
        if self.open.is_none() {
            let (split, chunk, file) = (self.split, self.file / CHUNK_FILES, self.file % CHUNK_FILES);
            let name = format!("{split}/data/chunk-{chunk:03}/file-{file:03}.parquet");
            self.open = Some(TableWriter::new(self.table, self.out.create(&name)?)?);
        }
        if let Some(writer) = &mut self.open {
            writer.append(rows)?;
        }
        self.bytes += rows.pictures.iter().chain(&rows.depths).flatten().map(|file| file.len() as u64).sum::<u64>();
        Ok(self.file)
    }

    fn end(&mut self) -> Result<()> {
        self.open.take().map_or(Ok(()), |writer| writer.finish().map(|_| ()))
    }
}

fn write_table<S>(out: &OutFolder, name: &str, table: &Table<S>, rows: &[S], notes: &[(&str, String)]) -> Result<()> {
    let mut writer = TableWriter::with_notes(table, out.create(name)?, notes)?;
    rows.iter().try_for_each(|row| writer.append(row))?;
    writer.finish().map(|_| ())
}

/// The content of `meta/info.json`; `totals` are the numbers of episodes, frames and tasks.
fn info(split: &str, kind: &Kind<'_>, totals: [usize; 3]) -> Value {
    let [episodes, frames, tasks] = totals;
    let mut features = BTreeMap::new();
    for eye in &kind.eyes {
        let [width, height] = eye.size_px;
        let colours = json!({"dtype": "image", "shape": [height, width, 3], "names": ["height", "width", "channels"]});
        features.insert(eye.colours.to_owned(), colours);
        if kind.max_depth_m.is_some() {
            features.insert(eye.depths.to_owned(), depth::feature(eye.size_px));
        }
    }
    for (name, names) in VECTORS {
        features.insert(name.to_owned(), json!({"dtype": "float32", "shape": [names.len()], "names": names}));
    }
    if !kind.sensed.is_empty() {
        let sensed = json!({"dtype": "float32", "shape": [kind.sensed.len()], "names": kind.sensed});
        features.insert(tables::SENSORS.into(), sensed);
    }
    features.insert("timestamp".into(), json!({"dtype": "float32", "shape": [1], "names": null}));
    for name in ["frame_index", "episode_index", "index", "task_index"] {
        features.insert(name.into(), json!({"dtype": "int64", "shape": [1], "names": null}));
    }
    json!({
        "codebase_version": "v3.0",
        "robot_type": "drone",
        "total_episodes": episodes,
        "total_frames": frames,
        "total_tasks": tasks,
        "chunks_size": CHUNK_FILES,
        "data_files_size_in_mb": FILE_MB,
        "video_files_size_in_mb": 200,
        "fps": kind.fps,
        "splits": {split: format!("0:{episodes}")},
        "data_path": "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet",
        "video_path": null,
        "features": features,
    })
}

fn card(splits: &[&str], max_depth_m: Option<f32>) -> ExportCard {
    let mut front_matter = String::from(
        "task_categories:\n- robotics\ntags:\n- LeRobot\nconfigs:\n- config_name: default\n  data_files:\n",
    );
    let mut loading = String::new();
    for split in splits {
        front_matter.push_str(&format!("  - split: {split}\n    path: {split}/data/*/*.parquet\n"));
        loading.push_str(&format!("{split} = LeRobotDataset(\"cosfly/{split}\", root=\"{split}\")\n"));
    }
    let depth = max_depth_m.map_or(String::new(), |most| DEPTH.replace("MOST", &most.to_string()));
    let body = BODY.replace("LOADING\n", &loading).replace("DEPTH\n", &depth);
    ExportCard { format: "LeRobot v3.0", front_matter, body }
}

const BODY: &str = "\
```python
from lerobot.datasets.lerobot_dataset import LeRobotDataset
LOADING
```

Each folder is a whole dataset of LeRobot with its own statistics: train with the folder of one split, and normalise with its
statistics. On the hub, each folder is a repository of its own, with the git tag `v3.0`. Episodes are flights; `meta/episodes` names
them and has the statistics of each (`stats/...`), from which LeRobot makes those of parts and mixtures. Metres and degrees.

* `observation.images.rgb`: the colours. `task`: the instruction. Films of several cameras that have the same moments are one episode with a
  feature for each camera, such as `observation.images.front_left`; its other numbers are those of the first camera's film.
DEPTH
* `observation.state`: dx, dy, dz, dpitch, dyaw, droll since the frame before, along the axes of the body in this frame (x ahead, y
  right, z up), 0 in the first frame; then pitch and roll. No place and no direction of the map.
* `action`: five increments of dx, dy, dz, dpitch, dyaw, droll, all of them along the axes of the body in *this* frame; angles
  are differences. The first one leads from this pose to the expert's next pose, the others on along the expert, so that the sum of
  the first k leads to the expert's pose k frames later, from perturbed poses, too. An action is a whole chunk: policies of
  chunks use a chunk of 1, and `action.reshape(5, 6)` has the steps. Behind the end of a flight the expert waits.
* `observation.sensors`: the last reading of each sensor of the dataset, where it has any, without the true numbers; `meta/info.json` names the numbers.
* `privileged.pose`: the drone's x, y, z, pitch, yaw, roll. `privileged.target`: the place between the target's feet. `privileged.box`:
  left, top, right, bottom edges of what can be seen of the target, pixels; -1 where nothing is. World: CARLA's axes. These are
  labels that no drone has; policies of LeRobot take only features called `observation...` as inputs.
";

const DEPTH: &str = "\
* `observation.images.depth` (of several cameras: `observation.images.front_left_depth` ...): metres along the optical axis, 32-bit floats in TIFF files; at most MOST, which is also the sky. LeRobot from
  0.6 on gives millimetres unless `depth_output_unit=\"m\"`; 0.4 gives metres.
";
