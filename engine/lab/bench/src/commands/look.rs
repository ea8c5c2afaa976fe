//! `look`: statistics of pictures beside those of real ones.

use super::outcome::{Outcome, print_report};
use clap::Args;
use cosfly_domain::Season;
use cosfly_lab::look::{LookReport, of_folder, of_town};
use cosfly_lab::render::views::Ground;
use cosfly_render::RenderConfig;
use std::path::PathBuf;

/// Default weathers.
const WEATHERS: [&str; 5] = ["ClearNoon", "ClearSunset", "HardRainNoon", "ClearNight", "DustStorm"];

/// Examples of `look`.
pub const EXAMPLES: &str = "\
Examples:
  cosfly-lab look                            the recipes' town at noon, sunset, in rain, at night and in dust
  cosfly-lab look --pictures stanford-drone  beside a folder of JPEG or PNG pictures (repeatable)
  cosfly-lab look --town my.xodr --views 40  another town
  cosfly-lab look --down 60 --fov 45         straight down from 60 m, as surveys and the Stanford drone look
  cosfly-lab look --season winter            bare trees and pale lawns";

/// Arguments of `look`.
#[derive(Args, Debug)]
pub struct LookArguments {
    /// A map file instead of the town printed by `cosfly town`
    #[arg(long, value_name = "FILE")]
    pub town: Option<PathBuf>,
    /// Weather presets (repeatable)
    #[arg(long = "weather", value_name = "PRESET")]
    pub weathers: Vec<String>,
    /// Season of trees and lawns: `summer`, `autumn` or `winter`; the town's own by default
    #[arg(long, value_name = "SEASON", value_parser = super::ground::season)]
    pub season: Option<Season>,
    /// Folders of pictures to compare with (repeatable)
    #[arg(long = "pictures", value_name = "FOLDER")]
    pub pictures: Vec<PathBuf>,
    /// Number of viewpoints
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = super::outcome::counts())]
    pub views: usize,
    /// Horizontal field of view, degrees; 90 by default
    #[arg(long, value_name = "DEGREES", value_parser = clap::value_parser!(u8).range(5..=150))]
    pub fov: Option<u8>,
    /// Look straight down from this height over the target, metres
    #[arg(long, value_name = "METRES", value_parser = clap::value_parser!(u16).range(2..=1000))]
    pub down: Option<u16>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// Measures and prints.
pub fn look(arguments: &LookArguments) -> Outcome {
    let mut camera = RenderConfig::default().camera();
    camera.horizontal_fov_rad = arguments.fov.map_or(camera.horizontal_fov_rad, |fov| f64::from(fov).to_radians());
    let ground = super::ground::of_town(arguments.town.as_deref(), camera, arguments.views)?;
    let mut ground = arguments.down.map(f64::from).into_iter().fold(ground, Ground::from_above);
    ground.scene = ground.scene.in_season(arguments.season);
    let weathers = super::ground::weathers(&arguments.weathers, &WEATHERS)?;
    let mut rows: Vec<_> = weathers.iter().map(|weather| of_town(&ground, weather)).collect();
    for folder in &arguments.pictures {
        rows.push(of_folder(folder).map_err(|refusal| vec![refusal])?);
    }
    let report = LookReport { rows };
    print_report(&report, arguments.json)
}
