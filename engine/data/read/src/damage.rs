//! Error of a damaged file of a dataset.

use cosfly_diagnose::{Diagnostic, Fault};
use std::path::Path;

/// Diagnostic of a damaged file: the file, the damage, the cause.
pub fn damaged(path: &Path, what: &str, cause: impl std::fmt::Display) -> Box<Diagnostic> {
    Diagnostic::new("dataset-damaged", Fault::Input, format!("`{}` is damaged: {what}", path.display()))
        .because(cause)
        .hint("`cosfly verify` lists everything that is wrong with a dataset")
}
