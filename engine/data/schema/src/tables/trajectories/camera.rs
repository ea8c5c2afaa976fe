//! The camera of a trajectory, and its target.

use super::columns::Trajectories;
use crate::tables::DatasetItem;
use crate::tables::column::columns;

columns! { Trajectories::CAMERA of DatasetItem;
    /// Name of the camera, where several film each flight (`cameras` of the stage `render`); null for a single one.
    camera_name: Option<String> = |item, _| item.record.camera_name.clone();
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
    /// Lens distortion, OpenCV's k1: r (1 + k1 r^2 + k2 r^4), r the tangent of the angle from the optical axis.
    camera_k1: f64 = |item, _| item.record.lens.k1;
    /// Lens distortion, OpenCV's k2.
    camera_k2: f64 = |item, _| item.record.lens.k2;
    /// Yaw of the camera relative to the drone, around the drone's up axis, positive to the right; before the pitch. Of a
    /// levelled mount, around the vertical.
    camera_mount_yaw_deg: f64 = |item, _| item.record.mount.yaw_rad.to_degrees();
    /// Pitch of the camera relative to the drone, positive upwards; after the yaw.
    camera_mount_pitch_deg: f64 = |item, _| item.record.mount.pitch_rad.to_degrees();
    /// Whether a gimbal holds the horizon level: yaw and pitch of the mount add to the drone's, and the camera has no roll.
    camera_mount_levelled: bool = |item, _| item.record.mount.levelled;
    /// Exposure time, centred on `time_s`, over which colour is blurred; depth and ids are of `time_s`; 0: no blur.
    camera_shutter_s: f64 = |item, _| item.record.motion_blur.shutter_s;
    /// Time from the top row to the bottom row, the middle row at `time_s`, in all channels; 0: all rows at once.
    camera_readout_s: f64 = |item, _| item.record.rolling_shutter.readout_s;
    /// Standard deviation of the blur of lens and sensor.
    camera_point_spread_px: f64 = |item, _| item.record.optics.point_spread_px;
    /// Strength of the image processor's sharpening; 0: none.
    camera_sharpening: f64 = |item, _| item.record.optics.sharpening;
    /// Steepness of the image processor's tone curve; 0: none.
    camera_contrast: f64 = |item, _| item.record.optics.contrast;
    /// Exposure beyond the one that suits the weather, in stops.
    camera_exposure_ev: f64 = |item, _| item.record.optics.exposure_ev;
    /// Colour temperature that is rendered as white, kelvin.
    camera_white_balance_k: f64 = |item, _| item.record.optics.white_balance_k;
    /// Strength of the glow around bright lamps at night; 0: none.
    camera_bloom: f64 = |item, _| item.record.optics.bloom;
    /// Standard deviation of the signal-independent noise of colour, in steps of 8 bits.
    camera_noise_gaussian: f64 = |item, _| item.record.noise.gaussian;
    /// Standard deviation of the noise of colour at white, proportional to the square root of brightness, in steps of 8
    /// bits; variances of both noises add up.
    camera_noise_shot: f64 = |item, _| item.record.noise.shot;

    /// Height of the target's body.
    target_height_m: f64 = |item, _| item.record.trajectory.track.height_m;
    /// Radius of the target's body seen from above; of a vehicle, of the circle around its outline.
    target_radius_m: f64 = |item, _| item.record.trajectory.track.radius_m;
    /// Length of the target's walk.
    target_length_m: f64 = |item, _| item.record.trajectory.track.length_m();
    /// Mean of `frames.visible_by_pixels`.
    mean_visible_by_pixels: f64 = mean_visible_by_pixels;
    /// Number of frames with the target in the image.
    frames_in_view: u32 = |item, _| item.record.views.iter().filter(|view| view.in_view).count() as u32;
}

fn mean_visible_by_pixels(item: &DatasetItem, _: usize) -> f64 {
    let views = &item.record.views;
    views.iter().map(|view| view.visible_by_pixels).sum::<f64>() / views.len().max(1) as f64
}
