//! Channel `depth`: planar depth.

use super::channel::{Channel, ChannelSource};

/// Planar depth along the optical axis, metres.
pub static CHANNEL: Channel = Channel {
    name: "depth",
    doc: "planar depth, metres.",
    source: ChannelSource::Depth,
    notes: &[("unit", "m"), ("depth", "planar, along the optical axis"), ("no_hit", "+inf")],
    is_value: |_| true,
};
