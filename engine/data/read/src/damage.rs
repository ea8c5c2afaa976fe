//! The error of a file that is not as the dataset wrote it.

use cosfly_diagnose::{Diagnostic, Fault};
use std::path::Path;

/// A file of the dataset that is damaged: the file, the damage, the cause.
pub fn damaged(path: &Path, what: &str, cause: impl std::fmt::Display) -> Box<Diagnostic> {
    Diagnostic::new("dataset-damaged", Fault::Input, format!("`{}` is damaged: {what}", path.display()))
        .because(cause)
        .hint("`cosfly verify` lists everything that is wrong with a dataset")
}
