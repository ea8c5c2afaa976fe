//! Meaning of kinds, functions and classes of objects and surfaces.

use super::document::Attributes;
use cosfly_domain::{ObstacleKind, SemanticLabel, WalkableKind};

/// Part of the town that an object becomes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Part {
    /// A building or a part of one.
    Building,
    /// Everything from its lowest corner to its upper faces is solid.
    Solid(ObstacleKind),
    /// A tree.
    Tree,
    /// Ground where its faces lie flat, plants where they rise.
    Plants,
    /// Ground, walkable or not; surfaces of roads may say more.
    Ground(SemanticLabel, Option<WalkableKind>),
    /// Nothing that cosfly shows.
    Nothing,
}

/// Words in functions and classes, and numbers of the standard's own lists, of ground that people walk on.
const WALKS: &[&str] = &[
    "voetpad",
    "voetganger",
    "footpath",
    "footway",
    "foot-",
    "sidewalk",
    "pavement",
    "pedestrian",
    "walkway",
    "gehweg",
    "gehsteig",
    "fussweg",
    "fußweg",
    "fussg",
    "fußg",
    "trottoir",
    "bürgersteig",
    "trap",
    "stair",
    "steps",
    "promenade",
];
const CROSSINGS: &[&str] = &["crossing", "crosswalk", "zebra", "oversteek"];
const SQUARES: &[&str] = &["square", "plaza", "platz", "plein"];
const WALLS: &[&str] = &["muur", "wall", "mauer"];
const FENCES: &[&str] = &["fence", "hek", "zaun", "railing"];
const LAMPS: &[&str] = &["lamp", "lantern", "light", "lichtmast"];

/// Part of a town that an object of this kind is, `attributes` telling more.
pub(super) fn part_of(kind: &str, attributes: Option<&Attributes>) -> Part {
    let says = |words: &[&str]| attributes.is_some_and(|attributes| says_one_of(attributes, words));
    match kind {
        "Building" | "BuildingPart" | "BuildingInstallation" | "BuildingUnit" | "BuildingConstructiveElement" => {
            Part::Building
        }
        "CityFurniture" | "GenericCityObject" | "OtherConstruction" | "+GenericCityObject" => Part::Solid(match () {
            () if says(WALLS) => ObstacleKind::Wall,
            () if says(FENCES) => ObstacleKind::Fence,
            () if says(LAMPS) => ObstacleKind::Lamp,
            () => ObstacleKind::Static,
        }),
        "SolitaryVegetationObject" => Part::Tree,
        "PlantCover" => Part::Plants,
        "TransportSquare" => Part::Ground(SemanticLabel::SideWalks, Some(WalkableKind::Plaza)),
        "Road" | "Track" => match attributes.and_then(walkable_of) {
            Some(WalkableKind::Crossing) => Part::Ground(SemanticLabel::Roads, Some(WalkableKind::Crossing)),
            Some(kind) => Part::Ground(SemanticLabel::SideWalks, Some(kind)),
            None => Part::Ground(SemanticLabel::Roads, Some(WalkableKind::Road)),
        },
        "Bridge" | "BridgePart" => Part::Ground(SemanticLabel::Bridge, Some(WalkableKind::Plaza)),
        "Railway" => Part::Ground(SemanticLabel::RailTrack, None),
        "WaterBody" | "Waterway" => Part::Ground(SemanticLabel::Water, None),
        "LandUse" | "TINRelief" => Part::Ground(SemanticLabel::Terrain, None),
        _ => Part::Nothing,
    }
}

/// The ground of a road's surface, whose own meaning goes before that of its road.
pub(super) fn ground_of_surface(
    surface: &str,
    attributes: &Attributes,
    road: (SemanticLabel, Option<WalkableKind>),
) -> (SemanticLabel, Option<WalkableKind>) {
    match (surface, walkable_of(attributes)) {
        ("TrafficArea" | "AuxiliaryTrafficArea", Some(WalkableKind::Crossing)) => {
            (SemanticLabel::Roads, Some(WalkableKind::Crossing))
        }
        ("TrafficArea" | "AuxiliaryTrafficArea", Some(kind)) => (SemanticLabel::SideWalks, Some(kind)),
        ("AuxiliaryTrafficArea", None) => (SemanticLabel::Terrain, None),
        ("TransportationMarking", _) => (SemanticLabel::RoadLine, None),
        _ => road,
    }
}

fn walkable_of(attributes: &Attributes) -> Option<WalkableKind> {
    // Codes of the standard's list of functions of traffic areas.
    let is_code = |codes: &[&str]| attributes.words().any(|word| codes.contains(&word.as_str()));
    match () {
        () if says_one_of(attributes, CROSSINGS) || is_code(&["20"]) => Some(WalkableKind::Crossing),
        () if says_one_of(attributes, WALKS) || is_code(&["2", "4"]) => Some(WalkableKind::Sidewalk),
        () if says_one_of(attributes, SQUARES) || is_code(&["5"]) => Some(WalkableKind::Plaza),
        () => None,
    }
}

fn says_one_of(attributes: &Attributes, words: &[&str]) -> bool {
    attributes.words().any(|own| words.iter().any(|word| own.contains(word)))
}

/// Faces of rooms, which nobody sees from outside.
pub(super) fn is_indoors(surface: &str) -> bool {
    matches!(surface, "InteriorWallSurface" | "FloorSurface" | "CeilingSurface" | "ClosureSurface")
}
