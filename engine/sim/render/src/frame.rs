//! One rendered frame: images, and views of the target and of other people.

use cosfly_domain::{ChannelImage, PersonView, TargetView};

/// All channels of one frame, row-major from the top-left pixel, sampled at pixel centres.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameImages {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// sRGB, 3 bytes a pixel.
    pub rgb: Vec<u8>,
    /// Planar depth along the optical axis, metres; `f32::INFINITY` for sky.
    pub depth_m: Vec<f32>,
    /// CARLA label ids.
    pub semantic: Vec<u8>,
    /// Instance ids: 0 for ground and sky, [`cosfly_domain::TARGET_INSTANCE`] for the target, [`cosfly_domain::object_instance`] for
    /// objects, and for other people what [`cosfly_figures::Bystander`] says.
    pub instance: Vec<u32>,
    /// Channels that were asked for, in the order of [`cosfly_domain::channels::ALL`].
    pub on_request: Vec<ChannelImage>,
}

/// A finished frame; the images belong to the renderer and are overwritten by its next frame.
pub struct RenderedFrame<'a> {
    /// All channels.
    pub images: &'a FrameImages,
    /// View of the target; all zero without a target.
    pub target_view: TargetView,
    /// Indices of the pixels that the target would cover without obstacles, ascending.
    pub target_pixels: &'a [u32],
    /// Views of the others, by instance id; those of whom no pixel is seen are left out.
    pub others: &'a [PersonView],
}
