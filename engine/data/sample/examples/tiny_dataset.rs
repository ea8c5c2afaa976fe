//! Writes a tiny dataset into the folder given as the first argument, for tests of independent readers.

use cosfly_sample as sample;
use cosfly_schema::{DatasetConfig, EncodingConfig};
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let Some(folder) = std::env::args_os().nth(1) else {
        eprintln!("usage: tiny_dataset FOLDER");
        return ExitCode::FAILURE;
    };
    match sample::write_to_folder(Path::new(&folder), &DatasetConfig::default(), EncodingConfig::default()) {
        Ok(summary) => {
            println!("{} flights, {} frames", summary.flights(), summary.frames);
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
