//! `cosfly town`: a generated OpenDRIVE town.

use super::Outcome;
use crate::arguments::TownArguments;
use crate::exit;
use cosfly_maps::generate::{GenerateConfig, generate_town};

/// Prints the town.
pub fn town(arguments: &TownArguments) -> Outcome {
    crate::print(&generate_town(&GenerateConfig::default(), arguments.seed))?;
    Ok(exit::SUCCESS)
}
