//! `cosfly export`: a finished dataset in the format of others.

mod format_options;

use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use crate::text::{bytes, count};
use clap::Parser;
use clap::builder::{PossibleValue, PossibleValuesParser};
use cosfly_export::{Choice, FORMATS, on_threads, prepare};
use cosfly_read::PublishedDataset;
use format_options::FormatOptions;
use serde_json::json;
use std::fmt::Write;
use std::path::PathBuf;

/// Write a finished dataset in the format of others
#[derive(Debug, Parser)]
#[command(
    name = "export",
    after_help = "\
Examples:
  cosfly export out/carla_town --format v7 --out out/town-v7
  cosfly export out/carla_town --format v7 --town downtown=Town03 --out out/town-v7
  cosfly export out/carla_town --format coco --split val --every 10 --out out/town-coco
  cosfly export out/carla_town --format vlm --language zh --out out/town-vlm
  cosfly export out/rig --format lerobot --trajectory '*-front_left' --out out/rig-lerobot   films of one camera

The new folder appears when it is whole. Flights are chosen with `--split` and `--trajectory`; without them, all are
exported. An option that the format does not have is refused."
)]
pub struct Arguments {
    /// Folder of the dataset that `cosfly run` delivered
    #[arg(value_name = "DATASET")]
    dir: PathBuf,
    /// The format
    #[arg(long, value_name = "NAME", value_parser = format_names())]
    format: String,
    /// The folder to make; it must not exist yet
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Splits to export (repeatable) [default: all]
    #[arg(long = "split", value_name = "NAME")]
    splits: Vec<String>,
    /// Flights to export, such as expert-p00000 or *-front_left (repeatable) [default: all]
    #[arg(long = "trajectory", value_name = "ID")]
    trajectories: Vec<String>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Number of frames that are written at the same time [default: all cores]
    #[arg(short = 'j', long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    #[command(flatten)]
    options: FormatOptions,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        on_threads(self.jobs, || self.write(console))?
    }
}

impl Arguments {
    fn write(&self, console: &dyn Console) -> Outcome {
        let format = prepare(&self.format, self.options.0.clone())?;
        let dataset = PublishedDataset::open(&self.dir)?;
        let choice = Choice { splits: self.splits.clone(), trajectories: self.trajectories.clone() };
        let progress = console.progress("export", "frames");
        let (written, remarks) = format.write(&dataset, &choice, &self.out, &*progress)?;
        drop(progress);
        if self.json {
            let out = self.out.display().to_string();
            let whole = json!({
                "out": out, "format": format.name, "files": written.files, "bytes": written.bytes, "remarks": remarks,
            });
            console.print(&format!("{whole:#}\n"))?;
            return Ok(exit::SUCCESS);
        }
        let (files, size) = (count(written.files, "file"), bytes(written.bytes));
        let mut text = format!("{}: {files} of {size}, format {}\n", self.out.display(), format.name);
        for remark in remarks {
            let _ = writeln!(text, "  {remark}");
        }
        console.print(&text)?;
        Ok(exit::SUCCESS)
    }
}

fn format_names() -> PossibleValuesParser {
    PossibleValuesParser::new(FORMATS.iter().map(|format| PossibleValue::new(format.name).help(format.doc)))
}
