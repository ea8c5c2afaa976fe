//! [`SplatView`]: a camera over a cloud, in the frame of its file.

use crate::placement::Placement;
use cosfly_domain::Camera;
use cosfly_frames::{DMat3, DVec3, Pose};

/// Nothing nearer than this along the optical axis is drawn, metres: as in the reference trainer.
pub const NEAR_M: f64 = 0.2;
/// Splats beyond the picture's edge are projected as at this many half pictures from the axis, as in the reference.
pub const MOST_ASIDE: f64 = 1.3;

/// A pinhole camera over a cloud.
#[derive(Clone, Copy, Debug)]
pub struct SplatView {
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Focal length, pixels.
    pub focal_px: f64,
    /// Whether small splats become fainter as they grow to the size of a pixel, as in Mip-Splatting.
    pub is_antialiased: bool,
    /// Position in the frame of the file.
    pub(crate) eye: DVec3,
    /// From axes of the file to the camera's: right, down, ahead, metres.
    pub(crate) camera_from_file: DMat3,
}

impl SplatView {
    /// The view of a camera in a pose over a cloud that stands in the world.
    pub fn new(camera: &Camera, pose: &Pose, placement: &Placement, is_antialiased: bool) -> Self {
        let world_from_body = pose.world_from_body();
        let [ahead, right, up] = [world_from_body.x_axis, world_from_body.y_axis, world_from_body.z_axis];
        let camera_from_world = DMat3::from_cols(right, -up, ahead).transpose();
        Self {
            width: camera.width as usize,
            height: camera.height as usize,
            focal_px: camera.focal_px(),
            is_antialiased,
            eye: placement.in_file(pose.position_in_world),
            camera_from_file: camera_from_world * placement.world_from_file,
        }
    }

    /// Column and row of the optical axis.
    pub(crate) fn centre_px(&self) -> [f64; 2] {
        [0.5 * self.width as f64, 0.5 * self.height as f64]
    }
}
