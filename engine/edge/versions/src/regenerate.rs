//! Makes flights again from the recipe alone, in an empty store, and compares them with the published ones.

use crate::record::{dataset_stage, logs_of, reads};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_read::{PublishedDataset, inner_path};
use cosfly_recipe::Recipe;
use cosfly_runner::{RunOptions, plan, run_tasks};
use cosfly_stage::Registry;
use cosfly_store::{Store, digest_of_file};
use std::collections::BTreeSet;
use std::fs::File;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A flight that was made again.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Regenerated {
    /// Id of the flight.
    pub trajectory_id: String,
    /// Path of its log in the dataset's folder.
    pub mcap_path: String,
    /// Difference from the published log; `None` where the bytes are equal.
    pub problem: Option<String>,
}

/// Makes `number` flights of the dataset in `folder`, spread evenly over it, again in the empty store `scratch` and
/// compares their logs with the published ones byte by byte (by BLAKE3).
///
/// # Errors
/// Errors in the dataset or the recipe, errors of a stage, or `machine-io`.
pub fn regenerate(
    folder: &Path,
    number: usize,
    recipe: &Recipe,
    registry: &Registry,
    scratch: &Path,
    cancelled: &Arc<AtomicBool>,
) -> Result<Vec<Regenerated>> {
    let published = PublishedDataset::open(folder)?;
    let flights = published.flights();
    let chosen: Vec<_> =
        (0..number.min(flights.len())).map(|k| &flights[k * flights.len() / number.min(flights.len())]).collect();
    let logs = logs_of(&recipe.stages[dataset_stage(recipe)?]);
    let stage = recipe
        .position(logs.as_str())
        .ok_or_else(|| Diagnostic::new("regenerate-no-logs", Fault::Bug, format!("the recipe has no part `{logs}`")))?;
    let store = Store::open(scratch)?;
    plan(recipe, &store)?.publish_documents(&store)?;
    let mut found = vec![];
    for flight in chosen {
        let id = &flight.trajectory_id;
        let place = recipe.stages[stage].items.iter().position(|item| item.to_string() == *id);
        let problem = match place {
            None => Some("the recipe makes no such flight".to_owned()),
            Some(item) => {
                let digest = made(recipe, registry, &store, stage, item, cancelled)?;
                compared(folder, &flight.mcap_path, digest)?
            }
        };
        found.push(Regenerated { trajectory_id: id.clone(), mcap_path: flight.mcap_path.clone(), problem });
    }
    Ok(found)
}

/// Runs a task and everything that it needs; returns the digest of its log.
fn made(
    recipe: &Recipe,
    registry: &Registry,
    store: &Store,
    stage: usize,
    item: usize,
    cancelled: &Arc<AtomicBool>,
) -> Result<Option<Digest>> {
    let mut needed = BTreeSet::from([(stage, item)]);
    let mut open = vec![(stage, item)];
    while let Some((stage, item)) = open.pop() {
        open.extend(reads(recipe, stage, item).into_iter().filter(|task| needed.insert(*task)));
    }
    let plan = plan(recipe, store)?;
    // Stages are in dependency order, so inputs come first.
    let plans: Vec<Digest> = needed.iter().map(|(stage, item)| plan.stages[*stage].plans[*item]).collect();
    let options = RunOptions { cancelled: Arc::clone(cancelled), ..RunOptions::default() };
    run_tasks(store, registry, &plans, &options)?.into_iter().try_for_each(|end| end.map(drop))?;
    let finished = store.finished(&plan.stages[stage].plans[item]);
    Ok(finished.and_then(|finished| finished.record.outputs.get("mcap").map(|blob| blob.digest)))
}

fn compared(folder: &Path, path: &str, made: Option<Digest>) -> Result<Option<String>> {
    let Some(made) = made else { return Ok(Some("made anew, it is rejected".to_owned())) };
    let refused = |error: std::io::Error| Diagnostic::io(format!("read `{path}`"), &error);
    let outside =
        || Diagnostic::new("dataset-damaged", Fault::Input, format!("the log `{path}` is outside the dataset"));
    let place = inner_path(folder, path).ok_or_else(outside)?;
    let published = File::open(place).and_then(|mut file| digest_of_file(&mut file)).map_err(refused)?;
    let differs = || format!("made anew, its BLAKE3 is {made}; {published} is published");
    Ok((published != made).then(differs))
}
