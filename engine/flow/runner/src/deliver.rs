//! A run, then the artifact of a stage as a folder; what turns out damaged on the way is made again.

use crate::run::{RunOptions, run};
use crate::summary::{RunOutcome, RunSummary};
use cosfly_diagnose::Result;
use cosfly_recipe::Recipe;
use cosfly_stage::{BlobRef, RunEvent};
use cosfly_store::{BLOB_LOST, Materialised, Store, check_out_folder, materialise};
use std::collections::BTreeMap;
use std::path::Path;

/// How often lost blobs are made again.
const MOST_HEALINGS: u32 = 3;

/// A run and the folder that it filled.
pub struct Delivery {
    /// The run (the last one, when blobs had to be made again).
    pub summary: RunSummary,
    /// The folder; nothing when the run did not finish the stage.
    pub folder: Option<Materialised>,
}

/// Runs `recipe` and, when `stage` is finished, makes `folder` hold its artifact. The files of a stage with
/// several items lie in one folder per item. A run that failed elsewhere still delivers a finished stage.
///
/// # Errors
/// As [`run`] and [`materialise`].
pub fn deliver(
    recipe: &Recipe,
    store: &Store,
    stage: &str,
    folder: &Path,
    options: &RunOptions,
    report: &(dyn Fn(RunEvent) + Sync),
) -> Result<Delivery> {
    check_out_folder(store.root(), folder)?;
    let mut tries = 0;
    loop {
        let summary = run(recipe, store, options, report)?;
        let Some(blobs) = files_of(&summary, stage) else { return Ok(Delivery { summary, folder: None }) };
        match materialise(store, &blobs, folder) {
            Ok(folder) => return Ok(Delivery { summary, folder: Some(folder) }),
            Err(lost) if lost.code == BLOB_LOST && tries < MOST_HEALINGS => tries += 1,
            Err(diagnostic) => return Err(diagnostic),
        }
    }
}

/// The files of all items of a finished stage.
fn files_of(summary: &RunSummary, stage: &str) -> Option<BTreeMap<String, BlobRef>> {
    let total = summary.stages.iter().find(|counts| counts.name == stage)?.total;
    let items: Vec<_> = summary.finished_items(stage).collect();
    if summary.outcome == RunOutcome::Cancelled || items.is_empty() || items.len() as u64 != total {
        return None;
    }
    let single = items.len() == 1;
    let files = items.iter().flat_map(|(item, finished)| {
        finished.record.outputs.iter().map(move |(name, blob)| {
            let path = if single { name.clone() } else { format!("{item}/{name}") };
            (path, *blob)
        })
    });
    Some(files.collect())
}
