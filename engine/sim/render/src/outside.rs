//! The static faces of a town, for renderers that find elsewhere which one is nearest at each pixel.

use crate::faces::{box_lift, ground_lift};
use crate::scene::{Scene, clusters_of, set_roofs};
use cosfly_domain::Town;
use cosfly_frames::DVec3;
use cosfly_materials::drawn_shapes::cut_to_drawn;
use cosfly_materials::ground_kinds::GroundKinds;
use cosfly_materials::parts::{BOX_FACES, Cluster, SceneBox, boxes_of};

/// A static face: numbered by its place in [`Scene::faces_of`].
#[derive(Clone, Debug, PartialEq)]
pub struct SceneFace {
    /// A flat convex polygon, metres. Neighbours share corners exactly.
    pub corners_in_world: Vec<DVec3>,
    /// Set for the faces of boxes, which are seen from outside only.
    pub outward_in_world: Option<DVec3>,
    /// Unit normal; outward for boxes, upward for ground.
    pub normal_in_world: DVec3,
    /// A point of its plane, metres; corners may lie a millimetre off the plane.
    pub point_in_world: DVec3,
    /// Share by which its inverse depth counts as greater where faces are coplanar.
    pub lift: f64,
    /// CARLA label id.
    pub label: u8,
    /// Instance id; 0 for ground.
    pub instance: u32,
}

impl Scene {
    /// Faces of a town's scene, without people: six of each box, then the ground's. Light and looks are not prepared.
    pub fn faces_of(town: &Town) -> Vec<SceneFace> {
        // Looks alone depend on a seed.
        let mut boxes = boxes_of(town, 0);
        set_roofs(&mut boxes);
        cut_to_drawn(&mut boxes, &GroundKinds::of(town));
        faces(&boxes, &clusters_of(town))
    }
}

fn faces(boxes: &[SceneBox], clusters: &[Cluster]) -> Vec<SceneFace> {
    let ground: usize = clusters.iter().map(|cluster| cluster.polygons.len()).sum();
    let mut faces = Vec::with_capacity(BOX_FACES.len() * boxes.len() + ground);
    for (index, b) in (0u32..).zip(boxes) {
        faces.extend(BOX_FACES.iter().enumerate().map(|(face, (_, _, around))| SceneFace {
            corners_in_world: around.map(|corner| b.corners_in_world[corner]).to_vec(),
            outward_in_world: Some(b.normal_in_world(face)),
            normal_in_world: b.normal_in_world(face),
            point_in_world: b.corners_in_world[around[0]],
            lift: box_lift(index),
            label: b.label,
            instance: b.instance,
        }));
    }
    for cluster in clusters {
        faces.extend(cluster.polygons.iter().map(|polygon| {
            let corners = cluster.corners[polygon.range()].iter();
            SceneFace {
                corners_in_world: corners.map(|corner| cluster.points_in_world[usize::from(*corner)]).collect(),
                outward_in_world: None,
                normal_in_world: polygon.normal_in_world,
                point_in_world: polygon.middle_in_world,
                lift: ground_lift(polygon.label),
                label: polygon.label.id(),
                instance: 0,
            }
        }));
    }
    faces
}
