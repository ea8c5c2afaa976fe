//! The `cosfly` command: arguments, progress, exit codes. The only code that prints or reads the environment.

mod arguments;
mod commands;
mod exit;
mod interrupt;
mod reporter;
mod text;

use arguments::{Arguments, BenchCommand, Command, TaskCommand};
use clap::Parser;
use cosfly_frames::simd::Level;
use std::io::Write;
use std::process::ExitCode;

fn main() -> ExitCode {
    if let Err(message) = choose_vector_level() {
        eprintln!("error: {message}");
        return ExitCode::from(exit::ARGUMENTS);
    }
    let outcome = match Arguments::parse().command {
        Command::Run(arguments) => commands::run::run(&arguments),
        Command::Plan(arguments) => commands::plan::plan(&arguments),
        Command::PlanFrom(arguments) => commands::plan_from::plan_from(&arguments),
        Command::Why(arguments) => commands::why::why(&arguments),
        Command::Graph(arguments) => commands::graph::graph(&arguments),
        Command::Verify(arguments) => commands::verify::verify(&arguments),
        Command::Preview(arguments) => commands::preview::preview(&arguments),
        Command::Gc(arguments) => commands::collect::collect(&arguments),
        Command::Schema(arguments) => commands::schema::schema(&arguments),
        Command::Town(arguments) => commands::town::town(&arguments),
        Command::Bench(BenchCommand::Engine { items }) => commands::bench::engine(items),
        Command::Bench(BenchCommand::Geometry { seed, json }) => commands::bench::geometry(seed, json),
        Command::Bench(BenchCommand::Planner(arguments)) => commands::bench_planner::planner(&arguments),
        Command::Task(TaskCommand::Run { digest, store }) => commands::task::run(&digest, &store),
    };
    match outcome {
        Ok(code) => ExitCode::from(code),
        Err(refusals) => {
            let all = refusals.iter().map(|refusal| &**refusal);
            eprintln!("{}", cosfly_diagnose::render_all(all, reporter::colour()));
            exit::code_of_all(&refusals)
        }
    }
}

/// Everything gives the same bytes with every vector level; `COSFLY_SIMD` chooses one to see that.
fn choose_vector_level() -> Result<(), String> {
    let Ok(name) = std::env::var("COSFLY_SIMD") else { return Ok(()) };
    let available = Level::available();
    let Some(level) = available.iter().find(|level| level.name() == name) else {
        let names: Vec<_> = available.iter().map(|level| level.name()).collect();
        return Err(format!("COSFLY_SIMD is `{name}`; this processor has {}", names.join(", ")));
    };
    level.make_best();
    Ok(())
}

/// Prints to standard output; a reader that went away (`| head`) is no error.
fn print(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}
