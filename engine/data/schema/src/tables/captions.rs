//! Table `captions`: one row per instruction.

use super::column::columns;
use super::{DatasetItem, Table};

/// Definition of the table.
pub fn table() -> Table<DatasetItem> {
    let doc = "Instructions in Chinese and English, checked against the facts of the trajectory.";
    let key = &["trajectory_id", "language", "style"];
    Table::new("captions", doc, key, |item: &DatasetItem| item.captions.len(), Captions::COLUMNS)
}

/// Columns of table `captions`.
pub struct Captions;

columns! { Captions::COLUMNS of DatasetItem;
    /// Name of the caption: `<trajectory_id>/<language>/<number>`.
    caption_id: String = id;
    /// Trajectory that the caption describes.
    trajectory_id: String = |item, _| item.record.trajectory_id.clone();
    /// Split: `train`, `val` or `test`; that of the file.
    split: String = |item, _| item.membership.split.name().to_owned();
    /// Language: `zh` or `en`.
    language: String = |item, i| item.captions[i].language.clone();
    /// Kind of text, such as `instruction`.
    style: String = |item, i| item.captions[i].style.clone();
    /// The instruction.
    text: String = |item, i| item.captions[i].text.clone();
}

/// Caption id, unique in the dataset: the number counts the trajectory's captions in all languages.
pub fn id(item: &DatasetItem, place: usize) -> String {
    format!("{}/{}/{place}", item.record.trajectory_id, item.captions[place].language)
}
