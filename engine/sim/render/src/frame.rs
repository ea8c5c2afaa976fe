//! One rendered frame: views of the target and of other people.

use cosfly_domain::{BodyView, FrameImages, TargetView};

/// A finished frame; the images belong to the renderer and are overwritten by its next frame.
pub struct RenderedFrame<'a> {
    /// All channels.
    pub images: &'a FrameImages,
    /// View of the target; all zero without a target.
    pub target_view: TargetView,
    /// Indices of the pixels that the target would cover without obstacles, ascending.
    pub target_pixels: &'a [u32],
    /// Views of the others, by instance id; those of whom no pixel is seen are left out.
    pub others: &'a [BodyView],
}
