//! Channel `depth_sensor`: depth with the errors of a stereo camera.

use super::channel::{Channel, ChannelSource};

/// Planar depth as a stereo camera measures it, metres.
pub static CHANNEL: Channel = Channel {
    name: "depth_sensor",
    doc: "planar depth with the errors of a stereo camera, metres; NaN where it measures none.",
    source: ChannelSource::FilmNumber,
    notes: &[
        ("unit", "m"),
        ("model", "depth_sensor/1"),
        ("camera", "base line 0.12 m to the right, disparities in steps of 1/16 px, 0.5 to 40 m"),
        ("no_measure", "NaN: out of range, hidden from the right camera, or without texture"),
    ],
    is_value: |bytes| bytes.try_into().map(f32::from_le_bytes).is_ok_and(|depth_m| depth_m.is_nan() || depth_m >= 0.0),
};
