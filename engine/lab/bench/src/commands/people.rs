//! `people`: simulated people beside recorded ones.

use super::outcome::{Outcome, Refusals, print_report};
use clap::Args;
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_frames::Seed;
use cosfly_lab::people::{Figures, PeopleTable, Tracks, crowded, density};
use cosfly_maps::{MapConfig, read_town};
use cosfly_pedestrians::{CrowdConfig, PedestrianError, RecordedConfig, Recording};
use std::path::{Path, PathBuf};

/// Examples of `people`.
pub const EXAMPLES: &str = "\
Examples:
  cosfly-lab people --town recipes/towns/downtown.xodr                   300 people for 100 s
  cosfly-lab people --town recipes/towns/downtown.xodr zara01/obsmat.txt beside recorded people
  cosfly-lab people --town recipes/towns/downtown.xodr --count 1000      cost of a thousand people";

/// Arguments of `people`.
#[derive(Args, Debug)]
pub struct PeopleArguments {
    /// Recorded people: `obsmat` or CSV files in metres
    #[arg(value_name = "FILE")]
    pub recorded: Vec<PathBuf>,
    /// Map of the town, which is filled in with houses and trees
    #[arg(long, value_name = "FILE")]
    pub town: PathBuf,
    /// Number of simulated people
    #[arg(long, value_name = "N", default_value_t = 300)]
    pub count: u32,
    /// Frames of half a second
    #[arg(long, value_name = "N", default_value_t = 200)]
    pub frames: u32,
    /// Seed of town and people
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Leave out the measurement of speed by density
    #[arg(long)]
    pub without_density: bool,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// Measures and prints the table.
pub fn people(arguments: &PeopleArguments) -> Outcome {
    let mut sets = vec![];
    for path in &arguments.recorded {
        let bytes = read(path)?;
        let recording = Recording::read(&bytes, &RecordedConfig::default()).map_err(|error| {
            vec![
                Diagnostic::new("bench-tracks", Fault::Input, format!("`{}`: {error}", path.display()))
                    .hint(error.hint),
            ]
        })?;
        sets.push(Figures::of(&Tracks::of_recording(&name_of(path), &recording)));
    }
    let mut config = MapConfig::default();
    (config.fill.buildings, config.fill.trees) = (true, true);
    let read = read_town(&read(&arguments.town)?, &config, Seed::of_item(arguments.seed, "people", "town"));
    let (town, ..) = read.map_err(|error| vec![Diagnostic::new("bench-town", Fault::Input, error.to_string())])?;
    let config = CrowdConfig { count: arguments.count, ..CrowdConfig::default() };
    let (crowd, tracks) = crowded(&town, &config, arguments.frames, arguments.seed).map_err(refused)?;
    sets.push(Figures::of(&tracks));
    let density = if arguments.without_density { vec![] } else { density(arguments.seed).map_err(refused)? };
    let table = PeopleTable { sets, crowds: vec![crowd], density };
    print_report(&table, arguments.json)
}

fn read(path: &Path) -> Result<Vec<u8>, Refusals> {
    std::fs::read(path).map_err(|error| vec![Diagnostic::io(format!("read `{}`", path.display()), &error)])
}

/// Folder and file of a set are its name: all files of one publisher have the same name.
fn name_of(path: &Path) -> String {
    let part = |name: Option<&std::ffi::OsStr>| name.map(|name| name.to_string_lossy().into_owned());
    part(path.parent().and_then(Path::file_name)).or_else(|| part(path.file_stem())).unwrap_or_default()
}

fn refused(error: PedestrianError) -> Refusals {
    vec![Diagnostic::new("bench-people", Fault::Input, error.to_string()).hint(error.hint())]
}
