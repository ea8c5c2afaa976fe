//! `cosfly verify`: checks a finished dataset.

mod regenerate;

use crate::arguments::{RecipeArguments, StoreArguments};
use crate::command::{Command, Outcome, Refusals};
use crate::commands::scanned_mesh::MeshArguments;
use crate::console::Console;
use crate::exit;
use crate::text::{bytes, count};
use clap::Parser;
use cosfly_read::Identity;
use cosfly_recipe::Recipe;
use cosfly_verify::{Options, VerifyReport};
use regenerate::{recipe_of_version, regenerated};
use serde_json::json;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Check a finished dataset: hashes, counts, CRCs, schemas, reprojection, action and pose
#[derive(Debug, Parser)]
#[command(
    name = "verify",
    after_help = "\
Examples:
  cosfly verify out/carla_town
  cosfly verify /data/large --sample 500             some flights in full, all tables, sizes of all logs
  cosfly verify /data/large --resume large.notes     goes on where an interrupted check ended
  cosfly verify out/street --mesh street.glb         clearance from the triangles of the scan
  cosfly verify out/carla_town --regenerate 2 --recipe recipes/carla_town.toml

Exits with 1 when something is wrong."
)]
pub struct Arguments {
    /// Folder of the dataset
    #[arg(value_name = "DATASET")]
    dir: PathBuf,
    /// Number of flights that are checked in full; of other logs only the sizes
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    sample: Option<u32>,
    /// File with notes of the flights found sound: written while checking, read by the next check
    #[arg(long, value_name = "FILE")]
    resume: Option<PathBuf>,
    /// Number of threads [default: all cores]
    #[arg(short = 'j', long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Number of flights to make again from the recipe, in an empty store, and to compare byte by byte
    #[arg(long, value_name = "N")]
    regenerate: Option<u16>,
    /// The recipe for `--regenerate`, or a folder with a recipe.toml [default: that of the named version that has these files]
    #[arg(long, value_name = "RECIPE", requires = "regenerate")]
    recipe: Option<PathBuf>,
    /// Change a value of the recipe (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE", requires = "recipe")]
    overrides: Vec<String>,
    #[command(flatten)]
    mesh: MeshArguments,
    #[command(flatten)]
    store: StoreArguments,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let progress = console.progress("verify", "flights");
        let options = Options {
            jobs: self.jobs.map(usize::from),
            sample: self.sample.map(|sample| sample as usize),
            resume: self.resume.clone(),
            mesh: self.mesh.read(&self.dir)?.map(Arc::new),
            stop: console.stop(),
        };
        let report = cosfly_verify::verify(&self.dir, &options, &mut |done, all| progress(done, all))?;
        drop(progress);
        let mut text = told(&report);
        let (mut wrong, mut regenerated_flights) = (0, None);
        if let Some(number) = self.regenerate {
            let (more, found) = regenerated(&self.dir, usize::from(number), &self.recipe(console)?, console)?;
            text += &more;
            wrong = found;
            regenerated_flights = Some(more);
        }
        console.print(&if self.json { json(&self.dir, &report, regenerated_flights, wrong) } else { text })?;
        Ok(if report.is_sound() && wrong == 0 { exit::SUCCESS } else { exit::FOUND_PROBLEMS })
    }
}

impl Arguments {
    /// The given recipe, else that of the named version.
    fn recipe(&self, console: &dyn Console) -> Result<Recipe, Refusals> {
        match self.recipe.clone() {
            Some(recipe) => RecipeArguments { recipe, overrides: self.overrides.clone() }.load(console),
            None => recipe_of_version(&self.dir, &self.store.with_versions()?),
        }
    }
}

/// The report for programs.
fn json(dir: &Path, report: &VerifyReport, regenerated: Option<String>, wrong: usize) -> String {
    let findings: Vec<String> = report.findings.iter().map(ToString::to_string).collect();
    let whole = json!({
        "dataset": Identity::of(dir).digest(),
        "sound": report.is_sound() && wrong == 0,
        "found": report.found, "findings": findings,
        "sample": report.sample, "flights_of_dataset": report.flights_of_dataset, "resumed": report.resumed,
        "files": report.files, "bytes": report.bytes, "flights": report.flights, "frames": report.frames,
        "target_boxes": report.boxes, "visibility_labels": report.labels, "visibility_gaps": report.gaps,
        "flights_by_mesh": report.meshed, "regenerated": regenerated, "regenerated_wrong": wrong,
    });
    format!("{whole:#}\n")
}

/// One line per finding, the size of the dataset, and a verdict.
fn told(report: &VerifyReport) -> String {
    let mut text = String::new();
    for finding in &report.findings {
        let _ = writeln!(text, "{finding}");
    }
    let hidden = report.found - report.findings.len() as u64;
    if hidden > 0 {
        let _ = writeln!(text, "... and {hidden} more");
    }
    let _ = writeln!(
        text,
        "checked {} of {}, {} with {}, {}",
        count(report.files, "file"),
        bytes(report.bytes),
        count(report.flights, "flight"),
        count(report.frames, "frame"),
        count(report.boxes, "target box").replace("boxs", "boxes"),
    );
    if report.labels > 0 {
        let _ = writeln!(
            text,
            "visible shares by rays and by pixels agree within 5 points in {} of {}{}",
            report.labels - report.gaps,
            count(report.labels, "frame"),
            if report.gaps > 0 { "; not in these:" } else { "" }
        );
    }
    for gap in &report.label_gaps {
        let _ = writeln!(text, "  {gap}");
    }
    let hidden = report.gaps - report.label_gaps.len() as u64;
    if hidden > 0 {
        let _ = writeln!(text, "  ... and {hidden} more");
    }
    if report.meshed > 0 {
        let flights = count(report.meshed, "flight");
        let _ = writeln!(text, "{flights} held against the mesh: those of its town whose certificate holds");
    }
    if report.resumed > 0 {
        let _ = writeln!(text, "{} of these were found sound by an earlier check", count(report.resumed, "flight"));
    }
    if let Some(sample) = report.sample {
        let others = report.flights_of_dataset - sample;
        let _ = writeln!(
            text,
            "a sample: {} of {} in full, with all tables; of {} only the size",
            sample,
            count(report.flights_of_dataset, "flight"),
            count(others, "other log"),
        );
    }
    let _ = match report.found {
        0 if report.sample.is_some() => writeln!(text, "nothing wrong was found in the sample"),
        0 => writeln!(text, "nothing wrong was found"),
        found => writeln!(text, "{} found", count(found, "problem")),
    };
    text
}
