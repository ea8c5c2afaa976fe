//! [`MeshSurvey`]: figures of a mesh for people: triangles, pictures, open edges.

use super::textured::TexturedMesh;
use std::collections::BTreeMap;

/// Corners closer than this are one, metres.
const SAME_M: f32 = 1e-3;
/// Most triangles whose edges are compared.
const MOST_COMPARED: usize = 3_000_000;

/// Figures of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshSurvey {
    /// Triangles.
    pub triangles: usize,
    /// Triangles that cannot be drawn.
    pub left_out: usize,
    /// Width and height of each picture, pixels.
    pub textures: Vec<[usize; 2]>,
    /// Whether corners have colours.
    pub has_colours: bool,
    /// Share of the triangles with a picture.
    pub textured_share: f64,
    /// Length of all edges that one triangle alone has, rims of holes and of the scan, metres; none for very large meshes.
    pub open_edges_m: Option<f64>,
    /// Differences from what the file means, in words.
    pub remarks: Vec<String>,
}

impl MeshSurvey {
    /// The figures of a mesh.
    pub fn of(mesh: &TexturedMesh) -> Self {
        let textured =
            mesh.triangles.iter().filter(|it| mesh.materials[it.material as usize].texture.is_some()).count();
        Self {
            triangles: mesh.triangles.len(),
            left_out: mesh.left_out,
            textures: mesh.textures.iter().map(|texture| texture.size().map(|side| side as usize)).collect(),
            has_colours: mesh.triangles.iter().any(|it| it.colours != [[u8::MAX; 3]; 3]),
            textured_share: textured as f64 / mesh.triangles.len().max(1) as f64,
            open_edges_m: (mesh.triangles.len() <= MOST_COMPARED).then(|| open_edges_m(mesh)),
            remarks: mesh.remarks.clone(),
        }
    }
}

fn open_edges_m(mesh: &TexturedMesh) -> f64 {
    let mut numbers: BTreeMap<[i32; 3], u32> = BTreeMap::new();
    let mut edges: Vec<([u32; 2], f64)> = Vec::with_capacity(3 * mesh.triangles.len());
    for triangle in &mesh.triangles {
        let corners = triangle.corners();
        let own = triangle.corners_in_world.map(|corner| {
            let next = numbers.len() as u32;
            *numbers.entry(corner.map(|at| (at / SAME_M).round() as i32)).or_insert(next)
        });
        for (from, to) in [(0, 1), (1, 2), (2, 0)] {
            let ends = [own[from].min(own[to]), own[from].max(own[to])];
            edges.push((ends, corners[from].distance(corners[to])));
        }
    }
    edges.sort_unstable_by_key(|(ends, _)| *ends);
    let alone = edges.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 1);
    // A sum of nothing is -0.
    alone.map(|same| same[0].1).sum::<f64>() + 0.0
}

#[cfg(test)]
mod tests {
    use super::super::config::MeshConfig;
    use super::*;
    use cosfly_frames::DVec3;

    #[test]
    fn the_rim_of_the_example_is_open_and_its_pictures_are_counted() {
        let place = MeshConfig::new("scan.glb").place(DVec3::ZERO).expect("a place");
        let survey = MeshSurvey::of(&TexturedMesh::read(TexturedMesh::EXAMPLE, &[], &place).expect("a mesh"));
        assert_eq!((survey.triangles, survey.textures.as_slice()), (52, &[[32, 32]; 2][..]));
        assert!(survey.has_colours && survey.textured_share < 0.5);
        // Around the ground 160 m, the pavement 80.5 m, the foot of the house 36 m, two cards of 18 m.
        let open_m = survey.open_edges_m.expect("a small mesh");
        assert!((open_m - 312.5).abs() < 1.0, "{open_m}");
    }
}
