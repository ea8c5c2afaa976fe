//! One picture: the target, everybody else, the camera.

use crate::facts::Wear;
use cosfly_domain::{BodyKind, Camera, Colour, Lens};
use cosfly_frames::{DVec3, Pose};

/// A person with fewer visible pixels is not clear: texts do not mention and do not count such a person, and do not say how
/// many people the picture shows.
const CLEAR_PIXELS: u32 = 30;
/// Smallest height of the box of a clear person, pixels.
const CLEAR_HEIGHT_PX: f64 = 10.0;
/// A target that moves less than this over the input stands; one that moves more than [`WALKS_M`] walks, metres.
pub(super) const STANDS_M: f64 = 0.1;
pub(super) const WALKS_M: f64 = 0.4;

/// Somebody in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenPerson {
    /// Ground point between the feet, world frame.
    pub feet_in_world: DVec3,
    /// Walking direction, radians.
    pub heading_rad: f64,
    /// Speed along the ground, m/s.
    pub speed_mps: f64,
    /// Left, top, right, bottom edge of the visible pixels; `None` where no pixel is visible.
    pub box_px: Option<[f64; 4]>,
    /// Number of visible pixels.
    pub pixels: u32,
    /// Colour of the shirt or jacket.
    pub top: Colour,
}

impl SeenPerson {
    pub(super) fn is_clear(&self) -> bool {
        self.pixels >= CLEAR_PIXELS && self.box_px.is_some_and(|edges| edges[3] - edges[1] >= CLEAR_HEIGHT_PX)
    }

    /// Middle of the visible pixels as a share of the picture's width.
    pub(super) fn across(&self, width_px: f64) -> f64 {
        self.box_px.map_or(0.5, |edges| 0.5 * (edges[0] + edges[2]) / width_px)
    }
}

impl WindowView {
    /// Pixel coordinates and depth of a point.
    pub(super) fn project(&self, point_in_world: DVec3) -> Option<(f64, f64, f64)> {
        let point = self.camera.body_from_world_point(point_in_world);
        self.wide_lens.map_or_else(|| self.optics.project_seen(point), |lens| lens.project(&self.optics, point))
    }
}

/// The picture that ends the input of a window.
#[derive(Clone, Debug, PartialEq)]
pub struct WindowView {
    /// Pose of the camera.
    pub camera: Pose,
    /// Size of the picture and its field of view.
    pub optics: Camera,
    /// The lens, where it sees all around; otherwise landmarks are where the ideal camera sees them.
    pub wide_lens: Option<Lens>,
    /// Kind of the target.
    pub kind: BodyKind,
    /// The target.
    pub target: SeenPerson,
    /// Clothes of the target.
    pub wear: Option<Wear>,
    /// Way of the target over the input, world frame, metres.
    pub moved_in_world: DVec3,
    /// Everybody else of whom at least one pixel is visible.
    pub others: Vec<SeenPerson>,
}
