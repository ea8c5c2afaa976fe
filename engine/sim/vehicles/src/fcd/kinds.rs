//! Kinds and sizes of SUMO's types of vehicles.

use cosfly_frames::DVec3;
use cosfly_world::BodyKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What a type of vehicle of a SUMO file is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FcdType {
    /// Kind: `pedestrian`, `bicycle`, `motorcycle`, `car`, `van`, `truck` or `bus`.
    #[schemars(with = "String")]
    pub kind: BodyKind,
    /// Length, width and height, metres. Default: those of SUMO's class.
    #[serde(default)]
    pub size_m: Option<[f64; 3]>,
}

/// Words in names of types, the first that fits, with the size of SUMO's class.
const WORDS: [(&str, BodyKind); 17] = [
    ("ped", BodyKind::Pedestrian),
    ("person", BodyKind::Pedestrian),
    ("motorcycle", BodyKind::Motorcycle),
    ("moped", BodyKind::Motorcycle),
    ("scooter", BodyKind::Motorcycle),
    ("motorbike", BodyKind::Motorcycle),
    ("bicycle", BodyKind::Bicycle),
    ("bike", BodyKind::Bicycle),
    ("cycl", BodyKind::Bicycle),
    ("truck", BodyKind::Truck),
    ("lorry", BodyKind::Truck),
    ("trailer", BodyKind::Truck),
    ("bus", BodyKind::Bus),
    ("coach", BodyKind::Bus),
    ("delivery", BodyKind::Van),
    ("van", BodyKind::Van),
    ("container", BodyKind::Truck),
];

/// Sizes of SUMO's classes, metres. People are cylinders as wide as their shoulders.
fn class_size_m(kind: BodyKind) -> [f64; 3] {
    match kind {
        BodyKind::Pedestrian => [0.478, 0.478, 1.719],
        BodyKind::Bicycle => [1.6, 0.65, 1.7],
        BodyKind::Motorcycle => [2.2, 0.9, 1.5],
        BodyKind::Car => [5.0, 1.8, 1.5],
        BodyKind::Van => [6.5, 2.16, 2.86],
        BodyKind::Truck => [7.1, 2.4, 2.4],
        BodyKind::Bus => [12.0, 2.5, 3.4],
        BodyKind::Drone => [0.6, 0.6, 0.2],
    }
}

/// Kind and size of a type, by the user's list, then by words in its name; a passenger car, when nothing fits.
pub(super) fn kind_of(name: &str, is_person: bool, types: &BTreeMap<String, FcdType>) -> (BodyKind, DVec3) {
    // Types of a distribution are called `type@distribution`.
    let stated = types.get(name).or_else(|| types.get(name.split('@').next().unwrap_or(name)));
    if let Some(FcdType { kind, size_m }) = stated {
        return (*kind, DVec3::from_array(size_m.unwrap_or(class_size_m(*kind))));
    }
    let lower = name.to_lowercase();
    let by_word = WORDS.iter().find(|(word, _)| lower.contains(word)).map_or(BodyKind::Car, |(_, kind)| *kind);
    let kind = if is_person { BodyKind::Pedestrian } else { by_word };
    (kind, DVec3::from_array(class_size_m(kind)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_are_told_by_the_list_and_by_their_names() {
        let types =
            BTreeMap::from([("taxi".to_owned(), FcdType { kind: BodyKind::Van, size_m: Some([5.0, 2.0, 2.0]) })]);
        let kind = |name: &str| kind_of(name, false, &types).0;
        assert_eq!(kind("DEFAULT_VEHTYPE"), BodyKind::Car);
        assert_eq!(kind("DEFAULT_BIKETYPE"), BodyKind::Bicycle);
        assert_eq!(kind("veh_motorcycle@d"), BodyKind::Motorcycle);
        assert_eq!(kind("city_bus"), BodyKind::Bus);
        assert_eq!(kind_of("taxi@all", false, &types), (BodyKind::Van, DVec3::new(5.0, 2.0, 2.0)));
        assert_eq!(kind_of("DEFAULT_PEDTYPE", true, &types).0, BodyKind::Pedestrian);
        assert_eq!(kind_of("car", true, &types).0, BodyKind::Pedestrian);
    }
}
