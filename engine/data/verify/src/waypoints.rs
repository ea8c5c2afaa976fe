//! Table `waypoints` against table `frames`.

use super::files::CheckedFiles;
use super::report::VerifyReport;
use super::rows;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The motion in `waypoints` is that of `frames`, bit for bit.
pub fn check(
    folder: &Path,
    files: &CheckedFiles,
    motions: &BTreeMap<String, blake3::Hasher>,
    report: &mut VerifyReport,
) {
    let mut found: BTreeMap<String, (u32, blake3::Hasher)> = BTreeMap::new();
    for file in files.sound_below("data/waypoints/") {
        let outcome = rows::waypoints(&folder.join(file), &mut |id, step, motion| {
            let (next, hasher) = found.entry(id).or_insert((0, blake3::Hasher::new()));
            hasher.update(&motion);
            // A step out of order spoils the hash.
            if step != *next {
                hasher.update(b"order");
            }
            *next += 1;
        });
        if let Err(message) = outcome {
            report.find(file, "", "verify-schema", message);
        }
    }
    let names: BTreeSet<&String> = motions.keys().chain(found.keys()).collect();
    for id in names {
        let same = matches!((motions.get(id), found.get(id)), (Some(a), Some((_, b))) if a.finalize() == b.finalize());
        if !same {
            report.find(
                "data/waypoints",
                format!("`{id}`"),
                "verify-waypoints",
                "its steps are not those of table `frames`",
            );
        }
    }
}
