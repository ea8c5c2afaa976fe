//! What plugins add to a dataset beside its own tables: annotations of flights, tables of rows, files.
//!
//! * [`Extra`]: what one plugin gave of one flight, between its stage and the dataset.
//! * [`Kept`]: what all flights of a dataset have of one plugin, for card, manifest and checks.

mod table;

pub use table::{columns_of, schema_of, write_batch};

use crate::flight_table::{DeclaredColumn, Values};
use crate::tables;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// What is made of a flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ExtraShape {
    /// One row of a table.
    Annotation,
    /// Rows of a table.
    Rows,
    /// Files.
    Files,
}

/// What one plugin gave of one flight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Extra {
    /// What it is.
    pub source: ExtraSource,
    /// The values of its columns, in their order.
    pub values: Vec<Values>,
}

/// What all flights have in common.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ExtraSource {
    /// Name of the table or the folder.
    pub name: String,
    /// What it is.
    pub shape: ExtraShape,
    /// Its columns.
    pub columns: Vec<DeclaredColumn>,
    /// The plugin, as it calls itself.
    pub plugin: String,
    /// Its version.
    pub version: String,
    /// What it says that it does.
    pub summary: String,
}

/// What a dataset has of one plugin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kept {
    /// Where it is from.
    pub source: ExtraSource,
    /// Rows by split, of tables.
    pub rows: BTreeMap<String, u64>,
    /// Files.
    pub files: u64,
    /// In how many folders below the flight's own they lie.
    pub depths: BTreeSet<usize>,
}

/// Names that tables of plugins cannot have: those of the dataset's own.
pub fn is_taken(name: &str) -> bool {
    let own = tables::of_trajectories().iter().map(|table| table.name).collect::<Vec<_>>();
    let others = [tables::of_objects().name, tables::of_rejections().name, tables::of_files().name];
    own.into_iter().chain(others).chain(crate::tables::INLINE_SETS).any(|taken| taken == name)
}

/// Columns that the dataset itself gives such tables.
pub const OWN_COLUMNS: [&str; 3] = ["trajectory_id", "row", "split"];

/// Why a plugin may not give such a table, if so.
///
/// # Errors
/// The name that is taken.
pub fn check_names(name: &str, columns: &[DeclaredColumn]) -> Result<(), String> {
    if is_taken(name) {
        return Err(format!("it names its table `{name}`, which datasets have of their own"));
    }
    match columns.iter().find(|column| OWN_COLUMNS.contains(&column.name.as_str())) {
        Some(column) => Err(format!("it gives a column `{}`, which the dataset adds itself", column.name)),
        None => Ok(()),
    }
}
