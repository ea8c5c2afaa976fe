//! The message type `cosfly.TargetState`: fields, descriptor and `.proto` text from one list.

use super::own_message::{self, Field};
use prost::Message;
use prost_types::field_descriptor_proto::Type;

/// Name of the schema in logs.
pub const SCHEMA_NAME: &str = "cosfly.TargetState";

/// State of the target in one frame, in the right-handed `map` frame. Field documentation: see [`FIELDS`].
#[derive(Clone, PartialEq, Message)]
#[expect(missing_docs, reason = "the list of fields documents them, for the .proto file as well")]
pub struct TargetStateMessage {
    #[prost(uint32, tag = "1")]
    pub frame: u32,
    #[prost(double, tag = "2")]
    pub time_s: f64,
    #[prost(double, tag = "3")]
    pub feet_x_m: f64,
    #[prost(double, tag = "4")]
    pub feet_y_m: f64,
    #[prost(double, tag = "5")]
    pub feet_z_m: f64,
    #[prost(double, tag = "6")]
    pub heading_rad: f64,
    #[prost(double, tag = "7")]
    pub speed_mps: f64,
    #[prost(double, tag = "8")]
    pub height_m: f64,
    #[prost(double, tag = "9")]
    pub radius_m: f64,
    #[prost(bool, tag = "10")]
    pub in_view: bool,
    #[prost(double, tag = "11")]
    pub visible_by_rays: f64,
    #[prost(double, tag = "12")]
    pub visible_by_pixels: f64,
    #[prost(uint32, tag = "13")]
    pub visible_pixels: u32,
    #[prost(uint32, repeated, tag = "14")]
    pub visible_box_px: Vec<u32>,
    #[prost(uint32, repeated, tag = "15")]
    pub full_box_px: Vec<u32>,
    #[prost(uint32, tag = "16")]
    pub occluder_instance: u32,
    #[prost(double, tag = "17")]
    pub distance_m: f64,
    #[prost(double, tag = "18")]
    pub drone_clearance_m: f64,
    #[prost(uint32, tag = "19")]
    pub expert_frame: u32,
    #[prost(bool, tag = "20")]
    pub position_event: bool,
    #[prost(bool, tag = "21")]
    pub rotation_event: bool,
}

/// The fields.
pub const FIELDS: [Field<'static>; 21] = [
    ("frame", Type::Uint32, false, "frame number, from 0"),
    ("time_s", Type::Double, false, "frame * dt, seconds"),
    ("feet_x_m", Type::Double, false, "ground point between the feet, frame `map`"),
    ("feet_y_m", Type::Double, false, "left is positive"),
    ("feet_z_m", Type::Double, false, "up is positive"),
    ("heading_rad", Type::Double, false, "walking direction, counter-clockwise from x seen from above"),
    ("speed_mps", Type::Double, false, "speed along the ground; 0 while standing"),
    ("height_m", Type::Double, false, "height of the body"),
    ("radius_m", Type::Double, false, "radius of the body seen from above"),
    ("in_view", Type::Bool, false, "the body covers at least one pixel centre of the image, occluded or not"),
    ("visible_by_rays", Type::Double, false, "share of body points reached by unoccluded rays, 0..1"),
    ("visible_by_pixels", Type::Double, false, "visible pixels / pixels without obstacles, 0..1"),
    ("visible_pixels", Type::Uint32, false, "number of visible pixels"),
    ("visible_box_px", Type::Uint32, true, "left, top, right, bottom edge of the visible pixels; empty when none"),
    ("full_box_px", Type::Uint32, true, "the same without obstacles; empty when out of view"),
    ("occluder_instance", Type::Uint32, false, "instance id of the main occluder of the target; 0 when there is none"),
    ("distance_m", Type::Double, false, "from the camera to the feet"),
    ("drone_clearance_m", Type::Double, false, "from the drone to the nearest obstacle, at most 50"),
    ("expert_frame", Type::Uint32, false, "frame of the expert flight that this frame belongs to"),
    ("position_event", Type::Bool, false, "the position disturbance occurred at this frame"),
    ("rotation_event", Type::Bool, false, "the rotation disturbance occurred at this frame"),
];

/// Encoded `FileDescriptorSet` that logs carry.
pub fn descriptor_set() -> Vec<u8> {
    own_message::descriptor_set("TargetState", &FIELDS)
}

/// Text of `schemas/cosfly.proto`.
pub fn proto_text() -> String {
    let mut text = String::from(
        "// Messages of cosfly's own in MCAP logs. Frame `map`: right-handed, x east, y north, z up, metres.\n\
         syntax = \"proto3\";\n\npackage cosfly;\n\n// The tracked pedestrian at one frame.\nmessage TargetState {\n",
    );
    for (i, (name, kind, repeated, doc)) in FIELDS.iter().enumerate() {
        let kind = match kind {
            Type::Uint32 => "uint32",
            Type::Bool => "bool",
            _ => "double",
        };
        let repeated = if *repeated { "repeated " } else { "" };
        text.push_str(&format!("  // {doc}\n  {repeated}{kind} {name} = {};\n", i + 1));
    }
    text.push_str("}\n");
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use prost_types::FileDescriptorSet;

    #[test]
    fn the_message_has_the_fields_of_the_list_in_their_order() {
        let debug = format!("{:?}", TargetStateMessage::default());
        let names: Vec<&str> = FIELDS.iter().map(|field| field.0).collect();
        let mut from = 0;
        for name in &names {
            let at = debug[from..].find(&format!("{name}:")).unwrap_or_else(|| panic!("{name} is not in {debug}"));
            from += at + name.len();
        }
        assert_eq!(debug.matches(": ").count(), names.len());
    }

    #[test]
    fn the_descriptor_names_package_and_message() {
        let set = FileDescriptorSet::decode(&descriptor_set()[..]).unwrap();
        assert_eq!(set.file[0].package(), "cosfly");
        assert_eq!(set.file[0].message_type[0].field.len(), FIELDS.len());
        assert!(proto_text().contains("  repeated uint32 visible_box_px = 14;\n"));
    }
}
