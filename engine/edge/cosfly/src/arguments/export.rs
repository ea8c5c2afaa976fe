//! Commands that hand a finished dataset to others: `export`, `carla-job`.

use super::{FrameChoice, RoleChoice, counts};
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Examples of `export`.
pub(super) const EXPORT_HELP: &str = "\
Examples:
  cosfly export out/carla_town --format v7 --out out/town-v7
  cosfly export out/carla_town --format v7 --town downtown=Town03 --out out/town-v7
  cosfly export out/carla_town --format coco --split val --every 10 --out out/town-coco
  cosfly export out/carla_town --format vlm --language zh --out out/town-vlm

The new folder appears when it is whole. Flights are chosen with `--split` and `--trajectory`; without them, all are
exported.";

/// Arguments of `export`.
#[derive(Args, Debug)]
pub struct ExportArguments {
    /// Folder of the dataset that `cosfly run` delivered
    #[arg(value_name = "DATASET")]
    pub dir: PathBuf,
    /// The format
    #[arg(long, value_name = "NAME", value_parser = format_names())]
    pub format: String,
    /// The folder to make; it must not be there yet
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Splits to export (repeatable) [default: all]
    #[arg(long = "split", value_name = "NAME")]
    pub splits: Vec<String>,
    /// Flights to export, such as expert-p00000 (repeatable) [default: all]
    #[arg(long = "trajectory", value_name = "ID")]
    pub trajectories: Vec<String>,
    /// Every how many frames there is a picture; coco, webdataset, imagefolder
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = counts())]
    pub every: usize,
    /// Language of instructions; all but v7, which has them in all, and coco, which has none
    #[arg(long, value_name = "CODE", default_value = "en", value_parser = ["en", "zh"])]
    pub language: String,
    /// Axes of increments: those of the world, or of the body that moves (x ahead, y right, z up); vlm, lerobot
    #[arg(long, value_enum, default_value_t = FrameChoice::World)]
    pub frame: FrameChoice,
    /// Flights that models see; vlm
    #[arg(long, value_enum, default_value_t = RoleChoice::Perturbed)]
    pub input: RoleChoice,
    /// Frames that a model sees; vlm
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = counts())]
    pub history: usize,
    /// Waypoints that it predicts; vlm
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = counts())]
    pub horizon: usize,
    /// Frames from one window to the next; vlm
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = counts())]
    pub stride: usize,
    /// Scale of boxes in texts: pixels, or thousandths of width and height; vlm
    #[arg(long, value_enum, default_value_t = BoxScaleChoice::Pixels)]
    pub box_scale: BoxScaleChoice,
    /// Size from which on a new file begins, MB; webdataset
    #[arg(long, value_name = "MB", default_value_t = 300, value_parser = counts())]
    pub shard_size: usize,
    /// v7: a name of CARLA for a town of another name, such as downtown=Town01 (repeatable)
    #[arg(long = "town", value_name = "TOWN=NAME", value_parser = town_name)]
    pub towns: Vec<(String, String)>,
}

/// Scale of boxes in texts.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum BoxScaleChoice {
    /// Pixels of the pictures
    Pixels,
    /// Thousandths of width and height
    Thousandths,
}

fn format_names() -> PossibleValuesParser {
    let formats = cosfly_export::EXPORTERS;
    PossibleValuesParser::new(formats.map(|format| PossibleValue::new(format.name()).help(format.about())))
}

fn town_name(text: &str) -> Result<(String, String), String> {
    let names = text.split_once('=').filter(|(town, name)| !town.is_empty() && !name.is_empty());
    let names = names.map(|(town, name)| (town.to_owned(), name.to_owned()));
    names.ok_or_else(|| "it must be a town of the dataset and a name for it, such as downtown=Town01".to_owned())
}

/// Arguments of `carla-job`.
#[derive(Args, Debug)]
pub struct CarlaJobArguments {
    /// Folder of the dataset that `cosfly run` delivered
    #[arg(value_name = "DATASET")]
    pub dir: PathBuf,
    /// The job file
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// Flights, such as expert-p00000 (repeatable) [default: all]
    #[arg(long = "trajectory", value_name = "ID")]
    pub trajectories: Vec<String>,
}
