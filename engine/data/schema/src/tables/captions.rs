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
    /// Who wrote it: `template`, or `teacher` for a language model.
    writer: String = |item, i| item.captions[i].writer.clone();
    /// Language model that was asked for the text; null where none was.
    model: Option<String> = |item, i| item.captions[i].model.clone();
    /// Version of the prompt; null where no model was asked.
    prompt_version: Option<u32> = |item, i| item.captions[i].prompt_version;
    /// Number of the model's answers that were compared with the facts.
    attempts: u32 = |item, i| item.captions[i].attempts;
    /// Why a template wrote it although a model was asked: `lost: ...` or `refused`; null otherwise.
    fallback: Option<String> = |item, i| item.captions[i].fallback.clone();
    /// Subjects that the text speaks of, each compared with the facts and true, such as `distance`.
    verdicts: Vec<String> = |item, i| item.captions[i].verdicts.clone();
    /// Answers of the model that were refused before, in order.
    refused: Vec<String> = |item, i| item.captions[i].refused.clone();
    /// Contradictions for which they were refused.
    refused_because: Vec<String> = |item, i| item.captions[i].refused_because.clone();
}

/// Caption id, unique in the dataset: the number counts the trajectory's captions in all languages.
pub fn id(item: &DatasetItem, place: usize) -> String {
    format!("{}/{}/{place}", item.record.trajectory_id, item.captions[place].language)
}
