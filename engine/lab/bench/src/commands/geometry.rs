//! `geometry`: box queries compared with other libraries.

use super::outcome::{Outcome, print_report};
use clap::Args;

/// Examples of `geometry`.
pub const EXAMPLES: &str = "\
Examples:
  cosfly-lab geometry           50, 200, 2,000 and 65,000 boxes of generated towns (a minute or two)
  cosfly-lab geometry --seed 7  other towns and rays
  cosfly-lab geometry --json    for programs";

/// Arguments of `geometry`.
#[derive(Args, Debug)]
pub struct GeometryArguments {
    /// Seed of the towns and rays
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// Measures and prints the table.
pub fn geometry(arguments: &GeometryArguments) -> Outcome {
    print_report(&cosfly_lab::geometry::geometry(arguments.seed), arguments.json)
}
