//! `cosfly gc`: frees what no recent run needs.

use super::{Outcome, store_dir};
use crate::arguments::GcArguments;
use crate::exit;
use crate::text::{bytes, count};
use cosfly_store::{GarbageOptions, collect_garbage};
use std::time::{Duration, SystemTime};

const SECONDS_PER_DAY: u64 = 86_400;

/// Shows what would go, or removes it.
pub fn collect(arguments: &GcArguments) -> Outcome {
    let root = store_dir(&arguments.store);
    let options = GarbageOptions {
        keep_runs: arguments.keep_runs,
        keep_age: Duration::from_secs(arguments.keep_days.saturating_mul(SECONDS_PER_DAY)),
        now: SystemTime::now(),
        dry_run: !arguments.delete,
    };
    let report = collect_garbage(&root, &options).map_err(|refusal| vec![refusal])?;
    let verb = if arguments.delete { "removed" } else { "would remove" };
    crate::print(&format!(
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
    if !arguments.delete {
        crate::print("nothing was deleted; add `--delete` to do it\n")?;
    }
    Ok(exit::SUCCESS)
}
