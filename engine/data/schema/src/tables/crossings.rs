//! Table `crossings`: the marked crossings of streets around each flight.

use super::column::columns;
use super::{CrossingRow, DatasetItem, Table};
use cosfly_frames::DVec3;

/// Definition of the table.
pub fn table() -> Table<DatasetItem> {
    let doc = "Marked crossings of streets around the target's way; empty in towns without crossings.";
    let rows = |item: &DatasetItem| item.derived.crossings.len();
    Table::new("crossings", doc, &["trajectory_id", "crossing"], rows, Crossings::COLUMNS)
}

/// Columns of table `crossings`.
pub struct Crossings;

columns! { Crossings::COLUMNS of DatasetItem;
    /// Trajectory that comes by.
    trajectory_id: String = |item, _| item.record.trajectory_id.clone();
    /// Split: `train`, `val` or `test`; that of the file.
    split: String = |item, _| item.membership.split.name().to_owned();
    /// Number of the crossing in its town, from 0.
    crossing: u32 = |item, i| crossing(item, i).number;
    /// Corners of its ground in order, world frame: their x.
    outline_x_m: Vec<f64> = |item, i| corners(item, i, |corner| corner.x);
    /// Their y.
    outline_y_m: Vec<f64> = |item, i| corners(item, i, |corner| corner.y);
    /// Their z.
    outline_z_m: Vec<f64> = |item, i| corners(item, i, |corner| corner.z);
}

fn crossing(item: &DatasetItem, i: usize) -> &CrossingRow {
    &item.derived.crossings[i]
}

fn corners(item: &DatasetItem, i: usize, value: fn(&DVec3) -> f64) -> Vec<f64> {
    crossing(item, i).outline_in_world.iter().map(value).collect()
}
