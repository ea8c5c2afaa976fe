//! Table `rejected`: items without a trajectory, with the reason.

use super::Table;
use super::column::columns;
use crate::Rejection;

/// Definition of the table.
pub fn table() -> Table<Rejection> {
    let doc = "Items without a trajectory, with the reason.";
    Table::new("rejected", doc, &["trajectory_id"], |_: &Rejection| 1, Rejected::COLUMNS)
}

/// Columns of table `rejected`.
pub struct Rejected;

columns! { Rejected::COLUMNS of Rejection;
    /// Id that the trajectory would have had.
    trajectory_id: String = |it, _| it.trajectory_id.clone();
    /// Stage of the recipe that rejected the item.
    stage: String = |it, _| it.stage.clone();
    /// Pedestrian who would have been followed.
    pedestrian_id: String = |it, _| it.pedestrian_id.clone();
    /// Name of the town.
    town: String = |it, _| it.town.clone();
    /// Reason, in words.
    reason: String = |it, _| it.reason.clone();
}
