//! Channel `depth`: planar depth.

use cosfly_domain::channels::channel::{Channel, Source};

/// Planar depth along the optical axis, metres.
pub static CHANNEL: Channel = Channel {
    name: "depth",
    doc: "planar depth, metres.",
    source: Source::Depth,
    notes: &[("unit", "m"), ("depth", "planar, along the optical axis"), ("no_hit", "+inf")],
    is_value: |_| true,
};
