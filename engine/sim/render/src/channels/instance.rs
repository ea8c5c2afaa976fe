//! Channel `instance`: instance ids.

use cosfly_domain::channels::channel::{Channel, Source};

/// Instance ids: 0 for ground and sky, 1 for the target, then objects, then people.
pub static CHANNEL: Channel = Channel {
    name: "instance",
    doc: "instance ids.",
    source: Source::Ids,
    notes: &[("0", "ground and sky"), ("1", "the target"), ("2 and more", "object id + 2, then people")],
    is_value: |_| true,
};
