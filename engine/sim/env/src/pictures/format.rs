//! [`PictureFormat`]: what pictures of environments hold.

use cosfly_domain::{ChannelSet, Weather};
use cosfly_render::PictureLook;

/// Content of pictures: size, channels, colours.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureFormat {
    /// Columns. Pixels are square; pictures are as wide as the environment's lens.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Channels: names, types and meanings of datasets.
    pub channels: ChannelSet,
    /// Greatest depth in the channel `depth`, metres, which the sky has.
    pub farthest_m: f32,
    /// Weather of colours; each episode's own where there is none.
    pub weather: Option<Weather>,
    /// Look of colours.
    pub look: PictureLook,
}

impl PictureFormat {
    /// Pixels of a picture.
    pub fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }
}
