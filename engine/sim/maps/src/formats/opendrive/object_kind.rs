//! Kind of an `<object>`, from its type and name.

use super::network::RoadObject;
use cosfly_domain::ObstacleKind;

/// Part of the town that an object becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ObjectKind {
    /// Something solid.
    Solid(ObstacleKind),
    /// A pedestrian crossing.
    Crosswalk,
    /// Paint, parking spaces, patches and other flat things.
    Flat,
}

/// Words in `name` and `subtype` that say more than the type, in the order in which they are tried.
const NAMES: &[(&str, ObstacleKind)] = &[
    ("streetlamp", ObstacleKind::Lamp),
    ("street_lamp", ObstacleKind::Lamp),
    ("streetlight", ObstacleKind::Lamp),
    ("lamp", ObstacleKind::Lamp),
    ("trafficlight", ObstacleKind::TrafficLight),
    ("traffic_light", ObstacleKind::TrafficLight),
    ("busstop", ObstacleKind::Static),
    ("bus_stop", ObstacleKind::Static),
    ("guardrail", ObstacleKind::GuardRail),
    ("guard_rail", ObstacleKind::GuardRail),
    ("jerseybarrier", ObstacleKind::GuardRail),
    ("fence", ObstacleKind::Fence),
    ("railing", ObstacleKind::Fence),
    ("wall", ObstacleKind::Wall),
    ("hedge", ObstacleKind::Bush),
    ("bush", ObstacleKind::Bush),
    ("raisedmedian", ObstacleKind::Static),
    ("bench", ObstacleKind::Bench),
];

/// Words of painted things that some exporters give the type "-1" or none.
const PAINT: &[&str] = &[
    "stencil",
    "stopline",
    "stop_line",
    "singlewhite",
    "singleyellow",
    "solidwhite",
    "chevron",
    "crosswalk",
    "dashed",
];

/// Decides by type first, by name where the type says little.
pub(super) fn kind_of(object: &RoadObject) -> ObjectKind {
    let says_little = matches!(object.type_name.as_str(), "" | "-1" | "none");
    if says_little && PAINT.iter().any(|word| object.name.contains(word)) {
        return ObjectKind::Flat;
    }
    let named = NAMES.iter().find(|(word, _)| object.name.contains(word)).map(|(_, kind)| *kind);
    let solid = |usual: ObstacleKind| ObjectKind::Solid(named.unwrap_or(usual));
    match object.type_name.as_str() {
        "crosswalk" => ObjectKind::Crosswalk,
        // Surveys list crossings among the road marks.
        "roadmark" if object.name.contains("crosswalk") => ObjectKind::Crosswalk,
        "building" => solid(ObstacleKind::Building),
        "tree" => ObjectKind::Solid(ObstacleKind::TreeTrunk),
        "vegetation" if object.name.contains("tree") => ObjectKind::Solid(ObstacleKind::TreeTrunk),
        "vegetation" => ObjectKind::Solid(ObstacleKind::Bush),
        "streetlamp" => ObjectKind::Solid(ObstacleKind::Lamp),
        "pole" | "gantry" => solid(ObstacleKind::Pole),
        "barrier" => solid(ObstacleKind::GuardRail),
        "railing" => solid(ObstacleKind::Fence),
        "soundbarrier" => ObjectKind::Solid(ObstacleKind::Wall),
        "car" | "van" | "bus" | "truck" | "trailer" => ObjectKind::Solid(ObstacleKind::Car),
        "bridge" => ObjectKind::Solid(ObstacleKind::Bridge),
        "parkingspace" | "roadmark" | "roadsurface" | "patch" | "wind" => ObjectKind::Flat,
        _ => solid(match object.name.as_str() {
            name if name.contains("building") => ObstacleKind::Building,
            name if name.contains("tree") => ObstacleKind::TreeTrunk,
            name if name.contains("pole") || name.contains("post") => ObstacleKind::Pole,
            name if name.starts_with("speed_") || name.contains("sign") => ObstacleKind::TrafficSign,
            "stall" | "marketstall" => ObstacleKind::Stall,
            _ => ObstacleKind::Static,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_decide_where_types_say_little() {
        for (type_name, name, expected) in [
            ("building", "", ObjectKind::Solid(ObstacleKind::Building)),
            ("building", "busstop", ObjectKind::Solid(ObstacleKind::Static)),
            ("pole", "streetlamp", ObjectKind::Solid(ObstacleKind::Lamp)),
            ("pole", "trafficsign", ObjectKind::Solid(ObstacleKind::Pole)),
            ("barrier", "wall", ObjectKind::Solid(ObstacleKind::Wall)),
            ("barrier", "railing", ObjectKind::Solid(ObstacleKind::Fence)),
            ("barrier", "", ObjectKind::Solid(ObstacleKind::GuardRail)),
            ("vegetation", "", ObjectKind::Solid(ObstacleKind::Bush)),
            ("-1", "speed_30", ObjectKind::Solid(ObstacleKind::TrafficSign)),
            ("-1", "signpost_10ft", ObjectKind::Solid(ObstacleKind::Pole)),
            ("-1", "stencil_stop", ObjectKind::Flat),
            ("parkingspace", "", ObjectKind::Flat),
            ("crosswalk", "simplecrosswalk", ObjectKind::Crosswalk),
            ("roadmark", "crosswalk", ObjectKind::Crosswalk),
            ("roadmark", "arrowleft", ObjectKind::Flat),
            ("obstacle", "parkbench", ObjectKind::Solid(ObstacleKind::Bench)),
            ("obstacle", "stall", ObjectKind::Solid(ObstacleKind::Stall)),
            ("somethingnew", "", ObjectKind::Solid(ObstacleKind::Static)),
        ] {
            let object = RoadObject { type_name: type_name.to_owned(), name: name.to_owned(), ..RoadObject::default() };
            assert_eq!(kind_of(&object), expected, "{type_name} {name}");
        }
    }
}
