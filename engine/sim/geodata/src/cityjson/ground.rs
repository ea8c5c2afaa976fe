//! Roads, footpaths, land and water: faces as surfaces, and as walkable polygons.

use super::faces::Face;
use cosfly_domain::{SemanticLabel, WalkableKind, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::MapError;
use cosfly_town::cover::CoverPlan;
use cosfly_town::mesh::MeshBuilder;
use cosfly_town::polygons::{triangulated, twice_area_m2};

/// Ground is at most this steep, vertical part of the unit normal.
const STEEPEST_NORMAL: f64 = 0.3;
/// Roads, paths and what is below plants are at most this steep: what rises more steeply by more than a kerb is a spike of
/// triangulated heights.
const STEEPEST_EVEN_NORMAL: f64 = 0.7;
/// Highest kerb, metres.
const KERB_M: f64 = 0.3;
/// Steepest ground to walk on.
const STEEPEST_WALK_NORMAL: f64 = 0.8;
/// Smallest walkable piece, square metres.
const SMALLEST_M2: f64 = 0.01;
/// Outlines of more corners are cut into pieces.
const MOST_CORNERS: usize = 24;
/// Most triangles of one file.
const MOST_TRIANGLES: usize = 8_000_000;

/// The ground of a town while it grows.
#[derive(Default)]
pub(super) struct Ground {
    pub(super) meshes: MeshBuilder,
    pub(super) walkable: Vec<WalkablePolygon>,
    triangle_count: usize,
}

impl Ground {
    /// Adds a face unless it is a wall. Gives whether it was ground.
    pub(super) fn add(
        &mut self,
        face: &Face,
        label: SemanticLabel,
        kind: Option<WalkableKind>,
    ) -> Result<bool, MapError> {
        let level_share = face.level_share();
        if level_share < STEEPEST_NORMAL {
            return Ok(false);
        }
        let kind = kind.filter(|_| level_share >= STEEPEST_WALK_NORMAL);
        let is_way = matches!(label, SemanticLabel::Roads | SemanticLabel::SideWalks);
        let face = if is_way { &without_spike(face) } else { face };
        for (outline, triangles) in pieces(face) {
            self.triangle_count += triangles.len();
            if self.triangle_count > MOST_TRIANGLES {
                let error = MapError::new(format!("the ground has more than {MOST_TRIANGLES} triangles"));
                return Err(error.hint("cut the map into smaller pieces"));
            }
            let vertices: Vec<(DVec3, DVec2)> = outline.iter().map(|corner| (*corner, corner.truncate())).collect();
            self.meshes.polygon(label, false, &vertices, &triangles);
            let plan: Vec<DVec2> = outline.iter().map(|corner| corner.truncate()).collect();
            if let Some(kind) = kind.filter(|_| twice_area_m2(&plan).abs() > 2.0 * SMALLEST_M2) {
                self.walkable.push(WalkablePolygon { kind, outline_in_world: outline, synthetic: false });
            }
        }
        Ok(true)
    }
}

/// The face, laid flat where it is a spike; walls, which are no ground, as they are.
pub(super) fn without_spike(face: &Face) -> Face {
    let low_m = face.lowest_m();
    let is_steep = (STEEPEST_NORMAL..STEEPEST_EVEN_NORMAL).contains(&face.level_share());
    if is_steep && face.highest_m() - low_m > KERB_M { face.levelled(low_m) } else { face.clone() }
}

/// The face as simple polygons with their triangles: itself where it is one, else quads that tile it.
fn pieces(face: &Face) -> Vec<(Vec<DVec3>, Vec<[u32; 3]>)> {
    if face.rings.len() == 1 && face.rings[0].len() <= MOST_CORNERS {
        let outline = face.rings[0].clone();
        let plan: Vec<DVec2> = outline.iter().map(|corner| corner.truncate()).collect();
        let triangles = triangulated(&plan);
        if !triangles.is_empty() {
            return vec![(outline, triangles)];
        }
    }
    let rings: Vec<Vec<DVec2>> =
        face.rings.iter().map(|ring| ring.iter().map(|corner| corner.truncate()).collect()).collect();
    let (outer, holes) = rings.split_at(1);
    let holes: Vec<&[DVec2]> = holes.iter().map(Vec::as_slice).collect();
    let Some(plan) = CoverPlan::of(&[&outer[0]], &holes) else { return Vec::new() };
    let on_face = |corner: DVec2| corner.extend(face.height_m(corner));
    let quads = plan.trapezoids().into_iter().filter(|quad| twice_area_m2(quad).abs() > 1e-6);
    quads.map(|quad| (quad.map(on_face).to_vec(), vec![[0, 1, 2], [0, 2, 3]])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spikes_of_ways_lie_flat_and_banks_and_kerbs_stay() {
        let heights_m = |label, high_m: f64| {
            let corners = [[0.0, 0.0, 0.1], [1.0, 0.0, 0.1], [0.5, 0.4 * high_m, high_m + 0.1]];
            let mut ground = Ground::default();
            let face = Face { rings: vec![corners.map(DVec3::from_array).to_vec()] };
            assert!(ground.add(&face, label, None).expect("ground"));
            let meshes = ground.meshes.finish();
            meshes.iter().flat_map(|mesh| &mesh.vertices_in_world).map(|corner| corner.z).fold(0.0, f64::max)
        };
        assert_eq!(heights_m(SemanticLabel::SideWalks, 0.8), 0.1);
        assert_eq!(heights_m(SemanticLabel::SideWalks, 0.25), 0.35);
        assert_eq!(heights_m(SemanticLabel::Terrain, 0.8), 0.9);
    }
}
