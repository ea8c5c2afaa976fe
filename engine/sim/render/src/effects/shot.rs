//! A picture to take: camera and bodies around its moment, and the frames beside it.

use crate::setup::FrameSetup;
use cosfly_domain::Weather;
use cosfly_figures::{BodyFigure, FigureInPicture};
use cosfly_frames::{Pose, Seed};

/// Camera and target at a moment.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// The camera's pose.
    pub pose: Pose,
    /// The followed target, if there is one.
    pub target: Option<BodyFigure>,
}

/// Another frame of the film.
#[derive(Clone, Copy)]
pub struct FrameBeside<'a> {
    /// The moment this many seconds after the middle of its shutter.
    pub moment: &'a dyn Fn(f64) -> Moment,
    /// Adds everybody else at that time to an empty list.
    pub others: &'a dyn Fn(f64, &mut Vec<FigureInPicture>),
}

/// The frames beside a frame; the first one and the last one of a film lack one.
#[derive(Clone, Copy, Default)]
pub struct Neighbours<'a> {
    /// The frame before.
    pub previous: Option<FrameBeside<'a>>,
    /// The frame after.
    pub next: Option<FrameBeside<'a>>,
}

/// One picture to take.
pub struct Shot<'a> {
    /// Weather with its sun azimuth drawn.
    pub weather: &'a Weather,
    /// The moment this many seconds after the middle of the shutter (before it, when negative).
    pub moment: &'a dyn Fn(f64) -> Moment,
    /// Adds everybody else at that time to an empty list.
    pub others: &'a dyn Fn(f64, &mut Vec<FigureInPicture>),
    /// The frames beside this one, for channels that compare them.
    pub neighbours: Neighbours<'a>,
    /// Seed of the sensor's noise; another one per frame.
    pub noise_seed: Seed,
}

/// The frame at a moment of a shot; `bystanders` is room for who is about.
pub(super) fn setup<'a>(shot: &Shot<'a>, offset_s: f64, bystanders: &'a mut Vec<FigureInPicture>) -> FrameSetup<'a> {
    setup_at(shot.weather, &FrameBeside { moment: shot.moment, others: shot.others }, offset_s, bystanders)
}

/// A frame at a moment.
pub(super) fn setup_at<'a>(
    weather: &'a Weather,
    frame: &FrameBeside<'_>,
    offset_s: f64,
    bystanders: &'a mut Vec<FigureInPicture>,
) -> FrameSetup<'a> {
    let Moment { pose, target } = (frame.moment)(offset_s);
    bystanders.clear();
    (frame.others)(offset_s, bystanders);
    FrameSetup { pose, weather, target, others: bystanders }
}
