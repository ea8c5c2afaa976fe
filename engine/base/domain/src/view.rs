//! How much of a body one picture shows.

use serde::{Deserialize, Serialize};

/// A box of pixels, indices inclusive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PixelBox {
    /// Leftmost column.
    pub u_min: u32,
    /// Topmost row.
    pub v_min: u32,
    /// Rightmost column.
    pub u_max: u32,
    /// Lowest row.
    pub v_max: u32,
}

impl PixelBox {
    /// Grows to a pixel.
    pub fn add(&mut self, u: u32, v: u32) {
        *self = Self {
            u_min: self.u_min.min(u),
            v_min: self.v_min.min(v),
            u_max: self.u_max.max(u),
            v_max: self.v_max.max(v),
        };
    }
}

/// The target in one frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TargetView {
    /// Whether the body covers at least one pixel centre of the image, occluded or not.
    pub in_view: bool,
    /// Share of body points reached by unoccluded rays, whether or not in the image, 0..=1.
    pub visible_by_rays: f64,
    /// Visible pixels divided by the pixels it would cover without obstacles (and inside the image); 0 out of view.
    pub visible_by_pixels: f64,
    /// Visible pixels.
    pub pixels: u32,
    /// Box of the visible pixels.
    pub visible_box: Option<PixelBox>,
    /// Box of the pixels it would cover without obstacles.
    pub full_box: Option<PixelBox>,
    /// Instance id of what hides most of it; 0 when nothing does.
    pub occluder_instance: u32,
}

/// Somebody beside the target in one frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BodyView {
    /// Instance id.
    pub instance: u32,
    /// Visible pixels.
    pub pixels: u32,
    /// Box of the visible pixels.
    pub visible_box: PixelBox,
}
