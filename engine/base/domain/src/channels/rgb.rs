//! Channel `rgb`: colours.

use super::channel::{Channel, ChannelSource};

/// Colours, sRGB.
pub static CHANNEL: Channel =
    Channel { name: "rgb", doc: "the colour image.", source: ChannelSource::Colour, notes: &[], is_value: |_| true };
