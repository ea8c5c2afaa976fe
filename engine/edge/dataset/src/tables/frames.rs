//! Table `frames`: one row per image, with pose, target, visibility, boxes, action and a small preview.

use super::waypoints::step;
use super::{Cell, Column, DatasetItem, Kind, Table};
use crate::Role;
use crate::action;
use crate::flight_labels;
use crate::mcap_log::messages::edges_px;
use cosfly_frames::{Pose, TargetState};
use cosfly_planner::FramePerturbation;
use cosfly_render::{PixelBox, TargetView};

/// The table. Previews make its rows heavy, so few of them are kept together.
pub fn table() -> Table<DatasetItem> {
    let mut columns = identity();
    columns.extend(drone());
    columns.extend(target());
    columns.extend(view());
    columns.extend(motion());
    columns.extend(disturbance());
    columns.push(Column::optional("preview", Kind::Image, "the colour image, 320 pixels wide", |item, i| {
        item.previews.jpegs.get(i).cloned().into()
    }));
    Table {
        name: "frames",
        doc: "One row per image: camera pose, target state, visibility, boxes, action, disturbance, small preview.",
        key: &["trajectory_id", "frame"],
        rows: |item| item.record.len(),
        per_frame: true,
        rows_per_group: 200,
        reads_previews: true,
        reads_expert: false,
        columns,
    }
}

/// The class names of `role`.
pub const ROLES: [&str; 2] = ["expert", "perturbed"];

/// The class number of a role.
pub fn role_cell(role: Role) -> Cell {
    Role::ALL.iter().position(|it| *it == role).into()
}

fn identity() -> Vec<Column<DatasetItem>> {
    vec![
        Column::new("trajectory_id", Kind::Text, "the flight", |item, _| (&item.record.trajectory_id).into()),
        Column::new("frame", Kind::Integer, "frame, from 0", |_, i| i.into()),
        Column::new("time_s", Kind::Real, "frame * dt; the time in the log", |item, i| {
            (i as f64 * item.record.dt_s()).into()
        }),
        Column::new("role", Kind::Label(&ROLES), "expert or perturbed", |item, _| role_cell(item.record.role)),
    ]
}

fn drone() -> Vec<Column<DatasetItem>> {
    vec![
        Column::new("drone_x_m", Kind::Real, "position of drone and camera, CARLA's frame: x east", |item, i| {
            pose(item, i).position_in_world.x.into()
        }),
        Column::new("drone_y_m", Kind::Real, "y south (left-handed)", |item, i| {
            pose(item, i).position_in_world.y.into()
        }),
        Column::new("drone_z_m", Kind::Real, "z up", |item, i| pose(item, i).position_in_world.z.into()),
        Column::new("drone_pitch_deg", Kind::Real, "the drone's; positive: nose up", |item, i| {
            pose(item, i).pitch_rad.to_degrees().into()
        }),
        Column::new("drone_yaw_deg", Kind::Real, "positive: x towards y", |item, i| {
            pose(item, i).yaw_rad.to_degrees().into()
        }),
        Column::new("drone_roll_deg", Kind::Real, "positive: right side down", |item, i| {
            pose(item, i).roll_rad.to_degrees().into()
        }),
        Column::new(
            "camera_pitch_deg",
            Kind::Real,
            "attitude of the camera that took the images; the drone's turned by the mount in `trajectories`",
            |item, i| item.record.camera_pose(i).pitch_rad.to_degrees().into(),
        ),
        Column::new("camera_yaw_deg", Kind::Real, "as `drone_yaw_deg`, of the camera", |item, i| {
            item.record.camera_pose(i).yaw_rad.to_degrees().into()
        }),
        Column::new("camera_roll_deg", Kind::Real, "as `drone_roll_deg`, of the camera", |item, i| {
            item.record.camera_pose(i).roll_rad.to_degrees().into()
        }),
    ]
}

fn target() -> Vec<Column<DatasetItem>> {
    vec![
        Column::new("target_x_m", Kind::Real, "ground point between the feet, CARLA's frame", |item, i| {
            state(item, i).feet_in_world.x.into()
        }),
        Column::new("target_y_m", Kind::Real, "y of the feet", |item, i| state(item, i).feet_in_world.y.into()),
        Column::new("target_z_m", Kind::Real, "z of the feet", |item, i| state(item, i).feet_in_world.z.into()),
        Column::new("target_heading_deg", Kind::Real, "walking direction, as yaw; kept while standing", |item, i| {
            state(item, i).heading_rad.to_degrees().into()
        }),
        Column::new("target_speed_mps", Kind::Real, "speed along the ground; 0 while standing", |item, i| {
            state(item, i).speed_mps.into()
        }),
        Column::new("distance_m", Kind::Real, "from the camera to the feet", |item, i| {
            item.record.distance_m(i).into()
        }),
        Column::new("clearance_m", Kind::Real, "from the drone to the nearest obstacle, at most 50", |item, i| {
            item.record.trajectory.clearance_m[i].into()
        }),
    ]
}

fn view() -> Vec<Column<DatasetItem>> {
    vec![
        Column::new(
            "in_view",
            Kind::Flag,
            "the body covers at least one pixel centre of the image, occluded or not",
            |item, i| view_of(item, i).in_view.into(),
        ),
        Column::new("visible_by_rays", Kind::Real, "share of body points reached by unoccluded rays", |item, i| {
            view_of(item, i).visible_by_rays.into()
        }),
        Column::new(
            "visible_by_pixels",
            Kind::Real,
            "visible pixels / pixels without obstacles, inside the image; 0 out of view",
            |item, i| view_of(item, i).visible_by_pixels.into(),
        ),
        Column::optional(
            "visible_by_dense_rays",
            Kind::Real,
            "share that some 400 rays to the body inside the image reach, apart from the renderer; null when out of view",
            |item, i| item.record.visible_by_dense_rays[i].into(),
        ),
        Column::new("visible_pixels", Kind::Integer, "visible pixels of the target", |item, i| {
            view_of(item, i).pixels.into()
        }),
        Column::optional(
            "visible_box_px",
            Kind::Box,
            "left, top, right, bottom edges around the visible pixels; null when none is visible",
            |item, i| edges(view_of(item, i).visible_box.as_ref()),
        ),
        Column::optional("full_box_px", Kind::Box, "the same without obstacles; null when out of view", |item, i| {
            edges(view_of(item, i).full_box.as_ref())
        }),
        Column::new(
            "occluder_instance",
            Kind::Integer,
            "instance id of what hides most of it, see tables `objects` and `people`; 0: nothing, or only ground",
            |item, i| view_of(item, i).occluder_instance.into(),
        ),
    ]
}

fn motion() -> Vec<Column<DatasetItem>> {
    vec![
        Column::optional(
            "action_in_world",
            Kind::Reals(6),
            "dx, dy, dz (m), dpitch, dyaw, droll (degrees) to the next frame along the world's axes; null on the last",
            |item, i| step(item, i, action::in_world),
        ),
        Column::optional(
            "action_in_body",
            Kind::Reals(6),
            "the next pose in the body frame of this one (x ahead, y right, z up), m and degrees; null on the last",
            |item, i| step(item, i, action::in_body),
        ),
        Column::new(
            "term_costs",
            Kind::RealList,
            "unweighted cost of each planner term, in the order of `trajectories.term_names`; empty for perturbed flights",
            |item, i| {
                Cell::Reals(flight_labels::costs(&item.record.trajectory).map(|term| term.per_frame[i]).collect())
            },
        ),
        Column::new(
            "labels",
            Kind::RealList,
            "labels that plugins gave to the frame, in the order of `trajectories.label_names`; empty where none did",
            |item, i| {
                Cell::Reals(flight_labels::labels(&item.record.trajectory).map(|label| label.per_frame[i]).collect())
            },
        ),
    ]
}

fn disturbance() -> Vec<Column<DatasetItem>> {
    vec![
        Column::optional("expert_frame", Kind::Integer, "frame of the expert; null for experts", |item, i| {
            event(item, i).map(|event| event.expert_frame).into()
        }),
        Column::optional("position_event", Kind::Flag, "the position was disturbed; null for experts", |item, i| {
            event(item, i).map(|event| event.position).into()
        }),
        Column::optional("rotation_event", Kind::Flag, "the rotation was disturbed; null for experts", |item, i| {
            event(item, i).map(|event| event.rotation).into()
        }),
        Column::optional("drone_offset_in_world_m", Kind::Reals(3), "displacement of the drone", |item, i| {
            event(item, i).map(|event| event.drone_offset_in_world).into()
        }),
        Column::optional("aim_offset_in_world_m", Kind::Reals(3), "displacement of the point aimed at", |item, i| {
            event(item, i).map(|event| event.aim_offset_in_world).into()
        }),
        Column::optional("pitch_offset_deg", Kind::Real, "turn added to the pitch", |item, i| {
            event(item, i).map(|event| event.pitch_offset_rad.to_degrees()).into()
        }),
        Column::optional("yaw_offset_deg", Kind::Real, "turn added to the yaw", |item, i| {
            event(item, i).map(|event| event.yaw_offset_rad.to_degrees()).into()
        }),
    ]
}

fn pose(item: &DatasetItem, i: usize) -> &Pose {
    &item.record.trajectory.poses_in_world[i]
}

fn state(item: &DatasetItem, i: usize) -> &TargetState {
    &item.record.trajectory.track.states[i]
}

fn view_of(item: &DatasetItem, i: usize) -> &TargetView {
    &item.record.views[i]
}

fn event(item: &DatasetItem, i: usize) -> Option<&FramePerturbation> {
    item.record.trajectory.perturbation.as_ref().map(|it| &it.frames[i])
}

fn edges(pixel_box: Option<&PixelBox>) -> Cell {
    pixel_box.map(|it| edges_px(it).map(|edge| edge as f32)).into()
}
