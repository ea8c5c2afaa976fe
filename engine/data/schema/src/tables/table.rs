//! A table: its columns and how its rows come from a record.

use super::column::AnyColumn;
use crate::{CaptionRecord, LogRecord, PreviewStrip, RenderedTrajectory, TownLayout};
use cosfly_metrics::WindowShape;
use std::sync::Arc;

/// One trajectory with everything that tables say about it.
#[derive(Clone, Debug)]
pub struct DatasetItem {
    /// The record of the render stage.
    pub record: RenderedTrajectory,
    /// Captions of the trajectory.
    pub captions: Vec<CaptionRecord>,
    /// Previews of the frames; empty unless a table asks for them.
    pub previews: PreviewStrip,
    /// The trajectory's log.
    pub log: LogRecord,
    /// Path of the log in the dataset.
    pub mcap_path: String,
    /// The expert of a perturbed trajectory, for tables that ask for it; none where it is not in the dataset.
    pub expert: Option<Box<RenderedTrajectory>>,
    /// Split group and subset of the trajectory.
    pub membership: Membership,
    /// Ground plan of the trajectory's town.
    pub layout: Arc<TownLayout>,
    /// Shape of training windows.
    pub windows: WindowShape,
}

/// The place of a trajectory among all others.
#[derive(Clone, Debug, PartialEq)]
pub struct Membership {
    /// Trajectories with the same group are in one split.
    pub split_group: String,
    /// Split `train` has trajectories in the same town.
    pub is_seen: bool,
    /// 0..1: those below 0.25 are a quarter of all.
    pub subset_rank: f64,
}

/// Parts of a [`DatasetItem`] that are read only for tables that ask for them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// [`DatasetItem::previews`].
    Previews,
    /// [`DatasetItem::expert`].
    Expert,
}

/// A table whose rows come from records of type `S`.
pub struct Table<S: 'static> {
    /// Name: folder under `data/` and name of the Hugging Face config.
    pub name: &'static str,
    /// One sentence for the card.
    pub doc: &'static str,
    /// Columns that together name a row.
    pub key: &'static [&'static str],
    /// Number of rows of one record.
    pub rows: fn(&S) -> usize,
    /// The columns, in their order.
    pub columns: Vec<&'static dyn AnyColumn<S>>,
    /// Whether there is a row per frame, so that large datasets split the table into several files.
    pub per_frame: bool,
    /// Rows kept together in a file.
    pub rows_per_group: usize,
    /// Parts of the record that the cells read.
    pub needs: &'static [Need],
}

impl<S> Table<S> {
    /// A small table: not per frame, 50,000 rows together, in need of nothing; other tables change these fields.
    pub fn new(
        name: &'static str,
        doc: &'static str,
        key: &'static [&'static str],
        rows: fn(&S) -> usize,
        columns: &[&'static dyn AnyColumn<S>],
    ) -> Self {
        Self { name, doc, key, rows, columns: columns.to_vec(), per_frame: false, rows_per_group: 50_000, needs: &[] }
    }

    /// Whether the cells read a part of the record.
    pub fn needs(&self, need: Need) -> bool {
        self.needs.contains(&need)
    }
}

/// Record sets whose rows stand in the manifest itself.
pub const INLINE_SETS: [&str; 5] = ["splits", "semantic_labels", "roles", "scenes", "difficulties"];
