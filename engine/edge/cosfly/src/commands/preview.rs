//! `cosfly preview`: pictures of a finished flight.

use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use crate::text::{bytes, count};
use clap::Parser;
use cosfly_diagnose::{Diagnostic, Result, visible_text};
use cosfly_preview::{FlightPictures, FrameList};
use cosfly_read::{PublishedDataset, PublishedFlight};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Draw a finished flight: contact sheet, animated clip, plan of town and paths
#[derive(Debug, Parser)]
#[command(
    name = "preview",
    after_help = "\
Examples:
  cosfly preview out/carla_town                                  its first flight, into out/carla_town-preview
  cosfly preview out/carla_town --trajectory perturbed-p00002
  cosfly preview out/carla_town --frames 0,50,100
  cosfly preview out/carla_town --frames 0..200:10 --out pictures

A range ends before its second number: `0..200:10` is 0, 10, ... 190. Without `--frames`, the sheet shows six frames and
the clip up to a hundred, evenly spread."
)]
pub struct Arguments {
    /// Folder of the dataset that `cosfly run` delivered
    #[arg(value_name = "DATASET")]
    dir: PathBuf,
    /// The flight to draw, such as expert-p00000 [default: the first one]
    #[arg(long, value_name = "ID")]
    trajectory: Option<String>,
    /// Frames to show, such as 0,50,100 or 0..200:10
    #[arg(long, value_name = "LIST")]
    frames: Option<FrameList>,
    /// Folder for the pictures [default: <DATASET>-preview]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let dataset = PublishedDataset::open(&self.dir)?;
        let flight = match &self.trajectory {
            Some(id) => dataset.flight(id)?,
            None => &dataset.flights()[0],
        };
        let progress = console.progress("reading", "frames");
        let pictures =
            cosfly_preview::draw(&dataset, flight, self.frames.as_ref(), &mut |done, all| progress(done, all))?;
        drop(progress);
        let out = self.out.clone().unwrap_or_else(|| beside(&self.dir));
        let note = note_on_others(&out, &dataset);
        let written = write(&out, &dataset, flight, &pictures)?;
        if let Some(note) = note {
            console.tell(&note);
        }
        let text = match self.json {
            true => json(&dataset, flight, &written),
            false => report(&dataset, flight, &pictures, &written),
        };
        console.print(&text)?;
        Ok(exit::SUCCESS)
    }
}

/// The folder beside the dataset's. Inside the dataset, `verify` would find files that do not belong there.
fn beside(dataset: &Path) -> PathBuf {
    let folder = dataset.canonicalize().unwrap_or_else(|_| dataset.to_owned());
    let name = folder.file_name().map_or_else(|| "dataset".into(), |name| name.to_string_lossy().into_owned());
    folder.with_file_name(format!("{name}-preview"))
}

/// Writes the pictures, with a file that says of which dataset they are; returns their paths and sizes.
fn write(
    out: &Path,
    dataset: &PublishedDataset,
    flight: &PublishedFlight,
    pictures: &FlightPictures,
) -> Result<Vec<(PathBuf, u64)>> {
    let refused = |error: std::io::Error| Diagnostic::io(format!("write pictures to `{}`", out.display()), &error);
    let named = |name: &str| format!("{}-{name}", flight.trajectory_id);
    let files = [("sheet.png", &pictures.sheet), ("clip.gif", &pictures.clip), ("plan.png", &pictures.plan)];
    let files = files.map(|(name, file)| (named(name), &file[..]));
    let source = format!("{:#}\n", serde_json::json!({ "dataset": dataset.identity().digest() }));
    let all = [&files[..], &[(SOURCE.to_owned(), source.as_bytes())]].concat();
    cosfly_whole::write_files(out, &all).map_err(refused)?;
    Ok(files.iter().map(|(name, file)| (out.join(name), file.len() as u64)).collect())
}

/// File beside the pictures that says which dataset they are of.
const SOURCE: &str = "preview.json";

/// A note where earlier pictures in the folder are of another dataset.
fn note_on_others(out: &Path, dataset: &PublishedDataset) -> Option<String> {
    let before: serde_json::Value = serde_json::from_slice(&std::fs::read(out.join(SOURCE)).ok()?).ok()?;
    let other = before["dataset"].as_str().filter(|before| *before != dataset.identity().digest())?;
    let other: String = other.chars().take(12).collect();
    Some(format!("note: earlier pictures in `{}` are of another dataset, {}", out.display(), visible_text(&other)))
}

/// The pictures for programs.
fn json(dataset: &PublishedDataset, flight: &PublishedFlight, written: &[(PathBuf, u64)]) -> String {
    let paths: Vec<String> = written.iter().map(|(path, _)| path.display().to_string()).collect();
    let digest = dataset.identity().digest();
    format!("{:#}\n", serde_json::json!({ "dataset": digest, "trajectory": flight.trajectory_id, "files": paths }))
}

fn report(
    dataset: &PublishedDataset,
    flight: &PublishedFlight,
    pictures: &FlightPictures,
    written: &[(PathBuf, u64)],
) -> String {
    let [rows, shots] = pictures.shown.map(|number| count(number as u64, "frame"));
    let about = [
        format!("contact sheet of {rows}: colours, depth, labels, the target enlarged"),
        format!("clip of {shots}"),
        "plan: town, walk, flights coloured by visibility".to_owned(),
    ];
    let here = std::env::current_dir().ok();
    let mut text = format!("{} of {}\n", flight.trajectory_id, dataset.folder().display());
    for ((path, size), about) in written.iter().zip(about) {
        let path = here.as_ref().and_then(|here| path.strip_prefix(here).ok()).unwrap_or(path);
        let _ = writeln!(text, "  {}  {about} ({})", path.display(), bytes(*size));
    }
    let others = dataset.flights().len() - 1;
    if others > 0 {
        let other = dataset.flights().iter().find(|it| *it != flight).map_or("", |it| it.trajectory_id.as_str());
        let _ = writeln!(text, "{} more: `--trajectory {other}`", count(others as u64, "flight"));
    }
    text
}
