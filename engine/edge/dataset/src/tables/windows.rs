//! Table `windows`: what to learn from, cut from every flight (paper, section "Dual-Trajectory Augmentation").

use super::frames::{ROLES, role_cell};
use super::{Cell, Column, DatasetItem, Kind, Table};
use crate::action;
use crate::mcap_log::messages::edges_px;
use cosfly_frames::Pose;
use cosfly_metrics::difficulty::WindowFrames;
use cosfly_metrics::{Difficulty, WindowFeatures};
use cosfly_render::TargetView;
use std::ops::Range;

/// Class labels of difficulties.
pub const DIFFICULTIES: [&str; 3] = ["easy", "medium", "hard"];
/// Class labels of scenes.
pub const SCENES: [&str; 2] = ["seen", "unseen"];

/// An increment: from one pose to another.
type Step = fn(&Pose, &Pose) -> [f64; 6];

/// The table.
pub fn table() -> Table<DatasetItem> {
    Table {
        name: "windows",
        doc: "Training windows without pixels, one row per window: what the drone did (`input`), where its expert was \
              in the same frames (`correction`) and goes next (`waypoint_deltas`). Increments are dx, dy, dz (m), \
              dpitch, dyaw, droll (degrees), one after another: reshape lists to (-1, 6), boxes to (-1, 4).",
        key: &["window_id"],
        rows: |item| count(item),
        per_frame: true,
        rows_per_group: 10_000,
        reads_previews: false,
        reads_expert: true,
        columns: [identity(), kinds(), increments(), boxes()].into_iter().flatten().collect(),
    }
}

fn identity() -> Vec<Column<DatasetItem>> {
    vec![
        Column::new("window_id", Kind::Text, "`<trajectory_id>/<start_frame>`", |item, row| {
            format!("{}/{}", item.record.trajectory_id, start(item, row)).into()
        }),
        Column::new("trajectory_id", Kind::Text, "the flight that a model sees", |item, _| {
            (&item.record.trajectory_id).into()
        }),
        Column::new("expert_id", Kind::Text, "the flight that it learns; itself for an expert's window", |item, _| {
            item.record.pair.as_ref().map_or(&item.record.trajectory_id, |pair| &pair.expert_id).into()
        }),
        Column::new("role", Kind::Label(&ROLES), "of the flight that is seen", |item, _| role_cell(item.record.role)),
        Column::new("start_frame", Kind::Integer, "first frame of the window", |item, row| start(item, row).into()),
        Column::new("caption_ids", Kind::TextList, "its instructions: `captions.caption_id`", |item, _| {
            Cell::Texts((0..item.captions.len()).map(|place| super::captions::id(item, place)).collect())
        }),
        Column::new(
            "subset_rank",
            Kind::Real,
            "0..1, the same for all flights behind a pedestrian: windows below 0.25 are a quarter of all",
            |item, _| item.membership.subset_rank.into(),
        ),
    ]
}

fn kinds() -> Vec<Column<DatasetItem>> {
    vec![
        Column::new(
            "scene",
            Kind::Label(&SCENES),
            "seen: split `train` of this dataset has flights in the same town, by its ground plan",
            |item, _| scene_cell(item),
        ),
        Column::new(
            "difficulty",
            Kind::Label(&DIFFICULTIES),
            "hard from a turn of 90 degrees, a climb of 2.5 m, half of the frames occluded or 4 m/s on; easy below 30 \
             degrees, 0.5 m, 5 % and 2 m/s",
            |item, row| difficulty_cell(features(item, frames(item, row)).difficulty()),
        ),
        Column::new("turn_deg", Kind::Real, "turns of the target's walking direction added up", |item, row| {
            features(item, frames(item, row)).turn_deg.into()
        }),
        Column::new("height_change_m", Kind::Real, "highest minus lowest place of the expert", |item, row| {
            features(item, frames(item, row)).height_change_m.into()
        }),
        Column::new("occluded_share", Kind::Real, "frames in which the expert sees less than half", |item, row| {
            features(item, frames(item, row)).occluded_share.into()
        }),
        Column::new("speed_mps", Kind::Real, "mean speed of the expert", |item, row| {
            features(item, frames(item, row)).speed_mps.into()
        }),
        Column::new("target_is_static", Kind::Flag, "the target stays within half a metre", |item, row| {
            features(item, frames(item, row)).target_is_static().into()
        }),
        Column::new(
            "target_is_occluded",
            Kind::Flag,
            "rays reach less than half of the target in a frame of the input",
            |item, row| input(item, row).any(|frame| item.record.views[frame].visible_by_rays < 0.5).into(),
        ),
    ]
}

fn increments() -> Vec<Column<DatasetItem>> {
    vec![
        Column::new(
            "current_pose_in_world",
            Kind::Reals(6),
            "the last pose of the input: x, y, z (m), pitch, yaw, roll (degrees), CARLA's frame",
            |item, row| super::waypoints::pose_cell(current(item, row)),
        ),
        Column::new("input_steps_in_world", Kind::FloatList, "between the input's poses, world axes", |item, row| {
            input_steps(item, row, action::in_world)
        }),
        Column::new(
            "input_steps_in_body",
            Kind::FloatList,
            "the same in the body frame of the pose that each starts from: x ahead, y right, z up",
            |item, row| input_steps(item, row, action::in_body),
        ),
        Column::new(
            "correction_in_world",
            Kind::FloatList,
            "from each pose of the input to the expert's in the same frame (denoising); zeros for an expert",
            |item, row| correction(item, row, action::in_world),
        ),
        Column::new("correction_in_body", Kind::FloatList, "the same in the input's body frames", |item, row| {
            correction(item, row, action::in_body)
        }),
        Column::new(
            "waypoint_deltas_in_world",
            Kind::FloatList,
            "from the input's last pose to the expert's next one, and from there on along the expert (prediction): \
             what `cosfly eval` scores",
            |item, row| waypoint_deltas(item, row, action::in_world),
        ),
        Column::new(
            "waypoint_deltas_in_body",
            Kind::FloatList,
            "the same in the body frame of the pose that each starts from",
            |item, row| waypoint_deltas(item, row, action::in_body),
        ),
        Column::new(
            "expert_steps_in_world",
            Kind::FloatList,
            "between the expert's poses in all frames of the window",
            |item, row| expert_steps(item, row, action::in_world),
        ),
        Column::new("expert_steps_in_body", Kind::FloatList, "the same in the expert's body frames", |item, row| {
            expert_steps(item, row, action::in_body)
        }),
    ]
}

fn boxes() -> Vec<Column<DatasetItem>> {
    vec![
        Column::new(
            "input_boxes_px",
            Kind::FloatList,
            "left, top, right, bottom edge of the target's visible pixels in each picture of the input; zeros where it \
             is not seen",
            |item, row| Cell::Floats(input(item, row).flat_map(|frame| box_px(&item.record.views[frame])).collect()),
        ),
        Column::new(
            "expert_boxes_px",
            Kind::FloatList,
            "the same in the expert's pictures of all frames of the window",
            |item, row| Cell::Floats(frames(item, row).flat_map(|frame| box_px(expert_view(item, frame))).collect()),
        ),
    ]
}

/// Number of windows: none where the expert of a perturbed flight is not in the dataset.
pub fn count(item: &DatasetItem) -> usize {
    let perturbation = item.record.trajectory.perturbation.as_ref();
    let is_whole = match (&item.record.pair, &item.expert, perturbation) {
        (None, ..) => true,
        (Some(_), Some(expert), Some(it)) => it.frames.iter().all(|frame| (frame.expert_frame as usize) < expert.len()),
        _ => false,
    };
    if is_whole { item.windows.count(item.record.len()) } else { 0 }
}

fn start(item: &DatasetItem, row: usize) -> usize {
    row * item.windows.stride
}

fn frames(item: &DatasetItem, row: usize) -> Range<usize> {
    start(item, row)..start(item, row) + item.windows.size()
}

fn input(item: &DatasetItem, row: usize) -> Range<usize> {
    start(item, row)..start(item, row) + item.windows.history
}

/// The expert's frame of a frame; the flight itself for an expert.
fn expert_frame(item: &DatasetItem, frame: usize) -> usize {
    let perturbation = item.record.trajectory.perturbation.as_ref();
    perturbation.map_or(frame, |it| it.frames[frame].expert_frame as usize)
}

fn expert_pose(item: &DatasetItem, frame: usize) -> &Pose {
    let record = item.expert.as_deref().unwrap_or(&item.record);
    &record.trajectory.poses_in_world[expert_frame(item, frame)]
}

fn expert_view(item: &DatasetItem, frame: usize) -> &TargetView {
    let record = item.expert.as_deref().unwrap_or(&item.record);
    &record.views[expert_frame(item, frame)]
}

fn current(item: &DatasetItem, row: usize) -> &Pose {
    &item.record.trajectory.poses_in_world[input(item, row).end - 1]
}

/// What makes the frames easy or hard: the expert's flight, the target's walk.
pub fn features(item: &DatasetItem, frames: Range<usize>) -> WindowFeatures {
    let states = &item.record.trajectory.track.states[frames.clone()];
    let expert: Vec<Pose> = frames.clone().map(|frame| *expert_pose(item, frame)).collect();
    let visible: Vec<f64> = frames.map(|frame| expert_view(item, frame).visible_by_rays).collect();
    let feet: Vec<_> = states.iter().map(|state| state.feet_in_world).collect();
    let heading_rad: Vec<f64> = states.iter().map(|state| state.heading_rad).collect();
    let dt_s = item.record.dt_s();
    WindowFeatures::of(&WindowFrames {
        expert: &expert,
        feet: &feet,
        heading_rad: &heading_rad,
        visible: &visible,
        dt_s,
    })
}

/// Features of every window; of the whole flight when it is too short for one or has no expert here.
pub fn all_features(item: &DatasetItem) -> Vec<WindowFeatures> {
    match count(item) {
        0 if item.record.pair.is_none() || item.expert.is_some() => vec![features(item, 0..item.record.len())],
        0 => vec![],
        windows => (0..windows).map(|row| features(item, frames(item, row))).collect(),
    }
}

/// A difficulty as a class label.
pub fn difficulty_cell(difficulty: Difficulty) -> Cell {
    match difficulty {
        Difficulty::Easy => 0_u32,
        Difficulty::Medium => 1,
        Difficulty::Hard => 2,
    }
    .into()
}

/// Whether the town is seen in training, as a class label.
pub fn scene_cell(item: &DatasetItem) -> Cell {
    u32::from(!item.membership.is_seen).into()
}

fn input_steps(item: &DatasetItem, row: usize, step: Step) -> Cell {
    let poses = &item.record.trajectory.poses_in_world[input(item, row)];
    floats(poses.windows(2).map(|pair| step(&pair[0], &pair[1])))
}

fn correction(item: &DatasetItem, row: usize, step: Step) -> Cell {
    let poses = &item.record.trajectory.poses_in_world;
    floats(input(item, row).map(|frame| step(&poses[frame], expert_pose(item, frame))))
}

fn waypoint_deltas(item: &DatasetItem, row: usize, step: Step) -> Cell {
    let mut from = current(item, row);
    let ahead = input(item, row).end..frames(item, row).end;
    floats(ahead.map(|frame| step(std::mem::replace(&mut from, expert_pose(item, frame)), expert_pose(item, frame))))
}

fn expert_steps(item: &DatasetItem, row: usize, step: Step) -> Cell {
    let frames = frames(item, row);
    let later = frames.clone().skip(1);
    floats(frames.zip(later).map(|(from, to)| step(expert_pose(item, from), expert_pose(item, to))))
}

fn floats(steps: impl Iterator<Item = [f64; 6]>) -> Cell {
    Cell::Floats(steps.flatten().map(|number| number as f32).collect())
}

fn box_px(view: &TargetView) -> [f32; 4] {
    view.visible_box.as_ref().map_or([0.0; 4], |it| edges_px(it).map(|edge| edge as f32))
}
