//! The content of one picture: the town, the camera, and whoever moves in it.

use crate::scene::BatchScene;
use cosfly_domain::Weather;
use cosfly_figures::{BodyFigure, FigureInPicture};
use cosfly_frames::Pose;
use cosfly_render::PictureLook;

/// One picture of a batch.
#[derive(Clone, Copy)]
pub struct BatchView<'a> {
    /// The town.
    pub scene: &'a BatchScene,
    /// The camera's pose (body axes: x along the optical axis, y right, z up).
    pub pose: Pose,
    /// Horizontal field of view, radians; pixels are square, the optical centre is the picture's centre.
    pub horizontal_fov_rad: f64,
    /// The followed target, if there is one; its instance id is [`cosfly_domain::TARGET_INSTANCE`].
    pub target: Option<BodyFigure>,
    /// All other people and vehicles, drawn as the same figures as in large pictures; those less than a pixel high are left out, as
    /// there.
    pub others: &'a [FigureInPicture],
    /// Weather of the colours; noon under a clear sky where there is none.
    pub weather: Option<&'a Weather>,
    /// Look of the colours.
    pub look: PictureLook,
}
