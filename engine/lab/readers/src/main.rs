//! Measures a reader over a dataset of many tiny flights: wall time, and the peak of memory of this process.
//!
//! `cosfly-lab-readers make DIR --flights 10000` writes the dataset; then each reader in a process of its own, such as
//! `cosfly-lab-readers verify DIR --jobs 2`. Growth is linear when the time per flight stays.

use clap::{Parser, ValueEnum};
use cosfly_diagnose::Result;
use cosfly_read::PublishedDataset;
use cosfly_schema::DatasetConfig;
use cosfly_schema::config::WindowConfig;
use cosfly_verify::Options;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// Measures readers of datasets
#[derive(Debug, Parser)]
struct Arguments {
    /// Reader to measure
    reader: Reader,
    /// Folder of the dataset
    dir: PathBuf,
    /// Flights of the dataset that `make` writes
    #[arg(long, default_value_t = 10_000)]
    flights: usize,
    /// Threads of `verify`
    #[arg(long)]
    jobs: Option<usize>,
    /// Sample of `verify`
    #[arg(long)]
    sample: Option<usize>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Reader {
    Make,
    Open,
    Verify,
    Splits,
    Doctor,
    Preview,
    Export,
    CarlaJob,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let start = Instant::now();
    match measure(&arguments) {
        Ok(flights) => {
            let seconds = start.elapsed().as_secs_f64();
            let per_flight_ms = 1e3 * seconds / flights.max(1) as f64;
            println!(
                "{:?}: {flights} flights, {seconds:.2} s, {per_flight_ms:.3} ms per flight, at most {} MB",
                arguments.reader,
                peak_mb().unwrap_or(0)
            );
            ExitCode::SUCCESS
        }
        Err(refusal) => {
            eprintln!("{refusal}");
            ExitCode::FAILURE
        }
    }
}

/// Runs a reader; returns the number of flights.
fn measure(arguments: &Arguments) -> Result<usize> {
    let dir = &arguments.dir;
    if let Reader::Make = arguments.reader {
        let windows = WindowConfig { size: 4, history: 2, stride: 1 };
        let config = DatasetConfig { windows, frames_per_file: 2_000, ..DatasetConfig::default() };
        cosfly_sample::write_many(dir, &config, arguments.flights)?;
        return Ok(arguments.flights);
    }
    let quiet = &mut |_, _| {};
    match arguments.reader {
        Reader::Verify => {
            let options = Options { jobs: arguments.jobs, sample: arguments.sample, ..Options::default() };
            let report = cosfly_verify::verify(dir, &options, quiet)?;
            report.findings.iter().take(5).for_each(|finding| println!("{finding}"));
            return Ok(report.flights as usize);
        }
        Reader::Doctor => return Ok(cosfly_doctor::examine(dir, &[], quiet)?.episodes),
        Reader::Splits => return splits(dir),
        _ => {}
    }
    let dataset = PublishedDataset::open(dir)?;
    match arguments.reader {
        Reader::Preview => {
            let last = &dataset.flights()[dataset.flights().len() - 1];
            cosfly_preview::draw(&dataset, last, None, quiet)?;
        }
        Reader::Export => export(&dataset)?,
        Reader::CarlaJob => {
            let flights: Vec<_> = dataset.flights().iter().collect();
            cosfly_export::carla_job::write(&dataset, &flights, cosfly_frames::DVec3::ZERO, &mut std::io::sink())?;
        }
        _ => {}
    }
    Ok(dataset.flights().len())
}

/// Facts, groups and leaks of all flights.
fn splits(dir: &Path) -> Result<usize> {
    let facts = cosfly_splits::facts_of_dataset(dir, 0, 0, &Default::default())?;
    let policy = cosfly_splits::policy::SplitPolicy::of_dataset(dir).unwrap_or_else(|reason| panic!("{reason}"));
    let assignment = cosfly_splits::assign(&facts, &policy.splits);
    let mut leaks = cosfly_splits::lint(&facts, &policy.rules());
    leaks.of_windows(&facts, &[dir], policy.windows.shape().size(), &Default::default())?;
    println!("{} leaks, {} groups of flights", leaks.found, assignment.groups.len());
    Ok(facts.len())
}

fn export(dataset: &PublishedDataset) -> Result<()> {
    let choice = cosfly_export::Choice::default();
    let source = cosfly_export::Source::new(dataset, &choice, &|_, _| {})?;
    let mut captions = 0;
    source.each_flight(&mut |episode| {
        captions += episode.captions.len();
        episode.expert_poses().map(drop)?;
        episode.each_picture(&episode.all_frames(), |_, frame| Ok(frame.rgb_file.len()), |_, _| Ok(()))
    })?;
    println!("{captions} captions");
    Ok(())
}

/// Peak of the resident memory of this process, megabytes.
fn peak_mb() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM"))?;
    Some(line.split_whitespace().nth(1)?.parse::<u64>().ok()? / 1024)
}
