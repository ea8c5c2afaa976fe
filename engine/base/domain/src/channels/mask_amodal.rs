//! Channel `mask_amodal`: where the target would be seen without obstacles.

use super::channel::{Channel, ChannelSource};

/// 1 where the target is seen or hidden, 0 elsewhere.
pub static CHANNEL: Channel = Channel {
    name: "mask_amodal",
    doc: "1 where the target is, seen or hidden, 0 elsewhere.",
    source: ChannelSource::TargetAlone,
    notes: &[("0", "elsewhere"), ("1", "the target, or what hides it")],
    is_value: |pixel| matches!(pixel, [0 | 1]),
};
