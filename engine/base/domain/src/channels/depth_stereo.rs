//! Channel `depth_stereo`: depth that a stereo pair measures in its own two pictures.

use super::channel::{Channel, ChannelSource};

/// Planar depth from the disparities that a matcher finds between the pictures of a pair, metres.
pub static CHANNEL: Channel = Channel {
    name: "depth_stereo",
    doc: "planar depth matched in the two pictures of the stereo pair, metres; NaN where nothing is matched.",
    source: ChannelSource::FilmNumber,
    notes: &[
        ("unit", "m"),
        ("model", "depth_stereo/1"),
        ("matcher", "semi-global, census of 9 x 7 pixels, five paths, disparities of 1 to 127 px in steps of 1/16 px"),
        ("no_measure", "NaN: out of range, hidden from the other camera, ambiguous, or a speckle"),
    ],
    is_value: |bytes| bytes.try_into().map(f32::from_le_bytes).is_ok_and(|depth_m| depth_m.is_nan() || depth_m >= 0.0),
};
