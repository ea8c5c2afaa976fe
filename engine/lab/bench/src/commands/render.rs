//! `render`: cost of pictures by stage, and throughput of finished logs.

use super::outcome::{Outcome, Refusals, print_report};
use clap::Args;
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_domain::Camera;
use cosfly_lab::render::views::Ground;
use cosfly_lab::render::{RenderOptions, measure};
use cosfly_render::RenderConfig;
use cosfly_schema::EncodingConfig;
use std::path::PathBuf;

/// Default weathers: clear noon, hard rain, night.
const WEATHERS: [&str; 3] = ["ClearNoon", "HardRainNoon", "ClearNight"];

/// Examples of `render`.
pub const EXAMPLES: &str = "\
Examples:
  cosfly-lab render                                        the recipes' town and one of 2,000 boxes, 1280 x 720
  cosfly-lab render --json                                 the same for machines
  cosfly-lab render --weather ClearSunset --rounds 3       another weather, less noise
  cosfly-lab render --width 3840 --height 2160 --views 4   4K
  cosfly-lab render --town my.xodr                         another town";

/// Arguments of `render`.
#[derive(Args, Debug)]
pub struct RenderArguments {
    /// An OpenDRIVE town instead of the one printed by `cosfly town`
    #[arg(long, value_name = "FILE")]
    pub town: Option<PathBuf>,
    /// Weather presets; by default ClearNoon, HardRainNoon and ClearNight (repeatable)
    #[arg(long = "weather", value_name = "PRESET")]
    pub weathers: Vec<String>,
    /// Width of the images, pixels
    #[arg(long, value_name = "N", default_value_t = 1280)]
    pub width: u32,
    /// Height of the images, pixels
    #[arg(long, value_name = "N", default_value_t = 720)]
    pub height: u32,
    /// Number of viewpoints per town
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = super::outcome::counts())]
    pub views: usize,
    /// Number of boxes of the second town
    #[arg(long, value_name = "N", default_value_t = 2000, value_parser = super::outcome::counts())]
    pub box_count: usize,
    /// Rounds over all views; the minimum time counts
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = super::outcome::counts())]
    pub rounds: usize,
    /// Frames of the flights that are drawn, encoded and written on all threads at once
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = super::outcome::counts())]
    pub frames: usize,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// Measures.
pub fn render(arguments: &RenderArguments) -> Outcome {
    let camera = camera(arguments)?;
    let scratch = std::env::current_dir()
        .and_then(tempfile::tempdir_in)
        .map_err(|error| vec![Diagnostic::io("make a scratch folder here", &error)])?;
    let report = measure(&RenderOptions {
        grounds: grounds(arguments, camera)?,
        weathers: super::ground::weathers(&arguments.weathers, &WEATHERS)?,
        rounds: arguments.rounds,
        encoding: EncodingConfig::default(),
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        flight_frames: arguments.frames,
        scratch: scratch.path(),
    })
    .map_err(|refusal| vec![refusal])?;
    print_report(&report, arguments.json)
}

fn camera(arguments: &RenderArguments) -> Result<Camera, Refusals> {
    let config = RenderConfig { width: arguments.width, height: arguments.height, ..RenderConfig::default() };
    let refused =
        |message: String, hint: String| vec![Diagnostic::new("bench-parameters", Fault::Recipe, message).hint(hint)];
    config.validate().map_err(|problem| refused(problem.message, problem.hint))?;
    Ok(config.camera())
}

fn grounds(arguments: &RenderArguments, camera: Camera) -> Result<Vec<Ground>, Refusals> {
    let town = super::ground::of_town(arguments.town.as_deref(), camera, arguments.views)?;
    Ok(vec![town, Ground::of_boxes(arguments.box_count, camera, arguments.views)])
}
