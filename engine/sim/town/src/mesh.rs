//! [`MeshBuilder`]: surfaces of a town while it is read, one mesh for each label.

use cosfly_domain::{SemanticLabel, SurfaceMesh};
use cosfly_frames::{DVec2, DVec3};
use std::collections::BTreeMap;

/// One growing mesh for each label.
#[derive(Debug, Default)]
pub struct MeshBuilder {
    meshes: BTreeMap<(SemanticLabel, bool), SurfaceMesh>,
}

impl MeshBuilder {
    /// Adds a quad; corners in order around it, each with its place along and across the road.
    pub fn quad(&mut self, label: SemanticLabel, synthetic: bool, corners: [(DVec3, DVec2); 4]) {
        self.polygon(label, synthetic, &corners, &[[0, 1, 2], [0, 2, 3]]);
    }

    /// Adds triangles over some vertices.
    pub fn polygon(
        &mut self,
        label: SemanticLabel,
        synthetic: bool,
        vertices: &[(DVec3, DVec2)],
        triangles: &[[u32; 3]],
    ) {
        let mesh = self.meshes.entry((label, synthetic)).or_insert_with(|| SurfaceMesh {
            label,
            vertices_in_world: Vec::new(),
            along_across_m: Vec::new(),
            triangles: Vec::new(),
            synthetic,
        });
        let first = mesh.vertices_in_world.len() as u32;
        mesh.vertices_in_world.extend(vertices.iter().map(|(point, _)| *point));
        mesh.along_across_m.extend(vertices.iter().map(|(_, along_across)| *along_across));
        mesh.triangles.extend(triangles.iter().map(|triangle| triangle.map(|corner| first + corner)));
    }

    /// Goes on with finished meshes.
    pub fn from_meshes(meshes: Vec<SurfaceMesh>) -> Self {
        Self { meshes: meshes.into_iter().map(|mesh| ((mesh.label, mesh.synthetic), mesh)).collect() }
    }

    /// The meshes made so far.
    pub fn meshes(&self) -> impl Iterator<Item = &SurfaceMesh> {
        self.meshes.values()
    }

    /// The meshes in the order of their labels.
    pub fn finish(self) -> Vec<SurfaceMesh> {
        self.meshes.into_values().collect()
    }
}
