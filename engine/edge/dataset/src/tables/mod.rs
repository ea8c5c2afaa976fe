//! The Parquet tables: one file per table, one list of them, and what all tables share.
//!
//! To add a table over the trajectories, write its file and add two lines below: its `mod` and its entry in
//! [`of_trajectories`]. Card, `croissant.json` and checks follow from its columns.

mod captions;
mod column;
mod files;
mod frames;
mod objects;
mod pairs;
mod people;
mod rejected;
mod trajectories;
mod waypoints;
mod write;

pub use column::{Cell, Column, Kind, Table};
pub use files::FileRecord;
pub use objects::{ObjectRecord, kind_name};
pub use write::{TableWriter, schema};

use crate::mcap_log::LogRecord;
use crate::{CaptionRecord, PreviewStrip, RenderedTrajectory};

/// One trajectory with everything that tables say about it.
#[derive(Clone, Debug)]
pub struct DatasetItem {
    /// The record of the render stage.
    pub record: RenderedTrajectory,
    /// Its captions.
    pub captions: Vec<CaptionRecord>,
    /// Its previews; empty unless a table asks for them.
    pub previews: PreviewStrip,
    /// Its log.
    pub log: LogRecord,
    /// Path of the log in the dataset.
    pub mcap_path: String,
}

/// The tables over the trajectories, in the order of the card.
pub fn of_trajectories() -> Vec<Table<DatasetItem>> {
    vec![trajectories::table(), frames::table(), waypoints::table(), captions::table(), pairs::table(), people::table()]
}

/// The table of items without a trajectory.
pub fn of_rejections() -> Table<crate::Rejection> {
    rejected::table()
}

/// The table of what instance ids stand for.
pub fn of_objects() -> Table<ObjectRecord> {
    objects::table()
}

/// The table of all files with their hashes.
pub fn of_files() -> Table<FileRecord> {
    files::table()
}

#[cfg(test)]
mod tests;
