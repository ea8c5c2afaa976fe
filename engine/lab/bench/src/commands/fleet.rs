//! `fleet`: a simulation of many trajectories on many workers.

use super::outcome::{Outcome, print};
use clap::Args;
use cosfly_toys::{Fleet, simulate};
use std::fmt::Write;

/// Arguments of `fleet`.
#[derive(Args, Debug)]
pub struct FleetArguments {
    /// Trajectories to make
    #[arg(long, value_name = "N", default_value_t = 1_000_000)]
    pub trajectories: u64,
    /// Workers, one core each
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = super::outcome::counts())]
    pub workers: usize,
    /// Crashes of a worker per hour
    #[arg(long, value_name = "RATE", default_value_t = 0.05)]
    pub crashes: f64,
}

/// Stores: name, operations per second, MB per second.
const STORES: [(&str, f64, f64); 4] = [
    ("one NFS server", 5_000.0, 1_000.0),
    ("NFS, fast", 20_000.0, 5_000.0),
    ("parallel file system", 50_000.0, 20_000.0),
    ("object store, 256 prefixes", 500_000.0, 100_000.0),
];

/// Simulates the fleet over several stores and prints a table.
pub fn fleet(arguments: &FleetArguments) -> Outcome {
    let mut text = format!(
        "{} trajectories on {} workers, {} crashes of a worker per hour\n\
         store                       batches   hours  commands  ops/s  busiest  MB/s  waits: store engine  crashes  lost, h  town reads/s\n",
        arguments.trajectories, arguments.workers, arguments.crashes
    );
    for (name, operations_per_s, mb_per_s) in STORES {
        for batches in [false, true] {
            let figures = simulate(&Fleet {
                trajectories: arguments.trajectories,
                workers: arguments.workers,
                operations_per_s,
                mb_per_s,
                crashes_per_hour: arguments.crashes,
                batches,
            });
            let _ = writeln!(
                text,
                "{name:27} {:7} {:>7.1} {:>9} {:>6.0} {:>8.0} {:>5.0} {:>11.1}% {:>5.1}% {:>8} {:>8.1} {:>13.0}",
                if batches { "yes" } else { "no" },
                figures.wall_s / 3600.0,
                figures.commands,
                figures.operations_per_s,
                figures.busiest_operations_per_s,
                figures.mb_per_s,
                figures.waiting_for_store * 100.0,
                figures.waiting_for_engine * 100.0,
                figures.crashes,
                figures.lost_s / 3600.0,
                figures.town_reads_per_s,
            );
        }
    }
    print(&text)
}
