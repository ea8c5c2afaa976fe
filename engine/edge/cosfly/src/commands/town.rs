//! `cosfly town`: a generated OpenDRIVE town.

use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use clap::Parser;
use cosfly_maps::generate::{GenerateConfig, generate_town};

/// Print a generated OpenDRIVE town
#[derive(Debug, Parser)]
#[command(name = "town", after_help = "Example:\n  cosfly town --seed 7 > my_town.xodr")]
pub struct Arguments {
    /// Seed; every seed is another town
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        console.print(&generate_town(&GenerateConfig::default(), self.seed))?;
        Ok(exit::SUCCESS)
    }
}
