//! One increment, written as an array or as an object.

use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use std::fmt;

/// Names of the six numbers, in order.
pub const DIMENSIONS: [&str; 6] = ["dx", "dy", "dz", "dpitch", "dyaw", "droll"];

/// dx, dy, dz in metres, dpitch, dyaw, droll in degrees.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Waypoint(pub [f64; 6]);

impl<'de> Deserialize<'de> for Waypoint {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(WaypointVisitor)
    }
}

struct WaypointVisitor;

impl<'de> Visitor<'de> for WaypointVisitor {
    type Value = Waypoint;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a waypoint: an array or an object of dx, dy, dz, dpitch, dyaw, droll")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut numbers: A) -> Result<Waypoint, A::Error> {
        let mut waypoint = Waypoint::default();
        let mut count = 0;
        while let Some(number) = numbers.next_element::<f64>()? {
            match waypoint.0.get_mut(count) {
                Some(place) => *place = number,
                None => return Err(A::Error::custom("a waypoint has more than six numbers")),
            }
            count += 1;
        }
        if count == 0 { Err(A::Error::custom("a waypoint has no number at all")) } else { Ok(waypoint) }
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Waypoint, A::Error> {
        let mut waypoint = Waypoint::default();
        let mut known = false;
        while let Some(name) = entries.next_key::<String>()? {
            match DIMENSIONS.iter().position(|dimension| *dimension == name) {
                Some(place) => (waypoint.0[place], known) = (entries.next_value()?, true),
                None => {
                    entries.next_value::<serde::de::IgnoredAny>()?;
                }
            }
        }
        if known {
            Ok(waypoint)
        } else {
            Err(A::Error::custom("a waypoint names none of dx, dy, dz, dpitch, dyaw, droll"))
        }
    }
}
