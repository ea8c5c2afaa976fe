//! The lab's binary: `cosfly-lab planner | people | render | geometry | engine | cluster`.

mod commands;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    match commands::Arguments::parse().run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(refusals) => {
            eprintln!("{}", cosfly_diagnose::render_all(refusals.iter().map(|refusal| &**refusal), false));
            ExitCode::FAILURE
        }
    }
}
