//! The camera of a trajectory.

use super::columns::Trajectories;
use crate::tables::DatasetItem;
use crate::tables::column::columns;

columns! { Trajectories::CAMERA of DatasetItem;
    /// Name of the camera, where several film each flight (`cameras` of the stage `render`); null for a single one.
    camera_name: Option<String> = |item, _| item.record.camera_name.clone();
    /// Frames of the flight from one picture to the next; 1 where every frame is filmed.
    camera_every: u32 = |item, _| item.record.every;
    /// Width of the images.
    camera_width_px: u32 = |item, _| item.record.camera.width;
    /// Height of the images.
    camera_height_px: u32 = |item, _| item.record.camera.height;
    /// Horizontal field of view, without the lens's distortion.
    camera_fov_deg: f64 = |item, _| item.record.camera.horizontal_fov_rad.to_degrees();
    /// Focal length of both axes, without the lens's distortion.
    camera_focal_px: f64 = |item, _| item.record.camera.focal_px();
    /// Optical centre, from the left edge.
    camera_cx_px: f64 = |item, _| 0.5 * f64::from(item.record.camera.width);
    /// Optical centre, from the top edge.
    camera_cy_px: f64 = |item, _| 0.5 * f64::from(item.record.camera.height);
    /// Model of the lens: `brown` (radial distortion of a pinhole), `fisheye` (Kannala and Brandt's, OpenCV's `fisheye`) or
    /// `equirectangular` (360 x 180 degrees; the focal length is pixels per radian).
    camera_lens_model: String = |item, _| item.record.lens.model.name().to_owned();
    /// Whether depth pictures have the distance along the ray of a pixel, as of pictures all around and of fisheyes that see beyond 80
    /// degrees from their axis; otherwise the distance along the optical axis.
    camera_depth_is_along_rays: bool = |item, _| item.record.lens.is_wide(&item.record.camera);
    /// Lens distortion, OpenCV's k1: r (1 + k1 r^2 + k2 r^4), r the tangent of the angle from the optical axis. Of a fisheye:
    /// a (1 + k1 a^2 + k2 a^4 + k3 a^6 + k4 a^8), a the angle itself, radians.
    camera_k1: f64 = |item, _| item.record.lens.k1;
    /// Lens distortion, OpenCV's k2.
    camera_k2: f64 = |item, _| item.record.lens.k2;
    /// Lens distortion of a fisheye, OpenCV's k3; otherwise 0.
    camera_k3: f64 = |item, _| item.record.lens.k3;
    /// Lens distortion of a fisheye, OpenCV's k4; otherwise 0.
    camera_k4: f64 = |item, _| item.record.lens.k4;
    /// Position of the camera on the drone, along the drone's axes: ahead, right, up; without `camera_mount_right_m`.
    camera_mount_position_in_body_m: [f64; 3] = |item, _| item.record.mount.position_in_body_m.to_array();
    /// Shift of the camera along its own right axis: the base line, of the right camera of a stereo pair; otherwise 0.
    camera_mount_right_m: f64 = |item, _| item.record.mount.right_m;
    /// Distance between the two cameras of a stereo pair; null for a single camera.
    camera_base_line_m: Option<f64> = |item, _| item.record.stereo.map(|eye| eye.base_line_m);
    /// Yaw of the camera relative to the drone, around the drone's up axis, positive to the right; before the pitch. Of a
    /// levelled mount, around the vertical.
    camera_mount_yaw_deg: f64 = |item, _| item.record.mount.yaw_rad.to_degrees();
    /// Pitch of the camera relative to the drone, positive upwards; after the yaw.
    camera_mount_pitch_deg: f64 = |item, _| item.record.mount.pitch_rad.to_degrees();
    /// Roll of the camera relative to the drone, around the optical axis; positive: right side down; after the pitch.
    camera_mount_roll_deg: f64 = |item, _| item.record.mount.roll_rad.to_degrees();
    /// Whether a gimbal holds the horizon level: yaw and pitch of the mount add to the drone's, and its roll is the camera's.
    camera_mount_levelled: bool = |item, _| item.record.mount.levelled;
}
