//! [`GroundKinds`]: where a town has paved ground and water, in square cells.

use cosfly_domain::{SemanticLabel, SurfaceMesh, Town};
use cosfly_frames::DVec2;

/// Wanted side of a cell, metres, and most cells along a side of a town.
const CELL_M: f64 = 0.5;
const MOST_CELLS: f64 = 2048.0;
/// What a cell has, as bits.
const PAVED: u8 = 1;
const WATER: u8 = 2;
const ROAD: u8 = 4;

/// Paved ground and water of a town.
#[derive(Clone, Debug, Default)]
pub struct GroundKinds {
    low: DVec2,
    cell_m: f64,
    columns: usize,
    cells: Vec<u8>,
}

fn bit(label: SemanticLabel) -> Option<u8> {
    match label {
        SemanticLabel::SideWalks | SemanticLabel::Ground => Some(PAVED),
        SemanticLabel::Roads => Some(PAVED | ROAD),
        SemanticLabel::Water => Some(WATER),
        _ => None,
    }
}

impl GroundKinds {
    /// Reads a town's surfaces: pavements, carriageways and bare or paved ground, and water.
    pub fn of(town: &Town) -> Self {
        let meshes = || town.surfaces.iter().filter_map(|mesh| Some((mesh, bit(mesh.label)?)));
        let points = meshes().flat_map(|(mesh, _)| &mesh.vertices_in_world).filter(|point| point.is_finite());
        let (low, high) = points
            .map(|point| point.truncate())
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), point| (low.min(point), high.max(point)));
        let size_m = high - low;
        if !size_m.is_finite() {
            return Self::default();
        }
        let cell_m = (size_m.max_element() / MOST_CELLS).max(CELL_M);
        let [columns, rows] = [size_m.x, size_m.y].map(|side_m| (side_m / cell_m) as usize + 1);
        let mut kinds = Self { low, cell_m, columns, cells: vec![0; columns * rows] };
        meshes().for_each(|(mesh, bit)| kinds.add(mesh, bit));
        kinds
    }

    /// Marks the cells whose middles lie in triangles.
    fn add(&mut self, mesh: &SurfaceMesh, bit: u8) {
        for triangle in &mesh.triangles {
            let corners = triangle.map(|corner| mesh.vertices_in_world.get(corner as usize).copied());
            let [Some(a), Some(b), Some(c)] = corners else { continue };
            let own = [a, b, c].map(|corner| (corner.truncate() - self.low) / self.cell_m);
            if own.iter().all(|corner| corner.is_finite()) {
                self.add_triangle(own, bit);
            }
        }
    }

    /// Marks the cells whose middles lie in a triangle, whose corners are in cells.
    fn add_triangle(&mut self, corners: [DVec2; 3], bit: u8) {
        let rows = self.cells.len() / self.columns.max(1);
        let ys = corners.map(|corner| corner.y);
        let from = (ys.into_iter().fold(f64::INFINITY, f64::min) - 0.5).ceil().max(0.0) as usize;
        let to = ((ys.into_iter().fold(f64::NEG_INFINITY, f64::max) - 0.5).floor() + 1.0).max(0.0) as usize;
        for row in from..to.min(rows) {
            let y = row as f64 + 0.5;
            let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                let (a, b): (DVec2, DVec2) = (corners[a], corners[b]);
                if (a.y <= y) != (b.y <= y) {
                    let x = a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y);
                    (left, right) = (left.min(x), right.max(x));
                }
            }
            let first = (left - 0.5).ceil().max(0.0) as usize;
            let end = ((right - 0.5).floor() + 1.0).max(0.0) as usize;
            for cell in self.cells[row * self.columns..][..self.columns].iter_mut().take(end).skip(first) {
                *cell |= bit;
            }
        }
    }

    fn at(&self, place: DVec2) -> u8 {
        let own = (place - self.low) / self.cell_m;
        if !(own.x >= 0.0 && own.y >= 0.0 && own.x < self.columns as f64) {
            return 0;
        }
        self.cells.get(own.y as usize * self.columns + own.x as usize).copied().unwrap_or(0)
    }

    /// Whether a place is pavement, carriageway, or paved or bare ground.
    pub fn is_paved(&self, place: DVec2) -> bool {
        self.at(place) & PAVED != 0
    }

    /// Whether a place is carriageway.
    pub fn is_road(&self, place: DVec2) -> bool {
        self.at(place) & ROAD != 0
    }

    /// Whether a place is water.
    pub fn is_water(&self, place: DVec2) -> bool {
        self.at(place) & WATER != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::DVec3;

    #[test]
    fn cells_have_what_lies_at_their_middles() {
        let mesh = |label, [x, y]: [f64; 2], size_m: f64| SurfaceMesh {
            label,
            vertices_in_world: [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
                .map(|[u, v]| DVec3::new(x + size_m * u, y + size_m * v, 0.0))
                .to_vec(),
            along_across_m: vec![DVec2::ZERO; 4],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            synthetic: false,
        };
        let surfaces = vec![
            mesh(SemanticLabel::SideWalks, [-10.0, 0.0], 4.0),
            mesh(SemanticLabel::Terrain, [-90.0, -90.0], 200.0),
            mesh(SemanticLabel::Water, [20.0, 5.0], 8.0),
        ];
        let ground = GroundKinds::of(&Town { surfaces, ..Town::default() });
        assert!(ground.is_paved(DVec2::new(-8.0, 2.0)) && ground.is_paved(DVec2::new(-6.3, 3.7)));
        assert!(!ground.is_paved(DVec2::new(-5.3, 2.0)) && !ground.is_water(DVec2::new(-8.0, 2.0)));
        assert!(ground.is_water(DVec2::new(24.0, 9.0)) && !ground.is_paved(DVec2::new(24.0, 9.0)));
        for beyond in [DVec2::splat(-50.0), DVec2::splat(500.0), DVec2::NAN, DVec2::new(0.0, 8.0)] {
            assert!(!ground.is_paved(beyond) && !ground.is_water(beyond), "{beyond}");
        }
        assert!(!GroundKinds::default().is_paved(DVec2::ZERO));
    }
}
