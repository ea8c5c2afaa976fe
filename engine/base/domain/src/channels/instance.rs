//! Channel `instance`: instance ids.

use super::channel::{Channel, ChannelSource};

/// Instance ids: 0 for ground and sky, 1 for the target, then objects, then people.
pub static CHANNEL: Channel = Channel {
    name: "instance",
    doc: "instance ids.",
    source: ChannelSource::Ids,
    notes: &[("0", "ground and sky"), ("1", "the target"), ("2 and more", "object id + 2, then people")],
    is_value: |_| true,
};
