//! Table `pairs`: one row per expert and perturbed twin, with the alignment of their frames.

use super::{Cell, Column, DatasetItem, Kind, Table};
use cosfly_planner::{FramePerturbation, Perturbation};

/// The table.
pub fn table() -> Table<DatasetItem> {
    Table {
        name: "pairs",
        doc: "Expert and perturbed twin flights behind the same pedestrian, aligned frame by frame.",
        key: &["perturbed_id"],
        rows: |item| usize::from(item.record.pair.is_some()),
        per_frame: false,
        rows_per_group: 10_000,
        reads_previews: false,
        reads_expert: false,
        columns: vec![
            Column::new("perturbed_id", Kind::Text, "the perturbed flight", |item, _| {
                (&item.record.trajectory_id).into()
            }),
            Column::new("expert_id", Kind::Text, "the expert flight it departs from", |item, _| {
                item.record.pair.as_ref().map(|pair| &pair.expert_id).into()
            }),
            Column::new("pedestrian_id", Kind::Text, "the pedestrian of both", |item, _| {
                (&item.record.pedestrian_id).into()
            }),
            Column::new("town", Kind::Text, "the town of both", |item, _| (&item.record.town.name).into()),
            Column::new("frames", Kind::Integer, "frames of the perturbed flight", |item, _| item.record.len().into()),
            Column::optional(
                "position_probability",
                Kind::Real,
                "probability of the position event per frame",
                |item, _| perturbation(item).map(|it| it.position_probability).into(),
            ),
            Column::optional(
                "rotation_probability",
                Kind::Real,
                "probability of the rotation event per frame",
                |item, _| perturbation(item).map(|it| it.rotation_probability).into(),
            ),
            Column::new("position_events", Kind::Integer, "frames with a position event", |item, _| {
                events(item).filter(|frame| frame.position).count().into()
            }),
            Column::new("rotation_events", Kind::Integer, "frames with a rotation event", |item, _| {
                events(item).filter(|frame| frame.rotation).count().into()
            }),
            Column::new("max_offset_m", Kind::Real, "largest displacement of the drone", |item, _| {
                events(item).map(|frame| frame.drone_offset_in_world.length()).fold(0.0, f64::max).into()
            }),
            Column::new("expert_frames", Kind::IntegerList, "the expert's frame of each frame", |item, _| {
                Cell::Integers(events(item).map(|frame| i64::from(frame.expert_frame)).collect())
            }),
        ],
    }
}

fn perturbation(item: &DatasetItem) -> Option<&Perturbation> {
    item.record.trajectory.perturbation.as_ref()
}

fn events(item: &DatasetItem) -> impl Iterator<Item = &FramePerturbation> {
    perturbation(item).into_iter().flat_map(|it| &it.frames)
}
