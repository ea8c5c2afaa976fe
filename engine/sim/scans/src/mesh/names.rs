//! Kinds of objects and nodes of a file: by the words in their names, else by their size.

use super::parts::{Part, bounds};
use super::whole::{in_groups, in_one_thing};
use cosfly_domain::{ObstacleKind, SemanticLabel};
use cosfly_frames::DVec3;

/// One thing of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Thing {
    /// Kind.
    pub kind: Kind,
    /// Its triangles; each part of something solid hangs together.
    pub parts: Vec<Part>,
}

/// Kind of a thing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
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
const WORDS: &[(&[&str], Kind)] = &[
    // Nobody walks on what stands on a square, whatever else its name says.
    (&["fountain", "statue", "monument", "planter", "kiosk"], named(ObstacleKind::Static)),
    (
        &["sidewalk", "pavement", "footway", "footpath", "walkway", "plaza"],
        Kind::Ground(SemanticLabel::SideWalks, true),
    ),
    (&["crosswalk", "crossing", "roadline", "marking"], Kind::Ground(SemanticLabel::Roads, false)),
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
    (&["road", "street", "asphalt", "parking"], Kind::Ground(SemanticLabel::Roads, false)),
    (&["terrain", "ground", "grass", "landscape", "lawn", "soil"], Kind::Ground(SemanticLabel::Terrain, false)),
    (&["water", "river", "lake"], Kind::Ground(SemanticLabel::Water, false)),
];

/// A part without a telling name is ground when it is wider than this share of the scene and flatter than this share of its width.
const GROUND_WIDTH_SHARE: f64 = 0.6;
const GROUND_HEIGHT_SHARE: f64 = 0.05;
/// A part without a telling name is ground, too, when it is as flat as this and lies as low over the scene's lowest point, metres.
const FLAT_M: f64 = 0.3;
const LOW_M: f64 = 0.5;
/// Smallest building, height and width, metres.
const SMALLEST_BUILDING_M: [f64; 2] = [2.5, 3.0];

const fn named(kind: ObstacleKind) -> Kind {
    Kind::Solid { kind, is_named: true }
}

/// The things of a scene. An object or node with a telling name is one thing, see [`in_one_thing`]; others fall apart into what hangs
/// together and, where they have a name, touches.
pub fn things(parts: Vec<Part>, notes: &mut Vec<String>) -> Vec<Thing> {
    let (low, high) = bounds(parts.iter().flat_map(|part| &part.vertices));
    let (mut grounds, mut apart) = (0, 0);
    let mut things = Vec::new();
    for of_owner in parts.chunk_by(|a, b| a.owner == b.owner && by_name(&a.name) == by_name(&b.name)) {
        let connected = || of_owner.iter().flat_map(Part::connected).collect::<Vec<Part>>();
        match by_name(&of_owner[0].name) {
            Some(kind @ Kind::Ground(..)) => {
                things.extend(of_owner.iter().map(|part| Thing { kind, parts: vec![part.clone()] }));
            }
            Some(kind) => {
                let name = &of_owner[0].name;
                let (whole, is_apart) = if of_owner.iter().all(|part| part.name == *name) {
                    in_one_thing(connected(), is_collection(name))
                } else {
                    // Groups of one object: walls and roof of a house, or the lamps of a street.
                    (in_groups(connected(), true), false)
                };
                apart += usize::from(is_apart);
                things.extend(whole.into_iter().map(|parts| Thing { kind, parts }));
            }
            None => {
                let is_ground = |one: &Part| by_size(bounds(one.vertices.iter()), low, high - low).is_ground();
                let (flat, solid): (Vec<Part>, Vec<Part>) = connected().into_iter().partition(is_ground);
                grounds += flat.len();
                let groups = flat.into_iter().map(|part| vec![part]);
                let groups = groups.chain(in_groups(solid, !of_owner[0].name.is_empty()));
                things.extend(groups.map(|parts| {
                    let ends = bounds(parts.iter().flat_map(|part| &part.vertices));
                    Thing { kind: by_size(ends, low, high - low), parts }
                }));
            }
        }
    }
    if grounds > 0 {
        notes.push(format!("{grounds} flat meshes are taken as the ground: their names say nothing"));
    }
    if apart > 0 {
        notes.push(format!(
            "{apart} meshes are named in the plural or very wide: each piece that hangs together is a thing of its own; name \
             each thing to have it whole"
        ));
    }
    things
}

impl Kind {
    /// Whether it is ground.
    pub fn is_ground(&self) -> bool {
        matches!(self, Self::Ground(..))
    }
}

fn by_name(name: &str) -> Option<Kind> {
    telling(&name.to_lowercase()).map(|(kind, _)| kind)
}

/// Whether a name tells a kind.
pub fn is_telling(name: &str) -> bool {
    by_name(name).is_some()
}

/// Whether a telling name stands for many things: its word is in the plural.
fn is_collection(name: &str) -> bool {
    let name = name.to_lowercase();
    telling(&name).is_some_and(|(_, word)| {
        let after = name.find(word).map_or("", |at| &name[at + word.len()..]);
        let ending = after.strip_prefix('e').unwrap_or(after).strip_prefix('s');
        word.ends_with('s') || ending.is_some_and(|rest| !rest.starts_with(char::is_alphabetic))
    })
}

fn telling(name: &str) -> Option<(Kind, &'static str)> {
    WORDS.iter().find_map(|(words, kind)| Some((*kind, *words.iter().find(|word| name.contains(**word))?)))
}

fn by_size((low, high): (DVec3, DVec3), lowest: DVec3, scene: DVec3) -> Kind {
    let size = high - low;
    let (widest, scene_width) = (size.truncate().max_element(), scene.truncate().max_element());
    let lies_low = size.z <= FLAT_M && high.z - lowest.z <= LOW_M;
    if lies_low && size.truncate().min_element() > size.z {
        return Kind::Ground(SemanticLabel::Terrain, false);
    }
    if size.truncate().min_element() >= GROUND_WIDTH_SHARE * scene.truncate().min_element().min(scene_width)
        && size.z <= GROUND_HEIGHT_SHARE * widest
    {
        return Kind::Ground(SemanticLabel::Terrain, false);
    }
    let [height_m, width_m] = SMALLEST_BUILDING_M;
    let is_building = size.z >= height_m && size.truncate().min_element() >= width_m;
    let kind = if is_building { ObstacleKind::Building } else { ObstacleKind::Static };
    Kind::Solid { kind, is_named: false }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_common_exports_are_understood() {
        for (name, expected) in [
            ("SM_Sidewalk_03", Some(Kind::Ground(SemanticLabel::SideWalks, true))),
            ("Road_main", Some(Kind::Ground(SemanticLabel::Roads, false))),
            ("road_sign_12", Some(named(ObstacleKind::TrafficSign))),
            ("BP_StreetLight", Some(named(ObstacleKind::Lamp))),
            ("Buildings.042", Some(named(ObstacleKind::Building))),
            ("Cube.001", None),
            ("pavement-fountain", Some(named(ObstacleKind::Static))),
        ] {
            assert_eq!(by_name(name), expected, "{name}");
        }
        for (name, is_many) in [
            ("building-type-a_3", false),
            ("map.osm_buildings", true),
            ("Bushes", true),
            ("Tree", false),
            ("BuildingSmall_1", false),
            ("Cubes", false),
        ] {
            assert_eq!(is_collection(name), is_many, "{name}");
        }
    }
}
