//! What a part is: by the words in its name, else by its size.

use super::parts::{Part, bounds};
use cosfly_frames::DVec3;
use cosfly_town::{ObstacleKind, SemanticLabel};

/// What a part becomes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Thing {
    /// Ground; walkable where it is a pavement.
    Ground(SemanticLabel, bool),
    /// Something solid.
    Solid {
        /// Its kind.
        kind: ObstacleKind,
        /// Whether its name tells the kind.
        is_named: bool,
    },
}

/// Words in names, the first that is found decides; longer ones come before those that they hold.
const WORDS: &[(&[&str], Thing)] = &[
    (
        &["sidewalk", "pavement", "footway", "footpath", "walkway", "plaza"],
        Thing::Ground(SemanticLabel::SideWalks, true),
    ),
    (&["crosswalk", "crossing", "roadline", "marking"], Thing::Ground(SemanticLabel::Roads, false)),
    (&["streetlight", "street_light", "lamp", "lantern"], named(ObstacleKind::Lamp)),
    (&["trafficlight", "traffic_light"], named(ObstacleKind::TrafficLight)),
    (&["trafficsign", "traffic_sign", "roadsign", "road_sign"], named(ObstacleKind::TrafficSign)),
    (&["guardrail", "guard_rail"], named(ObstacleKind::GuardRail)),
    (&["bridge"], named(ObstacleKind::Bridge)),
    (&["trunk"], named(ObstacleKind::TreeTrunk)),
    (&["tree", "crown", "foliage", "leaves", "canopy"], named(ObstacleKind::TreeCrown)),
    (&["bush", "hedge", "shrub"], named(ObstacleKind::Bush)),
    (&["fence", "railing"], named(ObstacleKind::Fence)),
    (
        &["building", "house", "facade", "roof", "church", "tower", "garage", "skyscraper"],
        named(ObstacleKind::Building),
    ),
    (&["wall"], named(ObstacleKind::Wall)),
    (&["pole", "mast", "post"], named(ObstacleKind::Pole)),
    (&["vehicle", "truck", "parked"], named(ObstacleKind::Car)),
    (&["road", "street", "asphalt", "parking"], Thing::Ground(SemanticLabel::Roads, false)),
    (&["terrain", "ground", "grass", "landscape", "lawn", "soil"], Thing::Ground(SemanticLabel::Terrain, false)),
    (&["water", "river", "lake"], Thing::Ground(SemanticLabel::Water, false)),
];

/// A part without a telling name is ground when it is wider than this share of the scene and flatter than this share of its width.
const GROUND_WIDTH_SHARE: f64 = 0.6;
const GROUND_HEIGHT_SHARE: f64 = 0.05;
/// A part without a telling name is ground, too, when it is as flat as this and lies as low over the scene's lowest point, metres.
const FLAT_M: f64 = 0.3;
const LOW_M: f64 = 0.5;
/// Smallest building, height and width, metres.
const SMALLEST_BUILDING_M: [f64; 2] = [2.5, 3.0];

const fn named(kind: ObstacleKind) -> Thing {
    Thing::Solid { kind, is_named: true }
}

/// What each part is. Unnamed parts fall apart into what hangs together, solid named ones too.
pub fn things(parts: Vec<Part>, notes: &mut Vec<String>) -> Vec<(Thing, Part)> {
    let (low, high) = bounds(parts.iter().flat_map(|part| &part.vertices));
    let mut grounds = 0;
    let mut things = Vec::new();
    for part in parts {
        match by_name(&part.name) {
            Some(ground @ Thing::Ground(..)) => things.push((ground, part)),
            Some(solid) => things.extend(part.connected().into_iter().map(|one| (solid, one))),
            None => {
                for one in part.connected() {
                    let thing = by_size(&one, low, high - low);
                    grounds += usize::from(matches!(thing, Thing::Ground(..)));
                    things.push((thing, one));
                }
            }
        }
    }
    if grounds > 0 {
        notes.push(format!("{grounds} flat meshes are taken as the ground: their names say nothing"));
    }
    things
}

fn by_name(name: &str) -> Option<Thing> {
    let name = name.to_lowercase();
    WORDS.iter().find(|(words, _)| words.iter().any(|word| name.contains(word))).map(|(_, thing)| *thing)
}

fn by_size(part: &Part, lowest: DVec3, scene: DVec3) -> Thing {
    let (low, high) = bounds(part.vertices.iter());
    let size = high - low;
    let (widest, scene_width) = (size.truncate().max_element(), scene.truncate().max_element());
    let lies_low = size.z <= FLAT_M && high.z - lowest.z <= LOW_M;
    if lies_low && size.truncate().min_element() > size.z {
        return Thing::Ground(SemanticLabel::Terrain, false);
    }
    if size.truncate().min_element() >= GROUND_WIDTH_SHARE * scene.truncate().min_element().min(scene_width)
        && size.z <= GROUND_HEIGHT_SHARE * widest
    {
        return Thing::Ground(SemanticLabel::Terrain, false);
    }
    let [height_m, width_m] = SMALLEST_BUILDING_M;
    let is_building = size.z >= height_m && size.truncate().min_element() >= width_m;
    let kind = if is_building { ObstacleKind::Building } else { ObstacleKind::Static };
    Thing::Solid { kind, is_named: false }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_common_exports_are_understood() {
        for (name, expected) in [
            ("SM_Sidewalk_03", Some(Thing::Ground(SemanticLabel::SideWalks, true))),
            ("Road_main", Some(Thing::Ground(SemanticLabel::Roads, false))),
            ("road_sign_12", Some(named(ObstacleKind::TrafficSign))),
            ("BP_StreetLight", Some(named(ObstacleKind::Lamp))),
            ("Buildings.042", Some(named(ObstacleKind::Building))),
            ("Cube.001", None),
        ] {
            assert_eq!(by_name(name), expected, "{name}");
        }
    }
}
