//! Table `windows`: training windows of every flight (paper, section "Dual-Trajectory Augmentation").

use super::column::columns;
use super::value::class_value;
use super::{DatasetItem, Need, Table};
use crate::Role;
use crate::log::messages::edges_px;
use cosfly_domain::TargetView;
use cosfly_frames::{Pose, action};
use cosfly_windows::{Difficulty, WindowFeatures, WindowFrames};
use std::ops::Range;

/// Whether the town is part of the training data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SceneMembership {
    /// Split `train` has trajectories in the same town.
    Seen,
    /// Split `train` has none.
    Unseen,
}

/// Class labels of scenes.
pub const SCENES: [&str; 2] = ["seen", "unseen"];
/// Class labels of difficulties.
pub const DIFFICULTIES: [&str; 3] = ["easy", "medium", "hard"];

class_value!(SceneMembership, [SceneMembership::Seen, SceneMembership::Unseen], SCENES);
class_value!(Difficulty, [Difficulty::Easy, Difficulty::Medium, Difficulty::Hard], DIFFICULTIES);

/// Increment from one pose to another.
type Step = fn(&Pose, &Pose) -> [f64; 6];

/// Definition of the table.
pub fn table() -> Table<DatasetItem> {
    let doc = "Training windows without pixels, one row per window: what the drone did (`input`), where its expert was \
               in the same frames (`correction`) and goes next (`waypoint_deltas`). Increments are dx, dy, dz (m), \
               dpitch, dyaw, droll (degrees), one after another: reshape lists to (-1, 6), boxes to (-1, 4).";
    let (per_frame, rows_per_group, needs) = (true, 10_000, &[Need::Expert][..]);
    let table = Table::new("windows", doc, &["window_id"], count, Windows::COLUMNS);
    Table { per_frame, rows_per_group, needs, ..table }
}

/// Columns of table `windows`.
pub struct Windows;

columns! { Windows::COLUMNS of DatasetItem;
    /// Name of the window: `<trajectory_id>/<start_frame>`.
    window_id: String = |item, row| format!("{}/{}", item.record.trajectory_id, start(item, row));
    /// Trajectory that is the input of a model.
    trajectory_id: String = |item, _| item.record.trajectory_id.clone();
    /// Split: `train`, `val` or `test`; that of the file.
    split: String = |item, _| item.membership.split.name().to_owned();
    /// Trajectory that a model learns: the expert of `trajectory_id`; the trajectory itself for an expert's window.
    expert_id: String = |item, _| {
        item.record.pair.as_ref().map_or(&item.record.trajectory_id, |pair| &pair.expert_id).clone()
    };
    /// Role of the input trajectory.
    role: Role = |item, _| item.record.role;
    /// First frame of the window.
    start_frame: u32 = |item, row| start(item, row) as u32;
    /// Instructions of the trajectory: `captions.caption_id`.
    caption_ids: Vec<String> = |item, _| (0..item.captions.len()).map(|place| super::captions::id(item, place)).collect();
    /// Instruction in English that singles the target out in the last picture of the input: by its clothes, the people around it,
    /// its way across the picture, a landmark that it passes. Left, middle and right of the picture are those of table `phrases`.
    /// Of a target that is not on foot (vehicles, wheelchairs, people on chairs) it is the phrase that singles it out there, as in
    /// table `phrases`; empty where none does, and for a target without a body.
    instruction_en: String = |item, row| item.derived.instructions[row][0].clone();
    /// The same in Chinese, in words of its own.
    instruction_zh: String = |item, row| item.derived.instructions[row][1].clone();
    /// Rank in nested subsets, 0..1, the same for all trajectories behind a pedestrian: windows below 0.25 are a
    /// quarter of all.
    subset_rank: f64 = |item, _| item.membership.subset_rank;

    /// Seen: split `train` of this dataset has trajectories in the same town, by the town's ground plan.
    scene: SceneMembership = |item, _| scene_of(item);
    /// Hard: a turn of at least 90 degrees, a height change of at least 2.5 m, at least half of the frames occluded, or
    /// at least 4 m/s; easy: below 30 degrees, 0.5 m, 5 % and 2 m/s.
    difficulty: Difficulty = |item, row| features(item, frames(item, row)).difficulty();
    /// Sum of the turns of the target's walking direction.
    turn_deg: f64 = |item, row| features(item, frames(item, row)).turn_deg;
    /// Difference of the highest and lowest position of the expert.
    height_change_m: f64 = |item, row| features(item, frames(item, row)).height_change_m;
    /// Share of frames in which the expert sees less than half of the target, 0..1.
    occluded_share: f64 = |item, row| features(item, frames(item, row)).occluded_share;
    /// Mean speed of the expert.
    speed_mps: f64 = |item, row| features(item, frames(item, row)).speed_mps;
    /// Whether the target stays within half a metre.
    target_is_static: bool = |item, row| features(item, frames(item, row)).target_is_static();
    /// Whether rays reach less than half of the target in a frame of the input.
    target_is_occluded: bool = |item, row| {
        input(item, row).any(|frame| item.record.views[frame].visible_by_rays < 0.5)
    };

    /// Last pose of the input, world frame (CARLA's): x, y, z (m), pitch, yaw, roll (degrees).
    current_pose_in_world: [f64; 6] = |item, row| super::waypoints::pose_numbers(current(item, row));
    /// Steps between the input's poses along the world's axes.
    input_steps_in_world: Vec<f32> = |item, row| input_steps(item, row, action::in_world);
    /// Steps between the input's poses in the body frame of the pose where each starts: x ahead, y right, z up.
    input_steps_in_body: Vec<f32> = |item, row| input_steps(item, row, action::in_body);
    /// Step from each pose of the input to the expert's in the same frame, along the world's axes (denoising); zeros for an
    /// expert.
    correction_in_world: Vec<f32> = |item, row| correction(item, row, action::in_world);
    /// Step from each pose of the input to the expert's in the same frame, in the body frame of the input's pose.
    correction_in_body: Vec<f32> = |item, row| correction(item, row, action::in_body);
    /// Steps from the input's last pose to the expert's next one, and from there on along the expert, along the world's axes
    /// (prediction): the target of `cosfly eval`.
    waypoint_deltas_in_world: Vec<f32> = |item, row| waypoint_deltas(item, row, action::in_world);
    /// Steps from the input's last pose to the expert's next one, and from there on along the expert, in the body frame
    /// of the pose where each starts.
    waypoint_deltas_in_body: Vec<f32> = |item, row| waypoint_deltas(item, row, action::in_body);
    /// Steps between the expert's poses in all frames of the window, along the world's axes.
    expert_steps_in_world: Vec<f32> = |item, row| expert_steps(item, row, action::in_world);
    /// Steps between the expert's poses in all frames of the window, in the expert's body frames.
    expert_steps_in_body: Vec<f32> = |item, row| expert_steps(item, row, action::in_body);

    /// Left, top, right, bottom edge of the target's visible pixels in each picture of the input; zeros where the
    /// target is not visible.
    input_boxes_px: Vec<f32> = |item, row| {
        input(item, row).flat_map(|frame| box_px(&item.record.views[frame])).collect()
    };
    /// Left, top, right, bottom edge of the target's visible pixels in the expert's pictures of all frames of the
    /// window; zeros where the target is not visible.
    expert_boxes_px: Vec<f32> = |item, row| {
        frames(item, row).flat_map(|frame| box_px(expert_view(item, frame))).collect()
    };
}

/// Number of windows; 0 where the expert of a perturbed flight is not in the dataset.
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

/// Frame of the expert that belongs to a frame; the frame itself for an expert.
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

/// Last frame of the input.
fn current_frame(item: &DatasetItem, row: usize) -> usize {
    input(item, row).end - 1
}

fn current(item: &DatasetItem, row: usize) -> &Pose {
    &item.record.trajectory.poses_in_world[current_frame(item, row)]
}

/// Difficulty features of the frames: the expert's flight and the target's walk.
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

/// Features of every window; of the whole flight when it is too short for a window or its expert is missing.
pub fn all_features(item: &DatasetItem) -> Vec<WindowFeatures> {
    match count(item) {
        0 if item.record.pair.is_none() || item.expert.is_some() => vec![features(item, 0..item.record.len())],
        0 => vec![],
        windows => (0..windows).map(|row| features(item, frames(item, row))).collect(),
    }
}

/// Whether the town of a trajectory is part of the training data.
pub fn scene_of(item: &DatasetItem) -> SceneMembership {
    if item.membership.is_seen { SceneMembership::Seen } else { SceneMembership::Unseen }
}

fn input_steps(item: &DatasetItem, row: usize, step: Step) -> Vec<f32> {
    let poses = &item.record.trajectory.poses_in_world[input(item, row)];
    floats(poses.windows(2).map(|pair| step(&pair[0], &pair[1])))
}

fn correction(item: &DatasetItem, row: usize, step: Step) -> Vec<f32> {
    let poses = &item.record.trajectory.poses_in_world;
    floats(input(item, row).map(|frame| step(&poses[frame], expert_pose(item, frame))))
}

fn waypoint_deltas(item: &DatasetItem, row: usize, step: Step) -> Vec<f32> {
    let mut from = current(item, row);
    let ahead = input(item, row).end..frames(item, row).end;
    floats(ahead.map(|frame| step(std::mem::replace(&mut from, expert_pose(item, frame)), expert_pose(item, frame))))
}

fn expert_steps(item: &DatasetItem, row: usize, step: Step) -> Vec<f32> {
    let frames = frames(item, row);
    let later = frames.clone().skip(1);
    floats(frames.zip(later).map(|(from, to)| step(expert_pose(item, from), expert_pose(item, to))))
}

fn floats(steps: impl Iterator<Item = [f64; 6]>) -> Vec<f32> {
    steps.flatten().map(|number| number as f32).collect()
}

fn box_px(view: &TargetView) -> [f32; 4] {
    view.visible_box.as_ref().map_or([0.0; 4], |it| edges_px(it).map(|edge| edge as f32))
}
