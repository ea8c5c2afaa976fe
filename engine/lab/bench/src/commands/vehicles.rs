//! `vehicles`: how simulated vehicles drive.

use super::outcome::{Outcome, Refusals, print_report};
use clap::Args;
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_domain::Town;
use cosfly_frames::Seed;
use cosfly_lab::vehicles::driving;
use cosfly_maps::{MapConfig, read_town};
use std::path::{Path, PathBuf};

/// Examples of `vehicles`.
pub const EXAMPLES: &str = "\
Examples:
  cosfly-lab vehicles --town recipes/towns/downtown.xodr
  cosfly-lab vehicles --town helsinki.osm.pbf --count 300 --frames 400";

/// Arguments of `vehicles`.
#[derive(Args, Debug)]
pub struct VehiclesArguments {
    /// Map of the town
    #[arg(long, value_name = "FILE")]
    pub town: PathBuf,
    /// Number of vehicles
    #[arg(long, value_name = "N", default_value_t = 100)]
    pub count: u32,
    /// Number of frames
    #[arg(long, value_name = "N", default_value_t = 200)]
    pub frames: u32,
    /// Time between frames, seconds
    #[arg(long, value_name = "S", default_value_t = 0.5)]
    pub frame_s: f64,
    /// Seed of the vehicles
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// Measures and prints the table.
pub fn vehicles(arguments: &VehiclesArguments) -> Outcome {
    if !(0.01..=10.0).contains(&arguments.frame_s) {
        let message = format!("`--frame-s` is {}; it must be from 0.01 to 10", arguments.frame_s);
        return Err(vec![Diagnostic::new("bench-vehicles", Fault::Recipe, message)]);
    }
    let town = town_of(&arguments.town, arguments.seed)?;
    let driving = driving(&town, arguments.count, (arguments.frames, arguments.frame_s), arguments.seed)
        .map_err(|error| refused("bench-vehicles", error))?;
    print_report(&driving, arguments.json)
}

/// The town of a map file, called like the file.
pub fn town_of(path: &Path, seed: u64) -> Result<Town, Refusals> {
    let map =
        std::fs::read(path).map_err(|error| vec![Diagnostic::io(format!("read `{}`", path.display()), &error)])?;
    let read = read_town(&map, &MapConfig::default(), Seed::of_item(seed, "vehicles", "town"));
    let (mut town, ..) = read.map_err(|error| refused("bench-town", error))?;
    town.name = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or("town").to_owned();
    Ok(town)
}

fn refused(code: &'static str, error: impl ToString) -> Refusals {
    vec![Diagnostic::new(code, Fault::Input, error.to_string())]
}
