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
mod windows;
mod write;

pub use column::{Cell, Column, Kind, Table};
pub use files::FileRecord;
pub use objects::{ObjectRecord, kind_name};
pub use windows::{DIFFICULTIES, SCENES};
pub use write::{TableWriter, schema};
pub(crate) use write::{write_error, writer_properties};

use crate::mcap_log::LogRecord;
use crate::splits::TownLayout;
use crate::{CaptionRecord, PreviewStrip, RenderedTrajectory};
use cosfly_metrics::WindowShape;
use std::sync::Arc;

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
    /// The expert of a perturbed flight, for tables that read it; none where it is not in the dataset.
    pub expert: Option<Box<RenderedTrajectory>>,
    /// What it belongs to.
    pub membership: Membership,
    /// Its town without the name.
    pub layout: Arc<TownLayout>,
    /// How training windows are cut.
    pub windows: WindowShape,
}

/// What a flight belongs to among all others.
#[derive(Clone, Debug, PartialEq)]
pub struct Membership {
    /// Flights with the same one are in one split.
    pub split_group: String,
    /// Whether split `train` has flights in the same town.
    pub is_seen: bool,
    /// 0..1: those below 0.25 are a quarter of all.
    pub subset_rank: f64,
}

/// The tables over the trajectories, in the order of the card.
pub fn of_trajectories() -> Vec<Table<DatasetItem>> {
    vec![
        trajectories::table(),
        frames::table(),
        waypoints::table(),
        captions::table(),
        pairs::table(),
        people::table(),
        windows::table(),
    ]
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
