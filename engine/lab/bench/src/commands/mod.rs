//! The command line of the lab: one file per measurement.

mod engine;
mod geometry;
mod outcome;
mod planner;
mod render;
mod town_of_recipe;

use clap::{Parser, Subcommand};
use outcome::Outcome;

/// Measurements of cosfly beside its rivals.
#[derive(Debug, Parser)]
#[command(name = "cosfly-lab", version, about, max_term_width = 100)]
pub struct Arguments {
    /// The measurement
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// The engine with cheap items: cold overhead, everything cached, one parameter changed and changed back
    Engine(engine::EngineArguments),
    /// Box queries of our tree, of parry's and obvhs's trees and of a plain loop, per second on one core
    #[command(after_help = geometry::EXAMPLES)]
    Geometry(geometry::GeometryArguments),
    /// Planners against each other on the same paths: visibility, distance, length, time, nodes, clearance, limits
    #[command(after_help = planner::EXAMPLES)]
    Planner(planner::PlannerArguments),
    /// The renderer: CPU time of a frame by stage, frames per second as finished logs, distance to the memory's limits
    #[command(after_help = render::EXAMPLES)]
    Render(render::RenderArguments),
}

impl Arguments {
    /// Runs the measurement and prints its table.
    pub fn run(&self) -> Outcome {
        match &self.command {
            Command::Engine(arguments) => engine::engine(arguments),
            Command::Geometry(arguments) => geometry::geometry(arguments),
            Command::Planner(arguments) => planner::planner(arguments),
            Command::Render(arguments) => render::render(arguments),
        }
    }
}
