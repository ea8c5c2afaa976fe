//! Channel `semantic`: labels.

use cosfly_domain::channels::channel::{Channel, Source};

/// CARLA label ids.
pub static CHANNEL: Channel = Channel {
    name: "semantic",
    doc: "CARLA label ids.",
    source: Source::Labels,
    notes: &[("labels", "CARLA 0.9.14 and later")],
    is_value: |_| true,
};
