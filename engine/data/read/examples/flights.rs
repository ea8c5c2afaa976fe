//! Flights of a dataset with their lengths: `cargo run -p cosfly-read --example flights -- FOLDER`.

use cosfly_read::PublishedDataset;
use std::path::PathBuf;
use std::process::ExitCode;

fn main() -> ExitCode {
    let Some(folder) = std::env::args_os().nth(1).map(PathBuf::from) else {
        eprintln!("usage: flights FOLDER");
        return ExitCode::from(2);
    };
    match PublishedDataset::open(&folder) {
        Ok(dataset) => {
            for flight in dataset.flights() {
                let seconds = flight.frames as f64 * flight.dt_s;
                println!("{}: {} frames, {seconds:.1} s, {}", flight.trajectory_id, flight.frames, flight.split);
            }
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{}: {}", error.code, error.message);
            ExitCode::FAILURE
        }
    }
}
