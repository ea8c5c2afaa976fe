//! Table `captions`: one row per instruction.

use super::{Column, DatasetItem, Kind, Table};

/// The table.
pub fn table() -> Table<DatasetItem> {
    Table {
        name: "captions",
        doc: "Instructions in Chinese and English, checked against the facts of the flight.",
        key: &["trajectory_id", "language", "style"],
        rows: |item| item.captions.len(),
        per_frame: false,
        rows_per_group: 50_000,
        reads_previews: false,
        reads_expert: false,
        columns: vec![
            Column::new("caption_id", Kind::Text, "`<trajectory_id>/<language>/<number>`", |item, i| {
                id(item, i).into()
            }),
            Column::new("trajectory_id", Kind::Text, "the flight", |item, _| (&item.record.trajectory_id).into()),
            Column::new("language", Kind::Text, "`zh` or `en`", |item, i| (&item.captions[i].language).into()),
            Column::new("style", Kind::Text, "kind of text", |item, i| (&item.captions[i].style).into()),
            Column::new("text", Kind::Text, "the instruction", |item, i| (&item.captions[i].text).into()),
        ],
    }
}

/// Unique in the dataset: the number counts the flight's captions in all languages.
pub fn id(item: &DatasetItem, place: usize) -> String {
    format!("{}/{}/{place}", item.record.trajectory_id, item.captions[place].language)
}
