//! Kinds and sizes of SUMO's types of vehicles.

use cosfly_domain::BodyKind;
use cosfly_frames::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Kind and size of a type of vehicle of a SUMO file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FcdType {
    /// Kind: `pedestrian`, `bicycle`, `e_scooter`, `motorcycle`, `car`, `van`, `truck`, `bus` or `wheelchair`.
    #[schemars(with = "String")]
    pub kind: BodyKind,
    /// Length, width and height, metres. Default: those of SUMO's class.
    #[serde(default)]
    pub size_m: Option<[f64; 3]>,
}

/// Beginnings and ends of words in names of types; the first that fits.
const WORDS: [(&str, BodyKind); 25] = [
    ("wheelchair", BodyKind::Wheelchair),
    ("motorcycl", BodyKind::Motorcycle),
    ("motorcycle", BodyKind::Motorcycle),
    ("moped", BodyKind::Motorcycle),
    ("motorscooter", BodyKind::Motorcycle),
    ("scooter", BodyKind::EScooter),
    ("motorbike", BodyKind::Motorcycle),
    ("ped", BodyKind::Pedestrian),
    ("person", BodyKind::Pedestrian),
    ("cycl", BodyKind::Bicycle),
    ("cycle", BodyKind::Bicycle),
    ("bicycl", BodyKind::Bicycle),
    ("bike", BodyKind::Bicycle),
    ("truck", BodyKind::Truck),
    ("lorry", BodyKind::Truck),
    ("trailer", BodyKind::Truck),
    ("container", BodyKind::Truck),
    ("bus", BodyKind::Bus),
    ("coach", BodyKind::Bus),
    ("delivery", BodyKind::Van),
    ("van", BodyKind::Van),
    ("car", BodyKind::Car),
    ("passenger", BodyKind::Car),
    ("taxi", BodyKind::Car),
    ("veh", BodyKind::Car),
];

/// Kind of a type by the words in its name.
fn kind_by_words(name: &str) -> Option<BodyKind> {
    let lower = name.to_lowercase();
    let pieces: Vec<&str> = lower.split(|sign: char| !sign.is_alphabetic()).collect();
    let is_in = |word: &str| pieces.iter().any(|piece| piece.starts_with(word) || piece.ends_with(word));
    WORDS.iter().find(|(word, _)| is_in(word)).map(|(_, kind)| *kind)
}

/// Kind and size of a type, by the user's list, then by words in its name; `None` for vehicles when nothing fits.
pub(super) fn kind_of(name: &str, is_person: bool, types: &BTreeMap<String, FcdType>) -> Option<(BodyKind, DVec3)> {
    // Types of a distribution are called `type@distribution`.
    let stated = types.get(name).or_else(|| types.get(name.split('@').next().unwrap_or(name)));
    if let Some(FcdType { kind, size_m }) = stated {
        return Some((*kind, DVec3::from_array(size_m.unwrap_or(kind.row().class_size_m))));
    }
    let by_words = kind_by_words(name);
    let kind = match is_person {
        true => by_words.filter(|kind| *kind == BodyKind::Wheelchair).unwrap_or(BodyKind::Pedestrian),
        false => by_words?,
    };
    Some((kind, DVec3::from_array(kind.row().class_size_m)))
}

/// A passenger car, which vehicles of unknown types are.
pub(super) fn passenger_car() -> (BodyKind, DVec3) {
    (BodyKind::Car, DVec3::from_array(BodyKind::Car.row().class_size_m))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_are_told_by_the_list_and_by_their_names() {
        let types =
            BTreeMap::from([("taxi".to_owned(), FcdType { kind: BodyKind::Van, size_m: Some([5.0, 2.0, 2.0]) })]);
        let kind = |name: &str| kind_of(name, false, &types).map(|it| it.0);
        for (name, expected) in [
            ("DEFAULT_VEHTYPE", BodyKind::Car),
            ("passenger2b", BodyKind::Car),
            ("veh_speed50", BodyKind::Car),
            ("DEFAULT_BIKETYPE", BodyKind::Bicycle),
            ("cyclist", BodyKind::Bicycle),
            ("veh_motorcycle@d", BodyKind::Motorcycle),
            ("moped", BodyKind::Motorcycle),
            ("city_bus", BodyKind::Bus),
            ("minibus3", BodyKind::Bus),
            ("DEFAULT_PEDTYPE", BodyKind::Pedestrian),
        ] {
            assert_eq!(kind(name), Some(expected), "{name}");
        }
        assert_eq!([kind("tram"), kind("speedy"), kind("t0"), kind("")], [None; 4]);
        assert_eq!(kind_of("taxi@all", false, &types), Some((BodyKind::Van, DVec3::new(5.0, 2.0, 2.0))));
        // SUMO's class, and what its users call it.
        for name in ["scooter", "e_scooter", "eScooter", "kick_scooter"] {
            assert_eq!(kind_of(name, false, &types), Some((BodyKind::EScooter, DVec3::new(1.2, 0.5, 1.7))), "{name}");
        }
        assert_eq!(kind("motorscooter"), Some(BodyKind::Motorcycle));
        assert_eq!(kind_of("car", true, &types).map(|it| it.0), Some(BodyKind::Pedestrian));
        // SUMO's class of persons and of vehicles.
        let chair = Some((BodyKind::Wheelchair, DVec3::new(1.05, 0.65, 1.32)));
        assert_eq!([true, false].map(|is_person| kind_of("DEFAULT_WHEELCHAIR", is_person, &types)), [chair; 2]);
    }
}
