//! `simplify`: boxes for planning by tolerance, of a generated town or of a map file.

use super::outcome::{Outcome, print_report};
use clap::Args;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_domain::OrientedBox;
use cosfly_frames::Seed;
use cosfly_lab::simplify::{fine_boxes, simplify_table};
use cosfly_maps::{MapConfig, read_town};
use std::path::PathBuf;

/// Examples of `simplify`.
pub const EXAMPLES: &str = "\
Examples:
  cosfly-lab simplify                  some 65,000 boxes of a generated town
  cosfly-lab simplify --map tile.laz   the boxes of a map file
  cosfly-lab simplify --json           for programs";

/// Arguments of `simplify`.
#[derive(Args, Debug)]
pub struct SimplifyArguments {
    /// A map file of any known format, in place of the generated town
    #[arg(long, value_name = "FILE")]
    pub map: Option<PathBuf>,
    /// Seed of the generated town
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// Measures and prints the table.
pub fn simplify(arguments: &SimplifyArguments) -> Outcome {
    let boxes = arguments
        .map
        .as_ref()
        .map_or_else(|| Ok(fine_boxes(arguments.seed)), boxes_of_map)
        .map_err(|error| vec![error])?;
    let table = simplify_table(&boxes);
    print_report(&table, arguments.json)
}

fn boxes_of_map(path: &PathBuf) -> Result<Vec<OrientedBox>> {
    let refused = |error: &dyn std::fmt::Display| {
        let error = std::io::Error::other(error.to_string());
        Diagnostic::io(format!("read the map `{}`", path.display()), &error)
    };
    let bytes = std::fs::read(path).map_err(|error| refused(&error))?;
    let seed = Seed::of_item(1, "town", "town");
    let (town, _) = read_town(&bytes, &MapConfig::default(), seed).map_err(|error| refused(&error.message))?;
    Ok(town.obstacles.iter().map(|one| one.shape).collect())
}
