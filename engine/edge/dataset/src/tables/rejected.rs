//! Table `rejected`: items that gave no flight, with the reason.

use super::{Column, Kind, Table};
use crate::Rejection;

/// The table.
pub fn table() -> Table<Rejection> {
    Table {
        name: "rejected",
        doc: "Items that gave no flight, with the reason: never a silent gap.",
        key: &["trajectory_id"],
        rows: |_| 1,
        per_frame: false,
        rows_per_group: 50_000,
        reads_previews: false,
        reads_expert: false,
        columns: vec![
            Column::new("trajectory_id", Kind::Text, "the id the flight would have had", |it, _| {
                (&it.trajectory_id).into()
            }),
            Column::new("stage", Kind::Text, "recipe stage that rejected it", |it, _| (&it.stage).into()),
            Column::new("pedestrian_id", Kind::Text, "the pedestrian", |it, _| (&it.pedestrian_id).into()),
            Column::new("town", Kind::Text, "the town", |it, _| (&it.town).into()),
            Column::new("reason", Kind::Text, "why, in words", |it, _| (&it.reason).into()),
        ],
    }
}
