//! Definition of a table: its columns, and the rows of a record.

use super::body_row::BodyRow;
use super::column::AnyColumn;
use crate::losses::Loss;
use crate::{CaptionRecord, LogRecord, PreviewStrip, RenderedTrajectory, Split, TownLayout};
use cosfly_frames::DVec3;
use cosfly_windows::WindowShape;
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::sync::Arc;

/// One trajectory with everything that tables contain about it.
#[derive(Clone, Debug)]
pub struct DatasetItem {
    /// Record of the render stage.
    pub record: RenderedTrajectory,
    /// Rows of tables that are worked out once for a trajectory.
    pub derived: Derived,
    /// Captions of the trajectory.
    pub captions: Vec<CaptionRecord>,
    /// Previews of the frames; empty unless a table needs them.
    pub previews: PreviewStrip,
    /// Log of the trajectory.
    pub log: LogRecord,
    /// Path of the log in the dataset.
    pub mcap_path: String,
    /// Expert of a perturbed trajectory, for tables that need it; `None` where it is not in the dataset.
    pub expert: Option<Box<RenderedTrajectory>>,
    /// Split, split group and subset of the trajectory.
    pub membership: Membership,
    /// Ground plan of the trajectory's town.
    pub layout: Arc<TownLayout>,
    /// Shape of training windows.
    pub windows: WindowShape,
}

/// Rows of tables that are worked out once for a trajectory.
#[derive(Clone, Debug, Default)]
pub struct Derived {
    /// Intervals without sight of the target.
    pub losses: Vec<Loss>,
    /// Referring phrases.
    pub phrases: Vec<PhraseRow>,
    /// Goals at several grains.
    pub goals: Vec<GoalRow>,
    /// Marked crossings around the target's way.
    pub crossings: Vec<CrossingRow>,
    /// Bodies around the target, frame by frame.
    pub bodies: Vec<BodyRow>,
    /// Instructions of the windows, in English and in Chinese.
    pub instructions: Vec<[String; 2]>,
}

/// A goal for the pilot.
#[derive(Clone, Debug, PartialEq)]
pub struct GoalRow {
    /// Kind of goal: `flight`, `step`, `dialogue` or `negative`.
    pub grain: String,
    /// Language: `zh` or `en`.
    pub language: String,
    /// Frames that the goal is about.
    pub frames: Range<usize>,
    /// Lines: the user's first, then by turns the pilot's and the user's.
    pub lines: Vec<String>,
    /// Whether the flight does what the goal says.
    pub fits: bool,
    /// Subject of the false claim, where there is one.
    pub false_subject: Option<String>,
    /// Claims of the user in the end, each with its frames.
    pub claims: Vec<String>,
    /// Subjects of the claims, sorted, each once.
    pub subjects: Vec<String>,
}

/// A phrase that singles the target out, and the bodies that the phrase fits in all frames.
#[derive(Clone, Debug, PartialEq)]
pub struct PhraseRow {
    /// Frame in which the phrase is given.
    pub frame: usize,
    /// The phrase in English.
    pub text_en: String,
    /// The phrase in Chinese.
    pub text_zh: String,
    /// Names of the named properties.
    pub properties: Vec<String>,
    /// Number of visible bodies, with the target, that the phrase may fit, by frame.
    pub candidates: Vec<u32>,
    /// Whether the target is visible and the phrase may fit it, by frame.
    pub fits_target: Vec<bool>,
}

/// A marked crossing of a street.
#[derive(Clone, Debug, PartialEq)]
pub struct CrossingRow {
    /// Number among the crossings of its town, from 0.
    pub number: u32,
    /// Corners in order.
    pub outline_in_world: Vec<DVec3>,
}

/// Split, split group and subset of a trajectory.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Membership {
    /// Split, that of the files with the trajectory's rows.
    pub split: Split,
    /// Name of the group; trajectories of one group are in one split.
    pub split_group: String,
    /// Whether split `train` has trajectories in the same town.
    pub is_seen: bool,
    /// Rank in nested subsets, 0..1: trajectories below 0.25 are a quarter of all.
    pub subset_rank: f64,
}

/// Parts of a [`DatasetItem`] that are read only for tables that need them.
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
    /// Description for the card, one sentence.
    pub doc: &'static str,
    /// Columns that together identify a row.
    pub key: &'static [&'static str],
    /// Number of rows of one record.
    pub rows: fn(&S) -> usize,
    /// The columns, in their order.
    pub columns: Vec<&'static dyn AnyColumn<S>>,
    /// Whether the table has a row per frame, so that large datasets split it into several files.
    pub per_frame: bool,
    /// Rows per row group.
    pub rows_per_group: usize,
    /// Parts of the record that the cells read.
    pub needs: &'static [Need],
}

impl<S> Table<S> {
    /// A small table: not per frame, 50,000 rows per row group, without needs; other tables change these fields.
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

/// Record sets whose rows are in the manifest itself.
pub const INLINE_SETS: [&str; 5] = ["splits", "semantic_labels", "roles", "scenes", "difficulties"];
