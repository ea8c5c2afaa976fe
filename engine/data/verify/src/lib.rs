//! Checks a finished dataset from the outside, by its files alone: hashes, schemas, counts, logs, geometry.
//!
//! Every finding names the file, the place in it and the rule. Files whose hash is wrong are reported and not
//! read further, except for logs, whose own checksums tell where the damage is.

mod body;
mod boxes;
mod croissant;
mod extras;
mod figures;
mod files;
mod flights;
mod frames;
mod labels;
mod log;
mod people;
mod report;
mod rows;
mod splits;
mod sums;
mod tables;
mod twins;
mod waypoints;
mod windows;

pub use report::{Finding, LabelGap, VerifyReport};

use cosfly_diagnose::{Diagnostic, Fault, Result};
use std::path::Path;

/// Checks the dataset in `folder`. `progress` hears how many of all flights are done. An error means that the
/// folder could not be read or holds no dataset; everything else is a finding.
pub fn verify(folder: &Path, progress: &mut dyn FnMut(u64, u64)) -> Result<VerifyReport> {
    if let Some(problem) = folder_problem(folder) {
        let message = format!("`{}` {problem}", folder.display());
        return Err(Diagnostic::new("verify-no-dataset", Fault::Input, message)
            .hint("give the folder that `cosfly run --out` wrote"));
    }
    let mut report = VerifyReport::default();
    let files = files::check(folder, &mut report)?;
    let tables = tables::read(folder, &files, &mut report);
    splits::check(folder, &tables, &mut report);
    windows::check(folder, &files, &tables, &mut report);
    croissant::check(folder, &files, &mut report)?;
    extras::check(folder, &files, &tables, &mut report);
    flights::check_all(folder, &files, &tables, &mut report, progress);
    Ok(report)
}

/// Why nothing in `folder` can be checked, if so. One part of a dataset is enough: missing others are findings.
fn folder_problem(folder: &Path) -> Option<&'static str> {
    match std::fs::metadata(folder) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Some("does not exist"),
        Ok(found) if !found.is_dir() => Some("is not a folder"),
        _ => {
            let has = |name: &&str| std::fs::symlink_metadata(folder.join(name)).is_ok();
            let is_dataset = ["files.parquet", "croissant.json", "SHA256SUMS"].iter().any(has);
            (!is_dataset).then_some("is not a finished dataset: it has no `files.parquet`")
        }
    }
}

#[cfg(test)]
mod tests;
