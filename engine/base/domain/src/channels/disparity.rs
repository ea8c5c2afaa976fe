//! Channel `disparity`: the way between the two pictures of a stereo pair.

use super::channel::{Channel, ChannelSource};

/// Focal length x base line / depth, pixels.
pub static CHANNEL: Channel = Channel {
    name: "disparity",
    doc: "disparity of the stereo pair, pixels: columns from a point in the right picture to it in the left one; 0 for the sky.",
    source: ChannelSource::FilmNumber,
    notes: &[
        ("unit", "px"),
        ("value", "focal length x base line / depth; both pictures have the rows of a point in common"),
        ("no_hit", "0"),
    ],
    is_value: |bytes| bytes.try_into().map(f32::from_le_bytes).is_ok_and(|pixels| pixels.is_finite() && pixels >= 0.0),
};
