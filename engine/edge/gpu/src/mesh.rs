//! Triangles of a scene for the card.

use cosfly_frames::DVec3;
use cosfly_render::Scene;

/// A corner of a triangle.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Vertex {
    /// Position relative to the middle of the mesh, metres.
    pub place: [f32; 3],
    /// Number of the face in [`Scene::faces`].
    pub number: u32,
    /// Factor on the inverse depth that orders coplanar faces.
    pub lift: f32,
}

/// All triangles: those of boxes first (visible from outside only), then the ground.
pub struct Mesh {
    /// Vertices, three per triangle.
    pub vertices: Vec<Vertex>,
    /// Number of vertices that belong to boxes.
    pub box_vertices: u32,
    /// Middle of the mesh, world frame, metres; coordinates relative to it fit single precision.
    pub middle_in_world: DVec3,
}

/// Depth factor between coplanar ground layers; larger than the CPU's, because cards interpolate in single precision.
const LAYER_LIFT: f32 = 1.6e-5;
/// Depth factor between coplanar faces of different boxes.
const BOX_LIFT: f32 = 4e-6;
const FACES_PER_BOX: usize = 6;

impl Mesh {
    /// Cuts the faces of a scene into triangles.
    pub fn new(scene: &Scene) -> Self {
        let faces = scene.faces();
        let corners = || faces.iter().flat_map(|face| face.corners_in_world.iter().copied());
        let low = corners().fold(DVec3::INFINITY, DVec3::min);
        let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        let middle_in_world = if faces.is_empty() { DVec3::ZERO } else { 0.5 * (low + high) };
        let (mut vertices, mut box_vertices) = (Vec::new(), 0);
        for (number, face) in faces.iter().enumerate() {
            let lift = match face.outward_in_world {
                Some(_) => 1.0 + BOX_LIFT * ((number / FACES_PER_BOX) % 8) as f32,
                None => 1.0 + LAYER_LIFT * layer_of(face.label),
            };
            for mut points in fan(&face.corners_in_world) {
                let turn = (points[1] - points[0]).cross(points[2] - points[0]);
                if face.outward_in_world.is_some_and(|outward| turn.dot(outward) < 0.0) {
                    points.swap(1, 2);
                }
                vertices.extend(points.map(|point| {
                    let place = (point - middle_in_world).as_vec3().to_array();
                    Vertex { place, number: number as u32, lift }
                }));
            }
            if face.outward_in_world.is_some() {
                box_vertices = vertices.len() as u32;
            }
        }
        Self { vertices, box_vertices, middle_in_world }
    }
}

/// Triangles of a convex polygon.
fn fan(corners: &[DVec3]) -> impl Iterator<Item = [DVec3; 3]> + '_ {
    (2..corners.len()).map(|k| [corners[0], corners[k - 1], corners[k]])
}

/// Order of coplanar ground layers, by CARLA's label ids, as in the CPU renderer.
fn layer_of(label: u8) -> f32 {
    const TERRAIN: u8 = 10;
    const WATER: u8 = 23;
    const GROUND: u8 = 25;
    const ROADS: u8 = 1;
    const ROAD_LINE: u8 = 24;
    match label {
        TERRAIN | WATER | GROUND => 0.0,
        ROADS => 1.0,
        ROAD_LINE => 3.0,
        _ => 2.0,
    }
}
