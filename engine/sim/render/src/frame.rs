//! One rendered frame: images, and views of the target and of other people.

use cosfly_domain::Channel;
use serde::{Deserialize, Serialize};

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
    /// Instance ids: 0 for ground and sky, [`TARGET_INSTANCE`] for the target, [`object_instance`] for
    /// objects, and for other people what [`cosfly_figures::Bystander`] says.
    pub instance: Vec<u32>,
    /// Channels that were asked for, in the order of [`cosfly_domain::channels::ALL`].
    pub on_request: Vec<ChannelImage>,
}

/// The pixels of a channel on request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChannelImage {
    /// The channel.
    pub channel: &'static Channel,
    /// Row-major from the top-left pixel, little-endian.
    pub bytes: Vec<u8>,
}

impl ChannelImage {
    /// An image of `pixels` pixels, all bytes 0.
    pub fn new(channel: &'static Channel, pixels: usize) -> Self {
        Self { channel, bytes: vec![0; channel.bytes_on_request() * pixels] }
    }

    /// Copies pixel `from` of another image of the same channel to pixel `to`.
    pub fn copy_pixel(&mut self, to: usize, image: &Self, from: usize) {
        let size = self.channel.bytes_on_request();
        self.bytes[size * to..size * (to + 1)].copy_from_slice(&image.bytes[size * from..size * (from + 1)]);
    }

    /// Gives `images` the channels of `like` at `pixels` pixels each; nothing is allocated when they have them.
    pub fn match_channels(images: &mut Vec<Self>, like: &[Self], pixels: usize) {
        let is_same = images.iter().map(|image| image.channel).eq(like.iter().map(|image| image.channel));
        if !is_same || images.iter().any(|image| image.bytes.len() != image.channel.bytes_on_request() * pixels) {
            *images = like.iter().map(|image| Self::new(image.channel, pixels)).collect();
        }
    }
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

/// Instance id of the followed target.
pub const TARGET_INSTANCE: u32 = 1;

/// Instance id of an object of the town.
pub fn object_instance(object_id: u32) -> u32 {
    object_id.saturating_add(2)
}

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
pub struct PersonView {
    /// Instance id.
    pub instance: u32,
    /// Visible pixels.
    pub pixels: u32,
    /// Box of the visible pixels.
    pub visible_box: PixelBox,
}
