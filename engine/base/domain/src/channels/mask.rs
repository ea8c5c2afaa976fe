//! Channel `mask`: where the target is seen.

use super::channel::{Channel, ChannelSource};

/// 1 where the target is seen, 0 elsewhere.
pub static CHANNEL: Channel = Channel {
    name: "mask",
    doc: "1 where the target is seen, 0 elsewhere.",
    source: ChannelSource::Target,
    notes: &[("0", "elsewhere"), ("1", "the target")],
    is_value: |pixel| matches!(pixel, [0 | 1]),
};
