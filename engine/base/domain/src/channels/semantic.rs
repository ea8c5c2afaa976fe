//! Channel `semantic`: labels.

use super::channel::{Channel, ChannelSource};

/// CARLA label ids.
pub static CHANNEL: Channel = Channel {
    name: "semantic",
    doc: "CARLA label ids.",
    source: ChannelSource::Labels,
    notes: &[("labels", "CARLA 0.9.14 and later")],
    is_value: |_| true,
};
