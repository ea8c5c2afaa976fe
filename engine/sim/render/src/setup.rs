//! The content of one frame: pose, weather, people.

use crate::figure::{Bystander, TargetSetup};
use crate::weather::Weather;
use cosfly_frames::Pose;

/// Camera, weather and people of one frame.
#[derive(Clone, Copy, Debug)]
pub struct FrameSetup<'a> {
    /// The camera's pose.
    pub pose: Pose,
    /// Weather with its sun azimuth drawn (see [`crate::RenderConfig::draw_weather`]).
    pub weather: &'a Weather,
    /// The followed target, if there is one.
    pub target: Option<TargetSetup>,
    /// Everybody else who is about. They are drawn like the target, hide it and are hidden by it.
    pub others: &'a [Bystander],
}
