//! Table `goals`: instructions of whole flights, steps, dialogues with a correction, and goals that do not fit.

use super::column::columns;
use super::{DatasetItem, GoalRow, Table};

/// Definition of the table.
pub fn table() -> Table<DatasetItem> {
    let doc = "Goals for the pilot at several grains, with every claim and its frames: of the whole flight, step by step, as a dialogue with a \
               correction, and goals in which one thing is not so; empty for targets that are no people on foot.";
    let rows = |item: &DatasetItem| item.derived.goals.len();
    Table::new("goals", doc, &["goal_id"], rows, Goals::COLUMNS)
}

/// Columns of table `goals`.
pub struct Goals;

columns! { Goals::COLUMNS of DatasetItem;
    /// Name of the goal: `<trajectory_id>/goal/<number>`.
    goal_id: String = |item, i| format!("{}/goal/{i}", item.record.trajectory_id);
    /// Trajectory that the goal is about.
    trajectory_id: String = |item, _| item.record.trajectory_id.clone();
    /// Split: `train`, `val` or `test`; that of the file.
    split: String = |item, _| item.membership.split.name().to_owned();
    /// Kind of goal: `flight`, `step`, `dialogue` or `negative`.
    grain: String = |item, i| goal(item, i).grain.clone();
    /// Language: `zh` or `en`.
    language: String = |item, i| goal(item, i).language.clone();
    /// First frame of the stretch that the goal is about.
    start_frame: u32 = |item, i| goal(item, i).frames.start as u32;
    /// Frame after the last one of the stretch.
    end_frame: u32 = |item, i| goal(item, i).frames.end as u32;
    /// Lines: one, or three of a dialogue: the user's, the pilot's, and the user's correction.
    lines: Vec<String> = |item, i| goal(item, i).lines.clone();
    /// Whether the flight does what the goal says: all but `negative`.
    fits: bool = |item, i| goal(item, i).fits;
    /// Subject of what is not so: of a negative, of one claim; of a dialogue, of the pilot's line. `clothes`, `distance`, `turn`, `stop`,
    /// `landmark`, `sight`, `people` or `vehicles`; null otherwise.
    false_subject: Option<String> = |item, i| goal(item, i).false_subject.clone();
    /// What the user says in the end, claim by claim with its frames, such as `passes tree left 2 @ 12..40` (the end is the frame after the
    /// last one): `wears`, `distance` (mean, metres), `turns`, `turns_in_all`, `no_turn`, `stops` (seconds), `stands`, `passes`, `crosses`,
    /// `lost`, `partly_hidden`, `walks_with`, `meets`, `overtakes`, `meets_vehicle`, `overtaken_by`. `passes ... after_crossing`: counted from the
    /// only crossing of the stretch on.
    claims: Vec<String> = |item, i| goal(item, i).claims.clone();
}

fn goal(item: &DatasetItem, i: usize) -> &GoalRow {
    &item.derived.goals[i]
}
