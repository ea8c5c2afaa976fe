//! `cosfly gc`: frees the space of results that no recent run needs.

use crate::arguments::{StoreArguments, remote};
use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use crate::text::{bytes, count};
use clap::Parser;
use cosfly_store::{GarbageOptions, collect_garbage, collect_remote_garbage};
use std::time::{Duration, SystemTime};

const SECONDS_PER_DAY: u64 = 86_400;

/// Free space in the store; shows what would go unless `--delete` is given
#[derive(Debug, Parser)]
#[command(
    name = "gc",
    after_help = "\
Examples:
  cosfly gc                                 what would go
  cosfly gc --delete --keep-runs 1 --keep-days 0"
)]
pub struct Arguments {
    #[command(flatten)]
    store: StoreArguments,
    /// Delete, and pack thousands of small files that stay; without this option, the sizes are only shown
    #[arg(long)]
    delete: bool,
    /// Runs per recipe whose results are kept
    #[arg(long, value_name = "N", default_value_t = 3)]
    keep_runs: usize,
    /// Age up to which everything is kept, days
    #[arg(long, value_name = "DAYS", default_value_t = 7)]
    keep_days: u64,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let root = self.store.folder();
        let options = GarbageOptions {
            keep_runs: self.keep_runs,
            keep_age: Duration::from_secs(self.keep_days.saturating_mul(SECONDS_PER_DAY)),
            now: SystemTime::now(),
            pack_from: GarbageOptions::PACK_FROM,
            dry_run: !self.delete,
        };
        let report = match self.store.bucket() {
            Some(place) => collect_remote_garbage(&*remote(place)?, &options)?,
            None => collect_garbage(&root, &options)?,
        };
        let verb = if self.delete { "removed" } else { "would remove" };
        console.print(&format!(
            "{verb} {} ({}), {} ({}), {} of dead processes ({})\n{} stay ({})\n",
            count(report.blobs, "blob"),
            bytes(report.blob_bytes),
            count(report.records, "record"),
            bytes(report.record_bytes),
            count(report.orphans, "folder"),
            bytes(report.orphan_bytes),
            count(report.kept_blobs, "blob"),
            bytes(report.kept_blob_bytes),
        ))?;
        if report.packed > 0 {
            console.print(&format!("packed {}\n", count(report.packed, "small file")))?;
        }
        if !self.delete {
            console.print("nothing was deleted; add `--delete` to do it\n")?;
        }
        Ok(exit::SUCCESS)
    }
}
