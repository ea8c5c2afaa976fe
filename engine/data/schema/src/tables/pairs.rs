//! Table `pairs`: one row per expert and perturbed twin, with the alignment of their frames.

use super::column::columns;
use super::{DatasetItem, Table};
use cosfly_domain::{FramePerturbation, Perturbation};

/// Definition of the table.
pub fn table() -> Table<DatasetItem> {
    let doc = "Expert and perturbed trajectories behind the same pedestrian, aligned frame by frame.";
    let rows = |item: &DatasetItem| usize::from(item.record.pair.is_some());
    Table { rows_per_group: 10_000, ..Table::new("pairs", doc, &["perturbed_id"], rows, Pairs::COLUMNS) }
}

/// Columns of table `pairs`.
pub struct Pairs;

columns! { Pairs::COLUMNS of DatasetItem;
    /// The perturbed trajectory.
    perturbed_id: String = |item, _| item.record.trajectory_id.clone();
    /// Expert of the perturbed trajectory.
    expert_id: String = |item, _| item.record.pair.as_ref().map_or_else(String::new, |pair| pair.expert_id.clone());
    /// Pedestrian followed by both.
    pedestrian_id: String = |item, _| item.record.pedestrian_id.clone();
    /// Name of the town of both.
    town: String = |item, _| item.record.town.name.clone();
    /// Split: `train`, `val` or `test`; that of the file.
    split: String = |item, _| item.membership.split.name().to_owned();
    /// Number of frames of the perturbed trajectory.
    frames: u32 = |item, _| item.record.len() as u32;
    /// Kind of the perturbation, such as `jumps` (the paper's) or `drift`.
    perturbation: Option<String> = |item, _| perturbation(item).map(|it| it.kind.name().to_owned());
    /// Probability of the position event per frame; null for kinds of perturbation but `jumps`.
    position_probability: Option<f64> = |item, _| jumps(item).map(|it| it.position_probability);
    /// Probability of the rotation event per frame; null for kinds of perturbation but `jumps`.
    rotation_probability: Option<f64> = |item, _| jumps(item).map(|it| it.rotation_probability);
    /// Number of frames with a position event.
    position_events: u32 = |item, _| events(item).filter(|frame| frame.position).count() as u32;
    /// Number of frames with a rotation event.
    rotation_events: u32 = |item, _| events(item).filter(|frame| frame.rotation).count() as u32;
    /// Largest displacement of the drone.
    max_offset_m: f64 = |item, _| events(item).map(|frame| frame.drone_offset_in_world.length()).fold(0.0, f64::max);
    /// Frame of the expert for each frame.
    expert_frames: Vec<i64> = |item, _| events(item).map(|frame| i64::from(frame.expert_frame)).collect();
}

fn perturbation(item: &DatasetItem) -> Option<&Perturbation> {
    item.record.trajectory.perturbation.as_ref()
}

fn jumps(item: &DatasetItem) -> Option<&Perturbation> {
    perturbation(item).filter(|it| !it.kind.is_flyable())
}

fn events(item: &DatasetItem) -> impl Iterator<Item = &FramePerturbation> {
    perturbation(item).into_iter().flat_map(|it| &it.frames)
}
