//! The pixels of one channel on request.

use super::Channel;

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
