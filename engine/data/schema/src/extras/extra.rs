//! Output of a plugin or a sensor, for one flight and for a dataset.

use crate::flight_table::{DeclaredColumn, Values};
use crate::tables;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// Form of the output for one flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ExtraShape {
    /// One row of a table.
    Annotation,
    /// Rows of a table.
    Rows,
    /// Files.
    Files,
    /// Rows of a table, one for each reading of a sensor.
    Readings,
}

impl ExtraShape {
    /// Whether a flight may have several rows.
    pub fn has_rows(self) -> bool {
        matches!(self, Self::Rows | Self::Readings)
    }
}

/// Output of one plugin or sensor for one flight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Extra {
    /// Plugin and declaration of the output.
    pub source: ExtraSource,
    /// Values of the declared columns, in their order.
    pub values: Vec<Values>,
}

/// Plugin or sensor and declaration of an output, the same for all flights.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ExtraSource {
    /// Name of the table or the folder.
    pub name: String,
    /// Form of the output.
    pub shape: ExtraShape,
    /// Declared columns.
    pub columns: Vec<DeclaredColumn>,
    /// Name of the plugin or of the sensor.
    pub plugin: String,
    /// Its version.
    pub version: String,
    /// Its description.
    pub summary: String,
}

impl ExtraSource {
    /// Readings of a sensor, one row each, in a table.
    pub fn of_sensor(table: &str, (sensor, version): (&str, u32), summary: &str, columns: Vec<DeclaredColumn>) -> Self {
        Self {
            name: table.to_owned(),
            shape: ExtraShape::Readings,
            columns,
            plugin: sensor.to_owned(),
            version: version.to_string(),
            summary: summary.to_owned(),
        }
    }

    /// Origin of the output in words, such as "plugin `viewpoint` 1.0.0".
    pub fn origin(&self) -> String {
        let giver = if self.shape == ExtraShape::Readings { "sensor" } else { "plugin" };
        format!("{giver} `{}` {}", self.plugin, self.version)
    }
}

/// Output of one plugin or sensor for all flights of a dataset.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ExtraSummary {
    /// Plugin and declaration of the output.
    pub source: ExtraSource,
    /// Numbers of rows by split, for tables.
    pub rows: BTreeMap<String, u64>,
    /// Number of files.
    pub files: u64,
    /// Depths of the files, in folders below the flight's own.
    pub depths: BTreeSet<usize>,
}

/// Whether a table name is reserved for the dataset's own tables.
pub fn is_taken(name: &str) -> bool {
    let own = tables::of_trajectories().iter().map(|table| table.name).collect::<Vec<_>>();
    let others = [tables::of_objects().name, tables::of_rejections().name, tables::of_files().name];
    own.into_iter().chain(others).chain(tables::INLINE_SETS).any(|taken| taken == name)
}

/// Columns that the dataset adds to tables of plugins.
pub const OWN_COLUMNS: [&str; 3] = ["trajectory_id", "row", "split"];

/// Checks the names of a plugin's table and columns.
///
/// # Errors
/// The reserved name.
pub fn check_names(name: &str, columns: &[DeclaredColumn]) -> Result<(), String> {
    if is_taken(name) {
        return Err(format!("it names its table `{name}`, which is reserved for the dataset's own tables"));
    }
    match columns.iter().find(|column| OWN_COLUMNS.contains(&column.name.as_str())) {
        Some(column) => Err(format!("it gives a column `{}`, which the dataset adds itself", column.name)),
        None => Ok(()),
    }
}
