//! A textured mesh of a scene: a scan's triangles in the place of a town's boxes, in small bounded clusters.

use crate::mesh_labels::{MeshLook, looks};
use cosfly_domain::Town;
use cosfly_frames::{DVec3, real};
use cosfly_geometry::{Shape, Triangle};
use cosfly_models::mesh::{MeshConfig, TexturedMesh};
use std::ops::Range;

/// Triangles in one cluster.
const CLUSTER_TRIANGLES: usize = 128;

/// A mesh that stands in the world of a town, whose labels it has.
pub struct SceneMesh {
    pub(crate) mesh: TexturedMesh,
    pub(crate) clusters: Vec<MeshCluster>,
    /// Label and id of each triangle.
    pub(crate) looks: Vec<MeshLook>,
    /// Factor of the mesh's light.
    pub(crate) exposure: f32,
    known_share: f64,
}

/// Neighbouring triangles.
pub(crate) struct MeshCluster {
    pub center_in_world: DVec3,
    pub half_bounds_m: DVec3,
    pub triangles: Range<usize>,
}

impl SceneMesh {
    /// Takes over a mesh that was read for the place of its parameters; labels are those of the town in the same places.
    pub fn new(mut mesh: TexturedMesh, config: &MeshConfig, town: &Town) -> Self {
        let [low, high] = mesh.bounds();
        let cell_m = ((high - low).max_element() / f64::from(CELLS - 1)).max(1e-9);
        mesh.triangles.sort_by_cached_key(|triangle| {
            let middle = triangle.corners().into_iter().sum::<DVec3>() / 3.0;
            z_order(((middle - low) / cell_m).to_array().map(|at| at as u32))
        });
        let looks = looks(&mesh, town);
        let areas = || {
            mesh.triangles.iter().map(|triangle| {
                let [a, b, c] = triangle.corners();
                (b - a).cross(c - a).length()
            })
        };
        let known = areas().zip(&looks).filter(|(_, look)| !look.is_unknown).map(|(area, _)| area).sum::<f64>();
        // Triangles that all are too small for 32-bit numbers have no area.
        let known_share = known / areas().sum::<f64>().max(f64::MIN_POSITIVE);
        let clusters = (0..mesh.triangles.len()).step_by(CLUSTER_TRIANGLES).map(|first| {
            let triangles = first..(first + CLUSTER_TRIANGLES).min(mesh.triangles.len());
            let corners = || mesh.triangles[triangles.clone()].iter().flat_map(|triangle| triangle.corners());
            let low = corners().fold(DVec3::INFINITY, DVec3::min);
            let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
            MeshCluster { center_in_world: 0.5 * (low + high), half_bounds_m: 0.5 * (high - low), triangles }
        });
        let clusters = clusters.collect();
        let exposure = real::powf(2.0, config.exposure_ev) as f32;
        Self { mesh, clusters, looks, exposure, known_share }
    }

    /// Share of its area that lies on boxes or ground of the town.
    pub fn known_share(&self) -> f64 {
        self.known_share
    }

    /// Smallest distance of a path to triangles that are not ground, metres; `within_m` where it is no smaller.
    pub fn clearance_m(&self, path_in_world: &[DVec3], within_m: f64) -> f64 {
        let mut best_m = within_m;
        for (from, to) in path_in_world.iter().zip(path_in_world.iter().skip(1)) {
            let (middle, half_m) = (0.5 * (*from + *to), 0.5 * from.distance(*to));
            for cluster in &self.clusters {
                let gap = (middle - cluster.center_in_world).abs() - cluster.half_bounds_m;
                if gap.max(DVec3::ZERO).length() - half_m >= best_m {
                    continue;
                }
                for number in cluster.triangles.clone().filter(|number| self.looks[*number].instance != 0) {
                    let triangle = Triangle { corners_in_world: self.mesh.triangles[number].corners() };
                    best_m = triangle.segment_distance(*from, *to, best_m).unwrap_or(best_m);
                }
            }
        }
        best_m
    }

    /// What is drawn otherwise than its file means it.
    pub fn remarks(&self) -> &[String] {
        &self.mesh.remarks
    }

    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.mesh.triangles.len()
    }
}

/// Cells along each axis of the order of triangles.
const CELLS: u32 = 1 << 21;

/// Interleaves the bits of a cell's three coordinates.
fn z_order(cell: [u32; 3]) -> u64 {
    let spread = |value: u32| {
        let mut v = u64::from(value.min(CELLS - 1));
        v = (v | (v << 32)) & 0x001f_0000_0000_ffff;
        v = (v | (v << 16)) & 0x001f_0000_ff00_00ff;
        v = (v | (v << 8)) & 0x100f_00f0_0f00_f00f;
        v = (v | (v << 4)) & 0x10c3_0c30_c30c_30c3;
        (v | (v << 2)) & 0x1249_2492_4924_9249
    };
    spread(cell[0]) | (spread(cell[1]) << 1) | (spread(cell[2]) << 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_of_three_coordinates_are_interleaved() {
        assert_eq!(z_order([1, 0, 0]), 1);
        assert_eq!(z_order([0, 1, 3]), 0b10_0110);
        assert_eq!(z_order([CELLS - 1; 3]), (1 << 63) - 1);
    }
}
