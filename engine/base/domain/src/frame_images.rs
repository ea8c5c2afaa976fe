//! [`FrameImages`]: the pixels of all channels of one frame.

use crate::ChannelImage;

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
    /// Instance ids: 0 for ground and sky, [`crate::TARGET_INSTANCE`] for the target, [`crate::object_instance`] for
    /// objects, and for other people the ids of their bodies.
    pub instance: Vec<u32>,
    /// Channels that were asked for, in the order of [`crate::channels::ALL`].
    pub on_request: Vec<ChannelImage>,
}
