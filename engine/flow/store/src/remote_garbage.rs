//! Garbage collection of a remote store: the same roots and rules as in a folder, over lists of objects.
//!
//! No lock keeps runs out: machines that share a remote do not share locks. The age below which everything is kept does, so it
//! must be longer than any run.

use crate::garbage::{GarbageOptions, GarbageReport, needed_by};
use crate::history::PastRun;
use crate::layout::Area;
use crate::remote::{Remote, RemoteObject};
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_fingerprint::Digest;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// Removes (or counts) everything in a remote store that is older than the limit and needed by no recent run or pin.
///
/// # Errors
/// Those of the remote; nothing is removed where something could not be read.
pub fn collect_remote_garbage(remote: &dyn Remote, options: &GarbageOptions) -> Result<GarbageReport> {
    let roots = roots(remote, options.keep_runs)?;
    let refused: Mutex<Option<Box<Diagnostic>>> = Mutex::new(None);
    let needed = needed_by(&roots, &|area, digest| {
        let name = format!("{}/{}/{digest}", area.folder(), &digest.to_string()[..2]);
        remote.get(&name).unwrap_or_else(|refusal| {
            refused.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(refusal);
            None
        })
    });
    if let Some(refusal) = refused.into_inner().unwrap_or_else(PoisonError::into_inner) {
        return Err(refusal);
    }
    let mut report = GarbageReport::default();
    // References go before their targets: a crash half way leaves nothing dangling.
    for area in [Area::Done, Area::Builds, Area::Plans, Area::Actions, Area::Blobs] {
        let wanted = needed.in_area(area);
        let mut gone = Vec::new();
        for object in remote.list(area.folder())? {
            let digest = object.name.rsplit('/').next().and_then(|name| name.parse::<Digest>().ok());
            let Some(digest) = digest else { continue };
            let keep = is_young(&object, options) || wanted.contains(&digest);
            let (count, bytes) = match (area, keep) {
                (Area::Blobs, true) => (&mut report.kept_blobs, &mut report.kept_blob_bytes),
                (Area::Blobs, false) => (&mut report.blobs, &mut report.blob_bytes),
                (_, true) => continue,
                (_, false) => (&mut report.records, &mut report.record_bytes),
            };
            *count += 1;
            *bytes += object.bytes;
            if !keep {
                gone.push(object.name);
            }
        }
        if !options.dry_run {
            remote.delete(&gone)?;
        }
    }
    Ok(report)
}

/// The newest runs of every recipe, and all pins.
fn roots(remote: &dyn Remote, keep_runs: usize) -> Result<Vec<PastRun>> {
    let mut runs: BTreeMap<String, Vec<RemoteObject>> = BTreeMap::new();
    for object in remote.list("runs")? {
        let recipe = object.name.split('/').nth(1).unwrap_or_default().to_owned();
        runs.entry(recipe).or_default().push(object);
    }
    let mut names: Vec<String> = remote.list("pins")?.into_iter().map(|pin| pin.name).collect();
    for mut of_recipe in runs.into_values() {
        of_recipe.sort_by_key(|run| std::cmp::Reverse(run.written));
        names.extend(of_recipe.into_iter().take(keep_runs).map(|run| run.name));
    }
    let mut roots = Vec::new();
    for name in names {
        let bytes = remote.get(&name)?.unwrap_or_default();
        roots.extend(std::str::from_utf8(&bytes).ok().and_then(PastRun::decode));
    }
    Ok(roots)
}

fn is_young(object: &RemoteObject, options: &GarbageOptions) -> bool {
    options.now.duration_since(object.written).unwrap_or_default() < options.keep_age
}
