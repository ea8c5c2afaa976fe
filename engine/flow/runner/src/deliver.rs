//! A run, then the artifact of a stage as a folder; blobs that turn out damaged on the way are made again.

use crate::options::RunOptions;
use crate::run::{Ran, work};
use crate::summary::RunSummary;
use cosfly_diagnose::{Fault, Result};
use cosfly_recipe::Recipe;
use cosfly_stage::{Blobs, RunEvent};
use cosfly_store::{Materialised, Store, check_out_folder, materialise};
use std::path::Path;

/// Times that lost blobs are made again.
const MOST_HEALINGS: u32 = 3;

/// A run and the folder that it filled.
pub struct Delivery {
    /// Summary of the run; of the last one, where blobs had to be made again.
    pub summary: RunSummary,
    /// The folder; `None` where the run did not finish the stage.
    pub folder: Option<Materialised>,
}

/// Runs `recipe` and, where stage number `stage` is finished then, makes `folder` hold its artifact. The files of a stage
/// with several items are in one folder per item. A run that failed elsewhere still delivers a finished stage.
///
/// # Errors
/// Those of [`crate::run`] and [`materialise`].
pub fn deliver(
    recipe: &Recipe,
    store: &Store,
    stage: usize,
    folder: &Path,
    options: &RunOptions,
    report: &(dyn Fn(RunEvent) + Sync),
) -> Result<Delivery> {
    check_out_folder(store.root(), folder)?;
    let mut tries = 0;
    loop {
        let ran = work(recipe, store, options, report)?;
        let blobs = files_of(&ran, stage);
        // The run is remembered while its folder is made: neither needs the other.
        let (remembered, delivered) = std::thread::scope(|scope| {
            let remembered = scope.spawn(|| ran.remember(store));
            let delivered = blobs.map(|blobs| materialise(store, &blobs, folder)).transpose();
            (remembered.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)), delivered)
        });
        let summary = ran.summary(remembered, store);
        match delivered {
            Ok(folder) => return Ok(Delivery { summary, folder }),
            Err(lost) if lost.fault == Fault::Lost && tries < MOST_HEALINGS => tries += 1,
            Err(diagnostic) => return Err(diagnostic),
        }
    }
}

/// Files of all items of a finished stage.
fn files_of(ran: &Ran<'_>, stage: usize) -> Option<Blobs> {
    let items = ran.whole_stage(stage)?;
    if let [(_, finished)] = &items[..] {
        return Some(Blobs::clone(&finished.record.outputs));
    }
    let files = items.iter().flat_map(|(item, finished)| {
        finished.record.outputs.iter().map(move |(name, blob)| (format!("{item}/{name}"), *blob))
    });
    Some(files.collect())
}
