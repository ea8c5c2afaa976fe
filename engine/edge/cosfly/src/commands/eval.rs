//! `cosfly eval`: scores of predictions on a dataset, of waypoints beside baselines, or of pictures.

mod choices;

use crate::arguments::count;
use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use choices::{AnchorChoice, FrameChoice, KindChoice, OriginChoice, RoleChoice};
use clap::{Args, Parser};
use cosfly_diagnose::{Diagnostic, Result, plausible};
use cosfly_evaluate::pictures::{self, PictureKind, PictureSettings};
use cosfly_evaluate::windows::Flights;
use cosfly_evaluate::{Evaluation, Settings, evaluate, name_of};
use cosfly_export::on_threads;
use cosfly_read::PublishedDataset;
use cosfly_read::predictions;
use cosfly_windows::WindowShape;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Score predictions on a finished dataset: waypoints (beside baselines), depth, labels, boxes, masks, tracks
#[derive(Debug, Parser)]
#[command(
    name = "eval",
    after_help = "\
Examples:
  cosfly eval out/carla_town predictions.jsonl
  cosfly eval out/carla_town predictions.parquet --split test --out scores
  cosfly eval out/carla_town answers.jsonl --frame body --missing-as-zero
  cosfly eval out/carla_town depth-of-my-model                        a folder of PNG or .npy files
  cosfly eval out/carla_town results.json --images out/coco/annotations/instances_val.json
  cosfly eval out/carla_town results-of-my-tracker --sequences out/mot  a folder of text files
  cosfly eval out/carla_town                                          the baselines alone

A line of predictions is like
  {\"trajectory_id\": \"perturbed-p00000\", \"frame\": 3, \"waypoint_deltas\": [[0.5, 0, 0, 0, 2, 0], ... five in all]}
with the first frame of a window (0, 3, 6, ...) and, per waypoint, dx, dy, dz (m), dpitch, dyaw, droll (degrees) as an
array or an object; a missing dimension counts as 0. Instead of `waypoint_deltas`, `text` may hold what a model wrote:
text before `</think>` is dropped, and a JSON object in the rest has `waypoint_deltas`. Optional `boxes` are the target's
boxes in the waypoints' frames. Parquet has the same columns.

Pictures: the name of a file ends in the number of its frame, in a folder with the name of the trajectory, as
in `cosfly export --format imagefolder`: .../perturbed-p00000/000/000012.png. Depth is 16-bit PNG (centimetres unless
`--depth-per-metre` says otherwise; 65535 is the sky) or .npy (metres); labels are 8-bit PNG of CARLA's ids. Boxes and
masks are COCO results: an array, or lines, of
  {\"image_id\": 7, \"category_id\": 12, \"bbox\": [left, top, width, height], \"score\": 0.9}
where `trajectory_id` and `frame` may stand instead of `image_id`, and `segmentation` (run lengths) makes masks.

Trackers: a text file per sequence of an export, SEQUENCE.txt. For `mot` a line is picture, id, left, top, width, height,
score and perhaps the class; for `otb` and `lasot` each line is a picture: left, top, width, height.

Rows and files that cannot be scored are counted and named, and so are windows and frames without a prediction: the scores
are then of a part alone, the report says so first, and the exit code is 1. It is 4 when nothing can be scored."
)]
pub struct Arguments {
    /// Folder of the dataset that `cosfly run` delivered
    #[arg(value_name = "DATASET")]
    dataset: PathBuf,
    /// Predictions: of waypoints JSON lines or Parquet, of depth or labels a folder of pictures, of boxes or masks COCO
    /// results, of a tracker a folder of text files [default: none, the baselines alone]
    #[arg(value_name = "PREDICTIONS")]
    predictions: Option<PathBuf>,
    /// Folder for report.md, report.json and errors.svg [default: <PREDICTIONS>-evaluation]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Kind of predictions [default: found from the file or folder]
    #[arg(long, value_enum)]
    kind: Option<KindChoice>,
    /// Splits to score (repeatable) [default: those of the predicted flights; without predictions, all but train]
    #[arg(long = "split", value_name = "NAME")]
    splits: Vec<String>,
    /// Cameras of a rig whose films are scored (repeatable) [default: those of the predicted flights; without predictions, all]
    #[arg(long = "camera", value_name = "NAME")]
    cameras: Vec<String>,
    /// Axes of the increments: those of the world, or of the body that moves (x ahead, y right, z up)
    #[arg(long, value_enum, default_value_t = FrameChoice::World)]
    frame: FrameChoice,
    /// Pose that each increment starts from: the waypoint before, or the current pose for all
    #[arg(long, value_enum, default_value_t = OriginChoice::Previous)]
    origin: OriginChoice,
    /// Pose that the first increment starts from: the last one of the input, or the expert's in the same frame
    #[arg(long, value_enum, default_value_t = AnchorChoice::Input)]
    anchor: AnchorChoice,
    /// Flights that models see
    #[arg(long, value_enum, default_value_t = RoleChoice::Perturbed)]
    input: RoleChoice,
    /// Frames that a model sees
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = count())]
    history: usize,
    /// Waypoints that a model predicts
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = count())]
    horizon: usize,
    /// Distance from one window to the next, frames
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = count())]
    stride: usize,
    /// Score windows without a prediction as if all increments were zero, instead of leaving them out
    #[arg(long)]
    missing_as_zero: bool,
    /// Number of resamples of an interval
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = count())]
    resamples: usize,
    /// Seed of the resamples
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Print the report as JSON
    #[arg(long)]
    json: bool,
    /// Number of threads [default: all cores]
    #[arg(short = 'j', long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    #[command(flatten)]
    pictures: PictureArguments,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let reports = on_threads(self.jobs, || reports(self))??;
        let folder = folder(self);
        write(&folder, &reports)?;
        if self.json {
            console.print(&reports.json)?;
        } else {
            let text = &reports.markdown;
            console.print(&format!("{text}\nwritten to {}: report.md, report.json, errors.svg\n", folder.display()))?;
        }
        Ok(if reports.has_problems { exit::FOUND_PROBLEMS } else { exit::SUCCESS })
    }
}

/// Options of `eval` for pictures.
#[derive(Args, Debug)]
#[command(next_help_heading = "Options for depth, labels, boxes, masks and tracks")]
struct PictureArguments {
    /// Distance from one prediction to the next, frames
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = count())]
    every: usize,
    /// Units per metre in depth pictures of whole numbers: 100 as `cosfly export` writes them, 1000 for millimetres
    #[arg(long, value_name = "NUMBER", default_value_t = 100.0, value_parser = positive)]
    depth_per_metre: f64,
    /// Largest true depth of a pixel that counts, metres
    #[arg(long, value_name = "METRES", default_value_t = 80.0, value_parser = positive)]
    max_depth_m: f64,
    /// Classes to score, such as 12 for pedestrians (repeatable) [default: all]
    #[arg(long = "category", value_name = "ID", value_parser = clap::value_parser!(u8).range(0..=28))]
    categories: Vec<u8>,
    /// Frames of the `image_id`s: annotations/instances_<split>.json of `cosfly export --format coco`
    #[arg(long, value_name = "FILE")]
    images: Option<PathBuf>,
    /// Sequences that a tracker saw: an export for trackers, or its `sequences.jsonl` [default: all flights]
    #[arg(long, value_name = "EXPORT")]
    sequences: Option<PathBuf>,
}

/// A number above 0.
fn positive(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| format!("`{text}` is not a number"))?;
    match plausible(number) {
        Ok(number) if number > 0.0 => Ok(number),
        Ok(_) => Err(format!("`{text}` is not more than 0")),
        Err(fault) => Err(format!("`{text}` {fault}")),
    }
}

/// A report in three forms.
struct Reports {
    markdown: String,
    json: String,
    svg: String,
    has_problems: bool,
}

fn reports(arguments: &Arguments) -> Result<Reports> {
    if arguments.dataset.is_file() {
        let opened = PublishedDataset::open(&arguments.dataset).map(drop);
        opened.map_err(|refusal| refusal.hint("the dataset comes first: `cosfly eval DATASET PREDICTIONS`"))?;
    }
    if let Some((path, kind)) = picture_kind(arguments)? {
        let dataset = PublishedDataset::open(&arguments.dataset)?;
        let flights = Flights::read(&dataset)?;
        let found = pictures::evaluate(&dataset, &flights, path, &picture_settings(kind, arguments))?;
        let has_problems = found.has_problems();
        return Ok(Reports { markdown: found.to_markdown(), json: found.to_json(), svg: found.to_svg(), has_problems });
    }
    let found = evaluation(arguments)?;
    let has_problems = found.has_problems();
    Ok(Reports { markdown: found.to_markdown(), json: found.to_json(), svg: found.to_svg(), has_problems })
}

/// The kind that was asked for, or that the predictions look like; none for waypoints.
fn picture_kind(arguments: &Arguments) -> Result<Option<(&Path, PictureKind)>> {
    let Some(path) = arguments.predictions.as_deref() else { return Ok(None) };
    let kind = match arguments.kind {
        Some(kind) => kind.of_pictures(),
        None => pictures::recognise(path)?,
    };
    Ok(kind.map(|kind| (path, kind)))
}

fn picture_settings(kind: PictureKind, arguments: &Arguments) -> PictureSettings {
    let of_pictures = &arguments.pictures;
    PictureSettings {
        splits: arguments.splits.clone(),
        every: of_pictures.every,
        max_depth_m: of_pictures.max_depth_m,
        depth_per_metre: of_pictures.depth_per_metre,
        categories: of_pictures.categories.clone(),
        images: of_pictures.images.clone(),
        sequences: of_pictures.sequences.clone(),
        resamples: arguments.resamples,
        seed: arguments.seed,
        ..PictureSettings::new(kind)
    }
}

fn evaluation(arguments: &Arguments) -> Result<Evaluation> {
    // Both take seconds when they are large.
    let (flights, given) = std::thread::scope(|scope| {
        let reader = scope.spawn(|| PublishedDataset::open(&arguments.dataset).and_then(|it| Flights::read(&it)));
        let given =
            arguments.predictions.as_deref().map(|path| predictions::read(path).map(|rows| (name_of(path), rows)));
        (reader.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)), given.transpose())
    });
    let (flights, given) = (flights?, given?);
    let (name, rows) = given.unzip();
    evaluate(&flights, name.as_deref().zip(rows), &settings(arguments))
}

fn settings(arguments: &Arguments) -> Settings {
    Settings {
        window: WindowShape { history: arguments.history, horizon: arguments.horizon, stride: arguments.stride },
        delta_frame: arguments.frame.into(),
        delta_origin: arguments.origin.into(),
        anchor: arguments.anchor.into(),
        input: arguments.input.into(),
        splits: arguments.splits.clone(),
        cameras: arguments.cameras.clone(),
        missing_as_zero: arguments.missing_as_zero,
        resamples: arguments.resamples,
        seed: arguments.seed,
    }
}

/// Beside the predictions, or beside the dataset when there are none.
fn folder(arguments: &Arguments) -> PathBuf {
    if let Some(out) = &arguments.out {
        return out.clone();
    }
    let beside = arguments.predictions.as_deref().map_or(arguments.dataset.as_path(), |path| path);
    let stem = if arguments.predictions.is_some() { beside.file_stem() } else { beside.file_name() };
    let mut name = stem.map_or_else(|| OsString::from("baselines"), OsString::from);
    name.push("-evaluation");
    beside.with_file_name(name)
}

fn write(folder: &Path, reports: &Reports) -> Result<()> {
    let files = [("report.md", &reports.markdown), ("report.json", &reports.json), ("errors.svg", &reports.svg)];
    let files = files.map(|(name, text)| (name.to_owned(), text.as_bytes()));
    cosfly_whole::write_files(folder, &files)
        .map_err(|error| Diagnostic::io(format!("write `{}`", folder.display()), &error))
}
