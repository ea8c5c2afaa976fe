//! Names of things that readers of meshes know.

use cosfly_domain::SemanticLabel;

/// Name of a thing by its label and id.
pub fn name(label: u8, instance: u32) -> String {
    let known = WORDS.iter().find(|(known, _)| known.id() == label);
    format!("{}_{instance}", known.map_or("thing", |(_, word)| *word))
}

const WORDS: [(SemanticLabel, &str); 18] = [
    (SemanticLabel::Roads, "road"),
    (SemanticLabel::RoadLine, "roadline"),
    (SemanticLabel::SideWalks, "sidewalk"),
    (SemanticLabel::Building, "building"),
    (SemanticLabel::Wall, "wall"),
    (SemanticLabel::Fence, "fence"),
    (SemanticLabel::Pole, "pole"),
    (SemanticLabel::TrafficLight, "trafficlight"),
    (SemanticLabel::TrafficSign, "trafficsign"),
    (SemanticLabel::Vegetation, "tree"),
    (SemanticLabel::Terrain, "terrain"),
    (SemanticLabel::Ground, "ground"),
    (SemanticLabel::Static, "planter"),
    (SemanticLabel::Car, "parked"),
    (SemanticLabel::Truck, "truck"),
    (SemanticLabel::Bridge, "bridge"),
    (SemanticLabel::GuardRail, "guardrail"),
    (SemanticLabel::Water, "water"),
];
