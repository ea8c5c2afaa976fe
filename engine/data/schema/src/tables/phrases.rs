//! Table `phrases`: referring phrases, unique where they are given, and the bodies that they fit in every frame.

use super::column::columns;
use super::{DatasetItem, PhraseRow, Table};

/// Definition of the table.
pub fn table() -> Table<DatasetItem> {
    let doc = "Phrases that single the target out among all visible bodies of the frame in which they are given, one in ten seconds.";
    let rows = |item: &DatasetItem| item.derived.phrases.len();
    Table::new("phrases", doc, &["trajectory_id", "frame"], rows, Phrases::COLUMNS)
}

/// Columns of table `phrases`.
pub struct Phrases;

columns! { Phrases::COLUMNS of DatasetItem;
    /// Trajectory that the phrase belongs to.
    trajectory_id: String = |item, _| item.record.trajectory_id.clone();
    /// Split: `train`, `val` or `test`; that of the file.
    split: String = |item, _| item.membership.split.name().to_owned();
    /// Frame in which the phrase is given: it fits the target and no other visible body there.
    frame: u32 = |item, i| given(item, i).frame as u32;
    /// The phrase in English.
    text_en: String = |item, i| given(item, i).text_en.clone();
    /// The phrase in Chinese.
    text_zh: String = |item, i| given(item, i).text_zh.clone();
    /// Named properties: `top`, `trousers`, `backpack`, `shoulder_bag`, `motion` (moving at 0.4 m/s or more, standing at 0.05 m/s or less) and
    /// `part` (of the picture's width: left of 0.3, 0.4 to 0.6, right of 0.7).
    properties: Vec<String> = |item, i| given(item, i).properties.clone();
    /// Number of visible bodies, with the target, that the phrase may fit, by frame; between the limits of `motion` and `part`
    /// it may fit.
    candidates: Vec<i64> = |item, i| given(item, i).candidates.iter().map(|count| i64::from(*count)).collect();
    /// The number 1 where the target is visible and the phrase may fit it, else 0, by frame; unique where `candidates` is 1, too.
    fits_target: Vec<i64> = |item, i| given(item, i).fits_target.iter().map(|fits| i64::from(*fits)).collect();
}

fn given(item: &DatasetItem, i: usize) -> &PhraseRow {
    &item.derived.phrases[i]
}
