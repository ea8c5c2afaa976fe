//! Checks a finished dataset from the outside, by its files alone: hashes, schemas, counts, logs, geometry.
//!
//! Every finding names the file, the place in it and the rule. Files whose hash is wrong are reported and not
//! read further, except for logs, whose own checksums tell where the damage is.

mod croissant;
mod files;
mod flight;
mod log;
mod report;
mod rows;
mod tables;

pub use report::{Finding, VerifyReport};

use cosfly_diagnose::{Diagnostic, Fault, Result};
use std::path::Path;

/// Checks the dataset in `folder`. `progress` hears how many of all flights are done. An error means that the
/// folder could not be read or holds no dataset; everything else is a finding.
pub fn verify(folder: &Path, progress: &mut dyn FnMut(u64, u64)) -> Result<VerifyReport> {
    for name in ["files.parquet", "croissant.json", "SHA256SUMS"] {
        if !folder.join(name).is_file() {
            let message = format!("`{}` is not a finished dataset: it has no `{name}`", folder.display());
            return Err(Diagnostic::new("verify-no-dataset", Fault::Input, message)
                .hint("give the folder that `cosfly run --out` wrote"));
        }
    }
    let mut report = VerifyReport::default();
    let files = files::check(folder, &mut report)?;
    let tables = tables::read(folder, &files, &mut report);
    croissant::check(folder, &files, &mut report)?;
    flight::check_all(folder, &files, &tables, &mut report, progress);
    Ok(report)
}

#[cfg(test)]
mod tests;
