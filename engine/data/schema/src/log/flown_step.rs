//! Message types of closed-loop flights: `cosfly.FlownStep` (what a policy did in a step, and what came of it), and samples of
//! sensors.

use super::own_message::{self, Field};
use prost::Message;
use prost_types::field_descriptor_proto::Type;

/// Name of the schema in logs.
pub const SCHEMA_NAME: &str = "cosfly.FlownStep";

/// State after a step. Field documentation: see [`FIELDS`].
#[derive(Clone, PartialEq, Message)]
#[expect(missing_docs, reason = "the list of fields documents them")]
pub struct FlownStepMessage {
    #[prost(uint32, tag = "1")]
    pub step: u32,
    #[prost(double, tag = "2")]
    pub time_s: f64,
    #[prost(bool, tag = "3")]
    pub tracked: bool,
    #[prost(double, tag = "4")]
    pub visible: f64,
    #[prost(double, tag = "5")]
    pub distance_m: f64,
    #[prost(double, tag = "6")]
    pub speed_mps: f64,
    #[prost(double, repeated, tag = "7")]
    pub velocity_mps: Vec<f64>,
    #[prost(double, repeated, tag = "8")]
    pub action: Vec<f64>,
    #[prost(double, tag = "9")]
    pub reward: f64,
    #[prost(double, repeated, tag = "10")]
    pub reward_terms: Vec<f64>,
}

/// The fields.
pub const FIELDS: [Field<'static>; 10] = [
    ("step", Type::Uint32, false, "steps since the beginning"),
    ("time_s", Type::Double, false, "time since the beginning, seconds"),
    ("tracked", Type::Bool, false, "the target is visible enough, in the picture and near enough"),
    ("visible", Type::Double, false, "share of body points reached by unoccluded rays, 0..1"),
    ("distance_m", Type::Double, false, "from the drone to the target's feet"),
    ("speed_mps", Type::Double, false, "speed of the drone"),
    ("velocity_mps", Type::Double, true, "velocity of the drone along x, y, z of `map`"),
    ("action", Type::Double, true, "numbers of the action that was given before the step; empty without one"),
    ("reward", Type::Double, false, "weighted sum of the terms"),
    ("reward_terms", Type::Double, true, "visibility, framing, distance, effort, collision, loss, unweighted"),
];

/// Encoded `FileDescriptorSet` that logs carry.
pub fn descriptor_set() -> Vec<u8> {
    own_message::descriptor_set("FlownStep", &FIELDS)
}

/// Sample of an inertial unit. Fields: see [`SENSORS`].
#[derive(Clone, PartialEq, Message)]
#[expect(missing_docs, reason = "the list of fields documents them")]
pub struct InertialMessage {
    #[prost(double, repeated, tag = "1")]
    pub rates_rad_s: Vec<f64>,
    #[prost(double, repeated, tag = "2")]
    pub force_mps2: Vec<f64>,
}

/// Sample of a barometer. Fields: see [`SENSORS`].
#[derive(Clone, PartialEq, Message)]
#[expect(missing_docs, reason = "the list of fields documents them")]
pub struct HeightMessage {
    #[prost(double, tag = "1")]
    pub height_m: f64,
}

/// Sample of a satellite receiver. Fields: see [`SENSORS`].
#[derive(Clone, PartialEq, Message)]
#[expect(missing_docs, reason = "the list of fields documents them")]
pub struct FixMessage {
    #[prost(double, repeated, tag = "1")]
    pub position_m: Vec<f64>,
    #[prost(double, repeated, tag = "2")]
    pub velocity_mps: Vec<f64>,
}

/// Names and fields of the messages of sensors.
pub const SENSORS: [(&str, &[Field<'static>]); 3] = [
    (
        "Inertial",
        &[
            ("rates_rad_s", Type::Double, true, "rates of turning around the body's axes: x ahead, y left, z up"),
            ("force_mps2", Type::Double, true, "specific force along them: acceleration without gravity's"),
        ],
    ),
    ("Height", &[("height_m", Type::Double, false, "height in `map`")]),
    (
        "Fix",
        &[
            ("position_m", Type::Double, true, "position in `map`"),
            ("velocity_mps", Type::Double, true, "velocity in `map`"),
        ],
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_message_has_the_fields_of_the_list_in_their_order() {
        let debug = format!("{:?}", FlownStepMessage::default());
        let places: Vec<Option<usize>> = FIELDS.iter().map(|field| debug.find(&format!(" {}:", field.0))).collect();
        assert!(places.iter().all(Option::is_some) && places.is_sorted(), "{debug}");
        assert_eq!(debug.matches(": ").count(), FIELDS.len());
    }
}
