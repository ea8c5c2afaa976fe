//! Channel `rgb`: colours.

use cosfly_domain::channels::channel::{Channel, Source};

/// Colours, sRGB.
pub static CHANNEL: Channel =
    Channel { name: "rgb", doc: "the colour image.", source: Source::Colour, notes: &[], is_value: |_| true };
