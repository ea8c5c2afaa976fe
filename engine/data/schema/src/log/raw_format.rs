//! Raw images in a log: encoding and bytes per pixel of each element type.

use cosfly_domain::Channel;
use cosfly_domain::channels::Element;

/// Layout of a raw image's pixels: row-major, little-endian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RawFormat {
    /// Name of the encoding in Foxglove's messages.
    pub encoding: &'static str,
    /// Number of bytes per pixel.
    pub pixel_bytes: usize,
}

/// Possible formats of a channel's raw images; none for channels stored as image files. Ids are `16UC1`, or `32UC1`
/// where a town has more objects than 16 bits can number (not in Foxglove's list: `step` / `width` = 4 gives the size).
/// Neither is `32FC2`, OpenCV's name of two floats.
pub fn formats(channel: &Channel) -> &'static [RawFormat] {
    match channel.element() {
        Element::Colour => &[],
        Element::Float => &[RawFormat { encoding: "32FC1", pixel_bytes: 4 }],
        Element::Label | Element::Flag => &[RawFormat { encoding: "mono8", pixel_bytes: 1 }],
        Element::Id => {
            &[RawFormat { encoding: "16UC1", pixel_bytes: 2 }, RawFormat { encoding: "32UC1", pixel_bytes: 4 }]
        }
        Element::Bytes => &[RawFormat { encoding: "rgb8", pixel_bytes: 3 }],
        Element::Pair => &[RawFormat { encoding: "32FC2", pixel_bytes: 8 }],
    }
}
