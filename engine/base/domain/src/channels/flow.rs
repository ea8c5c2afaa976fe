//! Optical flow: four channels, forward and back, each with its mask.

use super::channel::{Channel, ChannelSource, FlowTo};

/// Keys and texts of both flows.
const NOTES: &[(&str, &str)] = &[
    ("unit", "px"),
    ("value", "two 32-bit floats: right, down"),
    ("encoding", "32FC2; viewers that lack it show the previews"),
    ("none", "0, 0 where there is no such frame, or no such point in it"),
];

/// Keys and texts of both masks.
const MASK_NOTES: &[(&str, &str)] =
    &[("0", "out of the picture, hidden, or no such frame"), ("1", "seen in both frames")];

/// Flow to the frame before.
pub static BACK: Channel = Channel {
    name: "flow_back",
    doc: "optical flow to the frame before, pixels: right, down.",
    source: ChannelSource::Flow(FlowTo::Previous),
    notes: NOTES,
    is_value,
};

/// Mask of the flow to the frame before.
pub static BACK_VALID: Channel = Channel {
    name: "flow_back_valid",
    doc: "1 where the frame before shows the point, 0 elsewhere.",
    source: ChannelSource::FlowValid(FlowTo::Previous),
    notes: MASK_NOTES,
    is_value: |pixel| matches!(pixel, [0 | 1]),
};

/// Flow to the next frame.
pub static FORWARD: Channel = Channel {
    name: "flow_forward",
    doc: "optical flow to the next frame, pixels: right, down.",
    source: ChannelSource::Flow(FlowTo::Next),
    notes: NOTES,
    is_value,
};

/// Mask of the flow to the next frame.
pub static FORWARD_VALID: Channel = Channel {
    name: "flow_forward_valid",
    doc: "1 where the next frame shows the point, 0 elsewhere.",
    source: ChannelSource::FlowValid(FlowTo::Next),
    notes: MASK_NOTES,
    is_value: |pixel| matches!(pixel, [0 | 1]),
};

/// Two finite numbers.
fn is_value(stored: &[u8]) -> bool {
    let (numbers, rest) = stored.as_chunks::<4>();
    numbers.len() == 2 && rest.is_empty() && numbers.iter().all(|number| f32::from_le_bytes(*number).is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flow_is_two_finite_numbers() {
        let stored = |right: f32, down: f32| [right.to_le_bytes(), down.to_le_bytes()].concat();
        assert!(is_value(&stored(0.0, -3.5)) && is_value(&[0; 8]));
        assert!(!is_value(&stored(f32::NAN, 0.0)) && !is_value(&stored(0.0, f32::INFINITY)) && !is_value(&[0; 4]));
    }
}
