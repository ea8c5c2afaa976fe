//! The command line of the lab: one file per measurement.

mod engine;
mod geometry;
mod planner;
mod render;
mod town_of_recipe;

use clap::builder::TypedValueParser;
use clap::{Parser, Subcommand};
use cosfly_diagnose::Diagnostic;
use std::io::{ErrorKind, Write};

/// Everything that can be wrong with a measurement's parameters, at least one.
pub type Refusals = Vec<Box<Diagnostic>>;

/// The end of a measurement.
pub type Outcome = Result<(), Refusals>;

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

/// Prints to standard output; a reader that went away (`| head`) is no error.
fn print(text: &str) -> Outcome {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(vec![Diagnostic::io("write to standard output", &error)])
        }
        Ok(()) | Err(_) => Ok(()),
    }
}

/// A number from 1 to a million.
fn counts() -> impl TypedValueParser<Value = usize> {
    clap::value_parser!(u64).range(1..=1_000_000).map(|count| count as usize)
}
