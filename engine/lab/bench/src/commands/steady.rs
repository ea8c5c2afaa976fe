//! `steady`: pixels that pop in clips of a slowly moving camera.

use super::outcome::{Outcome, print_report};
use clap::Args;
use cosfly_domain::{Camera, Season};
use cosfly_frames::Pose;
use cosfly_lab::look::{SteadyReport, of_clips};
use cosfly_render::PictureLook;
use std::path::PathBuf;

/// Default weathers: without rain, whose drops fall anew in each frame.
const WEATHERS: [&str; 3] = ["ClearNoon", "ClearSunset", "ClearNight"];

/// Examples of `steady`.
pub const EXAMPLES: &str = "\
Examples:
  cosfly-lab steady                             the recipes' town at noon, sunset and night
  cosfly-lab steady --step-m 0.4 --frames 100   a quicker and longer clip
  cosfly-lab steady --town my.xodr --views 6    another town, more clips
  cosfly-lab steady --season winter             bare trees";

/// Arguments of `steady`.
#[derive(Args, Debug)]
pub struct SteadyArguments {
    /// A map file instead of the town printed by `cosfly town`
    #[arg(long, value_name = "FILE")]
    pub town: Option<PathBuf>,
    /// Weather presets (repeatable)
    #[arg(long = "weather", value_name = "PRESET")]
    pub weathers: Vec<String>,
    /// Season of trees and lawns: `summer`, `autumn` or `winter`; the town's own by default
    #[arg(long, value_name = "SEASON", value_parser = super::ground::season)]
    pub season: Option<Season>,
    /// Number of clips
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = super::outcome::counts())]
    pub views: usize,
    /// Number of frames of each clip
    #[arg(long, value_name = "N", default_value_t = 30, value_parser = super::outcome::counts())]
    pub frames: usize,
    /// Way of the camera between two frames, metres
    #[arg(long, value_name = "METRES", default_value_t = 0.1)]
    pub step_m: f64,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// Measures and prints.
pub fn steady(arguments: &SteadyArguments) -> Outcome {
    let camera = Camera { width: 1280, height: 720, horizontal_fov_rad: 90f64.to_radians() };
    let mut ground = super::ground::of_town(arguments.town.as_deref(), camera, arguments.views)?;
    ground.scene = ground.scene.in_season(arguments.season);
    let starts: Vec<Pose> = ground.views.iter().map(|view| view.pose).collect();
    let clip = (arguments.frames, arguments.step_m);
    let mut rows = vec![];
    for weather in super::ground::weathers(&arguments.weathers, &WEATHERS)? {
        rows.extend(of_clips(&ground.name, &ground.scene, (camera, PictureLook::Full), &weather, &starts, clip));
    }
    let report = SteadyReport { rows };
    print_report(&report, arguments.json)
}
