//! A town as a mesh whose truth is known: the triangles that pictures of it show, with names that readers of meshes know.

use cosfly_domain::SemanticLabel;
use cosfly_render::SceneTriangle;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Triangles as OBJ (y up), thing by thing, with names that readers of meshes know.
pub fn obj_of(triangles: &[SceneTriangle]) -> String {
    let mut things: BTreeMap<(u8, u32), Vec<&SceneTriangle>> = BTreeMap::new();
    triangles.iter().for_each(|triangle| things.entry((triangle.label, triangle.instance)).or_default().push(triangle));
    let (mut text, mut corners) = (String::from("# metres, y up\n"), 0);
    for ((label, instance), triangles) in things {
        let known = WORDS.iter().find(|(known, ..)| known.id() == label);
        let (word, [red, green, blue]) = known.map_or(("thing", [0.5; 3]), |(_, word, colour)| (*word, *colour));
        let _ = writeln!(text, "o {word}_{instance}");
        for triangle in triangles {
            for corner in triangle.corners_in_world {
                let _ = writeln!(text, "v {:.4} {:.4} {:.4} {red} {green} {blue}", corner.x, corner.z, corner.y);
            }
            let _ = writeln!(text, "f {} {} {}", corners + 1, corners + 2, corners + 3);
            corners += 3;
        }
    }
    text
}

/// Words and colours of labels.
const WORDS: [(SemanticLabel, &str, [f32; 3]); 14] = [
    (SemanticLabel::Roads, "road", [0.38, 0.38, 0.39]),
    (SemanticLabel::RoadLine, "roadline", [0.85, 0.85, 0.82]),
    (SemanticLabel::SideWalks, "sidewalk", [0.62, 0.6, 0.58]),
    (SemanticLabel::Building, "building", [0.72, 0.55, 0.45]),
    (SemanticLabel::Wall, "wall", [0.6, 0.55, 0.5]),
    (SemanticLabel::Fence, "fence", [0.4, 0.3, 0.22]),
    (SemanticLabel::Pole, "pole", [0.3, 0.32, 0.33]),
    (SemanticLabel::TrafficLight, "trafficlight", [0.2, 0.2, 0.2]),
    (SemanticLabel::TrafficSign, "trafficsign", [0.8, 0.2, 0.15]),
    (SemanticLabel::Vegetation, "tree", [0.25, 0.42, 0.16]),
    (SemanticLabel::Terrain, "terrain", [0.36, 0.45, 0.24]),
    (SemanticLabel::Static, "planter", [0.55, 0.5, 0.4]),
    (SemanticLabel::Car, "parked", [0.2, 0.3, 0.55]),
    (SemanticLabel::Truck, "truck", [0.5, 0.5, 0.55]),
];
