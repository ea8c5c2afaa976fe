//! `small`: cost of small pictures beside the large renderer.

use super::outcome::{Outcome, print_report};
use clap::Args;
use cosfly_domain::Camera;
use cosfly_lab::small::{SmallOptions, measure};
use std::path::PathBuf;

/// Examples of `small`.
pub const EXAMPLES: &str = "\
Examples:
  cosfly-lab small                         the recipes' town, 50 people around each target, 64 to 224 pixels
  cosfly-lab small --people 0 --size 84    without people, one size
  cosfly-lab small --colours --size 224    colours in both looks, too
  cosfly-lab small --town my.xodr --json   another town, for machines";

/// Arguments of `small`.
#[derive(Args, Debug)]
pub struct SmallArguments {
    /// A map file instead of the town printed by `cosfly town`
    #[arg(long, value_name = "FILE")]
    pub town: Option<PathBuf>,
    /// Sides of the square pictures, pixels; by default 64, 84, 128 and 224 (repeatable)
    #[arg(long = "size", value_name = "N", value_parser = clap::value_parser!(u32).range(8..=1024))]
    pub sizes: Vec<u32>,
    /// People around each target
    #[arg(long, value_name = "N", default_value_t = 50, value_parser = clap::value_parser!(u32).range(0..=10_000))]
    pub people: u32,
    /// Number of viewpoints
    #[arg(long, value_name = "N", default_value_t = 40, value_parser = super::outcome::counts())]
    pub views: usize,
    /// Rounds over all views; the minimum time counts
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = super::outcome::counts())]
    pub rounds: usize,
    /// Measure colours in the simple and the full look, too
    #[arg(long)]
    pub colours: bool,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// Measures and prints.
pub fn small(arguments: &SmallArguments) -> Outcome {
    let camera = Camera { width: 84, height: 84, horizontal_fov_rad: core::f64::consts::FRAC_PI_2 };
    let ground = super::ground::of_town(arguments.town.as_deref(), camera, arguments.views)?;
    let sizes = if arguments.sizes.is_empty() { vec![64, 84, 128, 224] } else { arguments.sizes.clone() };
    let report = measure(&SmallOptions {
        ground,
        sizes,
        people: arguments.people,
        rounds: arguments.rounds,
        has_colours: arguments.colours,
    });
    print_report(&report, arguments.json)
}
