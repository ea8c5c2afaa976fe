//! Table `bodies_3d`: 3-D boxes of visible bodies, and key points of people.

use super::column::columns;
use super::{DatasetItem, Table};
use cosfly_domain::{BodyInSpace, KeyPoint};
use cosfly_frames::real;

/// Definition of the table.
pub fn table() -> Table<DatasetItem> {
    let doc = "3-D boxes of the bodies that a frame shows, the target among them, and COCO's seventeen key points of people on foot. Empty without `bodies_3d` in the stage `render`.";
    let rows = |item: &DatasetItem| item.record.bodies_3d.len();
    let keys = &["trajectory_id", "frame", "instance"];
    Table { per_frame: true, ..Table::new("bodies_3d", doc, keys, rows, Bodies3d::COLUMNS) }
}

/// Columns of table `bodies_3d`.
pub struct Bodies3d;

columns! { Bodies3d::COLUMNS of DatasetItem;
    /// Trajectory that the frame belongs to.
    trajectory_id: String = |item, _| item.record.trajectory_id.clone();
    /// Split: `train`, `val` or `test`; that of the file.
    split: String = |item, _| item.membership.split.name().to_owned();
    /// Number of the frame, from 0.
    frame: u32 = |item, i| body(item, i).frame;
    /// Id in instance images; 1: the target.
    instance: u32 = |item, i| body(item, i).instance;
    /// Middle of the box, world frame: x, y, z.
    centre_in_world_m: [f64; 3] = |item, i| body(item, i).centre_in_world.to_array();
    /// Length along the heading, width and height of the box, whose height is vertical.
    size_m: [f64; 3] = |item, i| body(item, i).size_m.to_array();
    /// Direction of the length, positive: x towards y.
    yaw_in_world_deg: f64 = |item, i| body(item, i).heading_rad.to_degrees();
    /// Middle of the box along the camera's axes: ahead, right, up.
    centre_in_camera_m: [f64; 3] = |item, i| {
        let BodyInSpace { frame, centre_in_world, .. } = body(item, i);
        item.record.camera_pose(*frame as usize).body_from_world_point(*centre_in_world).to_array()
    };
    /// Direction of the length against the camera's yaw, -180 to 180; positive: to the right.
    yaw_in_camera_deg: f64 = |item, i| {
        let BodyInSpace { frame, heading_rad, .. } = body(item, i);
        real::wrap_angle_rad(heading_rad - item.record.camera_pose(*frame as usize).yaw_rad).to_degrees()
    };
    /// Key points in COCO's order, pixels: right and down, then those of the next; 0 out of the picture. Empty for vehicles
    /// and drones.
    key_points_px: Vec<f64> = |item, i| listed(item, i, |point| point.pixel.to_vec());
    /// Planar depth of each key point, metres; 0 behind the camera.
    key_points_depth_m: Vec<f64> = |item, i| listed(item, i, |point| vec![point.depth_m]);
    /// Key points in the world frame: x, y, z, then those of the next.
    key_points_in_world_m: Vec<f64> = |item, i| listed(item, i, |point| point.point_in_world.to_array().to_vec());
    /// What the picture shows of each key point, numbered as COCO does. 2: it is seen; 1: it is in the picture, behind
    /// something or behind the body itself; 0: out of the picture.
    key_points_shown: Vec<f64> = |item, i| listed(item, i, |point| vec![f64::from(point.shown as u8)]);
}

fn body(item: &DatasetItem, i: usize) -> &BodyInSpace {
    &item.record.bodies_3d[i]
}

fn listed(item: &DatasetItem, i: usize, numbers: fn(&KeyPoint) -> Vec<f64>) -> Vec<f64> {
    body(item, i).key_points.iter().flat_map(numbers).collect()
}
