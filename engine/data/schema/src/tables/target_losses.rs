//! Table `target_losses`: intervals without sight of the target.

use super::column::columns;
use super::{DatasetItem, Table};
use crate::losses::Loss;

/// Definition of the table.
pub fn table() -> Table<DatasetItem> {
    let doc = "Intervals in which no pixel of the target is visible, with cause and end; empty where the target is always seen.";
    let rows = |item: &DatasetItem| item.derived.losses.len();
    Table::new("target_losses", doc, &["trajectory_id", "start_frame"], rows, TargetLosses::COLUMNS)
}

/// Columns of table `target_losses`.
pub struct TargetLosses;

columns! { TargetLosses::COLUMNS of DatasetItem;
    /// Trajectory that the interval belongs to.
    trajectory_id: String = |item, _| item.record.trajectory_id.clone();
    /// Split: `train`, `val` or `test`; that of the file.
    split: String = |item, _| item.membership.split.name().to_owned();
    /// First frame without a visible pixel of the target.
    start_frame: u32 = |item, i| loss(item, i).frames.start as u32;
    /// Frame after the last one without a visible pixel of the target.
    end_frame: u32 = |item, i| loss(item, i).frames.end as u32;
    /// Length of the interval, `(end_frame - start_frame) * dt_s`.
    duration_s: f64 = |item, i| loss(item, i).frames.len() as f64 * item.record.dt_s();
    /// Instance id of what hides the target in most frames, see tables `objects` and `bodies`; 0: the ground, or the target is
    /// outside of the image.
    cause_instance: u32 = |item, i| loss(item, i).cause_instance;
    /// Number of frames in which the target is outside of the image.
    frames_out_of_view: u32 = |item, i| loss(item, i).frames_out_of_view as u32;
    /// Whether the flight sees the target again before its end.
    reacquired: bool = |item, i| loss(item, i).is_reacquired(&item.record);
    /// Number of other visible bodies in the target's clothes in the frame in which it is seen again; null where it is not.
    look_alikes: Option<u32> = |item, i| {
        let loss = loss(item, i);
        loss.is_reacquired(&item.record).then(|| item.record.look_alikes(loss.frames.end) as u32)
    };
}

fn loss(item: &DatasetItem, i: usize) -> &Loss {
    &item.derived.losses[i]
}
