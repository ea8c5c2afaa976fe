//! Patches of ground: squares, paths, car parks, fields and water, which OpenDRIVE has no words for. They are objects of type `patch`
//! whose `userData` say what lies there and whether people walk on it.

use super::network::{Road, RoadObject};
use super::objects::outline_in_map;
use super::walkable::without_repeats;
use cosfly_domain::{SemanticLabel, WalkableKind, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::polygons::triangulated;
use cosfly_town::world::WorldFromMap;

/// Names of surfaces and what is seen.
const SURFACES: [(&str, SemanticLabel); 6] = [
    ("asphalt", SemanticLabel::Ground),
    ("gravel", SemanticLabel::Ground),
    ("paint", SemanticLabel::RoadLine),
    ("paving", SemanticLabel::SideWalks),
    ("soil", SemanticLabel::Ground),
    ("water", SemanticLabel::Water),
];

/// Adds the patches of a road; gives what is wrong with them.
pub(super) fn add(
    road: &Road,
    world: &WorldFromMap,
    builder: &mut MeshBuilder,
    walkable: &mut Vec<WalkablePolygon>,
) -> Vec<String> {
    let mut warnings = Vec::new();
    let is_patch =
        |object: &&RoadObject| object.type_name == "patch" && (object.surface.is_some() || object.is_walkable);
    for object in road.objects.iter().filter(is_patch) {
        let outline = outline(road, object, world);
        if outline.len() < 3 {
            warnings
                .push(format!("the patch of ground `{}` has no outline of three corners; it is left out", object.id));
            continue;
        }
        if let Some(name) = &object.surface {
            match SURFACES.iter().find(|(word, _)| word == name) {
                Some((_, label)) if add_surface(builder, *label, &outline) => {}
                Some(_) => warnings.push(format!(
                    "the outline of the patch of ground `{}` crosses itself or has over 100 corners; its surface stays grass",
                    object.id
                )),
                None => warnings.push(format!(
                    "the surface of `{}` is `{name}`; it must be {}; it stays grass",
                    object.id,
                    SURFACES.map(|(word, _)| format!("`{word}`")).join(", ")
                )),
            }
        }
        if object.is_walkable {
            walkable.push(WalkablePolygon { kind: WalkableKind::Plaza, outline_in_world: outline, synthetic: false });
        }
    }
    warnings
}

fn outline(road: &Road, object: &RoadObject, world: &WorldFromMap) -> Vec<DVec3> {
    let Some(outline) = object.outlines.iter().find(|outline| outline.closed && !outline.is_hole) else {
        return Vec::new();
    };
    let corners = outline_in_map(road, object, outline).into_iter();
    without_repeats(corners.map(|(foot, _)| world.point(foot)).collect())
}

/// Adds a surface; gives whether its outline can be filled.
fn add_surface(builder: &mut MeshBuilder, label: SemanticLabel, outline: &[DVec3]) -> bool {
    let plan: Vec<DVec2> = outline.iter().map(|corner| corner.truncate()).collect();
    let vertices: Vec<(DVec3, DVec2)> = outline.iter().map(|corner| (*corner, corner.truncate())).collect();
    let triangles = triangulated(&plan);
    if !triangles.is_empty() {
        builder.polygon(label, false, &vertices, &triangles);
    }
    !triangles.is_empty()
}
