//! The command line of `cosfly dataset ...`.

use clap::{Args, Subcommand};
use std::path::PathBuf;

/// What to do with finished datasets.
#[derive(Debug, Subcommand)]
pub enum DatasetCommand {
    /// Look for leaks between the splits of one or several datasets, and name the pairs
    #[command(after_help = "\
Examples:
  cosfly dataset lint out/carla_town
  cosfly dataset lint out/Town01 out/Town02_Opt --by-town   no place may be in two splits, whatever it is called

Found are towns with the same ground plan under two names, pedestrians and twins that are apart, walks that repeat each
other, and windows that are the same. Each finding names both flights and both splits; the exit code is then 1.")]
    Lint(LintArguments),
}

/// Arguments of `dataset lint`.
#[derive(Debug, Args)]
pub struct LintArguments {
    /// Folders of finished datasets, which are judged as one
    #[arg(required = true, value_name = "DIR")]
    pub dirs: Vec<PathBuf>,
    /// A place must be in one split only, so that `val` and `test` show unseen towns
    #[arg(long)]
    pub by_town: bool,
    /// Share of a walk that another one may repeat in another split; what the first dataset promises unless given
    #[arg(long, value_name = "SHARE")]
    pub max_route_overlap: Option<f64>,
}
