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
    /// Whether a frame's weather lights the mesh, in the place of the light in its colours.
    pub(crate) is_lit: bool,
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
        mesh.sort_by_place();
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
        let is_lit = !config.light.is_of_scan();
        Self { mesh, clusters, looks, exposure, is_lit, known_share }
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
