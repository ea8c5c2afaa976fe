//! The content of one frame: pose, weather, people.

use cosfly_domain::Weather;
use cosfly_figures::{BodyFigure, FigureInPicture};
use cosfly_frames::Pose;

/// Camera, weather and people of one frame.
#[derive(Clone, Copy, Debug)]
pub struct FrameSetup<'a> {
    /// The camera's pose.
    pub pose: Pose,
    /// Weather with its sun azimuth drawn (see [`crate::RenderConfig::draw_weather`]).
    pub weather: &'a Weather,
    /// The followed target, if there is one.
    pub target: Option<BodyFigure>,
    /// All other people. They are drawn like the target, occlude it and are occluded by it.
    pub others: &'a [FigureInPicture],
}
