//! `cosfly carla-job`: the flights of a dataset as a job for a CARLA server.

use super::Outcome;
use crate::arguments::CarlaJobArguments;
use crate::exit;
use crate::text::count;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_export::carla_job::CarlaJob;
use cosfly_read::{PublishedDataset, PublishedFlight};

/// Writes the job file and says how to fly it.
pub fn carla_job(arguments: &CarlaJobArguments) -> Outcome {
    crate::print(&written(arguments).map_err(|refusal| vec![refusal])?)?;
    Ok(exit::SUCCESS)
}

fn written(arguments: &CarlaJobArguments) -> Result<String> {
    let dataset = PublishedDataset::open(&arguments.dir)?;
    let flights: Vec<&PublishedFlight> = if arguments.trajectories.is_empty() {
        dataset.flights().iter().collect()
    } else {
        arguments.trajectories.iter().map(|id| dataset.flight(id)).collect::<Result<_>>()?
    };
    let job = CarlaJob::new(&dataset, &flights)?.to_json();
    let out = arguments.out.display();
    std::fs::write(&arguments.out, &job).map_err(|error| Diagnostic::io(format!("write `{out}`"), &error))?;
    let left_out = match dataset.others_seen(&flights)? {
        0 => String::new(),
        seen => format!(
            "left out: {} beside the targets; the server shows the targets alone\n",
            count(seen as u64, "walker")
        ),
    };
    let frames: usize = flights.iter().map(|flight| flight.frames).sum();
    Ok(format!(
        "{out}: {} with {}\n{left_out}beside a running CARLA server:\n  python plugins/carla/replay.py {out} {} --out DIR\n",
        count(flights.len() as u64, "flight"),
        count(frames as u64, "frame"),
        arguments.dir.display()
    ))
}
