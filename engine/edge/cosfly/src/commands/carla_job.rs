//! `cosfly carla-job`: the flights of a dataset as a job for a CARLA server.

use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use crate::text::count;
use clap::Parser;
use cosfly_diagnose::{Diagnostic, Result, plausible};
use cosfly_export::{carla_job, flights_called};
use cosfly_frames::DVec3;
use cosfly_read::{PublishedDataset, PublishedFlight, read};
use cosfly_schema::tables::Bodies;
use std::collections::BTreeSet;
use std::io::BufWriter;
use std::path::PathBuf;

/// Write the job with which `plugins/carla/replay.py` flies a dataset's flights through a CARLA server
#[derive(Debug, Parser)]
#[command(
    name = "carla-job",
    after_help = "\
Examples:
  cosfly carla-job out/Town01 --out job.json
  cosfly carla-job out/Town01 --out job.json --trajectory expert-p00000 --trajectory perturbed-p00000

The job holds poses, walks, weathers and cameras. The script then makes logs with the same topics, whose pictures are the
server's; the map must be one that the server has. Flights of a town from plugins/carla/export_level.py are clear of the
server's own houses; a town from OpenDRIVE alone has none, or its own."
)]
pub struct Arguments {
    /// Folder of the dataset that `cosfly run` delivered
    #[arg(value_name = "DATASET")]
    dir: PathBuf,
    /// The job file
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Flights, such as expert-p00000 (repeatable) [default: all]
    #[arg(long = "trajectory", value_name = "ID")]
    trajectories: Vec<String>,
    /// The `<offset>` in the header of the town's OpenDRIVE file, metres: a server does not add it [default: 0,0,0]
    #[arg(
        long,
        value_name = "X,Y,Z",
        value_delimiter = ',',
        num_args = 3,
        allow_hyphen_values = true,
        value_parser = metres
    )]
    ignore_offset: Option<Vec<f64>>,
}

fn metres(text: &str) -> std::result::Result<f64, String> {
    let number: f64 = text.trim().parse().map_err(|_| "it is not a number".to_owned())?;
    plausible(number).map_err(|fault| format!("it {fault}"))
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        console.print(&written(self)?)?;
        Ok(exit::SUCCESS)
    }
}

fn written(arguments: &Arguments) -> Result<String> {
    let dataset = PublishedDataset::open(&arguments.dir)?;
    let flights: Vec<&PublishedFlight> = if arguments.trajectories.is_empty() {
        dataset.flights().iter().collect()
    } else {
        flights_called(&dataset, &arguments.trajectories)?
    };
    let out = arguments.out.display();
    let failed = |error: std::io::Error| Diagnostic::io(format!("write `{out}`"), &error);
    // A job that was not written to its end never has the name of one.
    let ignored_m = arguments.ignore_offset.as_deref().map_or(DVec3::ZERO, DVec3::from_slice);
    let mut file = BufWriter::new(cosfly_whole::draft(&arguments.out).map_err(failed)?);
    carla_job::write(&dataset, &flights, ignored_m, &mut file)?;
    let file = file.into_inner().map_err(|error| failed(error.into_error()))?;
    file.persist(&arguments.out).map_err(|error| failed(error.error))?;
    let left_out = match others_seen(&dataset, &flights)? {
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

/// Number of other bodies in the pictures of some trajectories, each counted once per trajectory.
fn others_seen(dataset: &PublishedDataset, flights: &[&PublishedFlight]) -> Result<usize> {
    let wanted: BTreeSet<&str> = flights.iter().map(|flight| flight.trajectory_id.as_str()).collect();
    // The rows of a trajectory are together.
    let (mut last, mut seen, mut count) = (String::new(), BTreeSet::new(), 0);
    for (_, path) in dataset.files("bodies")? {
        read(&path, &mut |rows| {
            let (ids, instances) = (rows.values(Bodies::trajectory_id)?, rows.values(Bodies::instance)?);
            let pixels = rows.values(Bodies::visible_pixels)?;
            for row in (0..rows.len()).filter(|row| wanted.contains(ids.text(*row))) {
                if pixels.at(row)? == 0 {
                    continue;
                }
                if ids.text(row) != last {
                    last = ids.text(row).to_owned();
                    seen.clear();
                }
                count += usize::from(seen.insert(instances.at(row)?));
            }
            Ok(())
        })?;
    }
    Ok(count)
}
