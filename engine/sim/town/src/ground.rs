//! [`GroundIndex`]: height of the ground under a point, from the town's surfaces.

use cosfly_domain::{SemanticLabel, SurfaceMesh, Town};
use cosfly_frames::{DVec2, DVec3};

/// Cells along one side of the index at most.
const MOST_CELLS: f64 = 1024.0;
/// Smallest side of a cell, metres.
const SMALLEST_CELL_M: f64 = 4.0;
/// Most entries in the lists of the cells; absurdly wide ground gets larger cells.
const MOST_ENTRIES: f64 = 1e8;
/// Steps of a side of a cell in which it is told what a triangle may reach.
const STEPS: f64 = 256.0;
/// A point this far outside a triangle still lies on it, so that seams have no gaps, metres.
const SEAM_M: f64 = 1e-6;

/// The ground at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundPoint {
    /// Height in the world, metres.
    pub height_m: f64,
    /// Label of the ground.
    pub label: SemanticLabel,
}

/// A grid over the triangles of all ground surfaces. Paint (road lines) and upright faces are left out.
#[derive(Clone, Debug)]
pub struct GroundIndex {
    triangles: Vec<GroundTriangle>,
    low: DVec2,
    cell_m: f64,
    columns: usize,
    rows: usize,
    /// Start of each cell's list in `members`; one more entry than cells.
    starts: Vec<u32>,
    members: Vec<u32>,
    /// The part of its cell that each member may reach, in steps of the cell: least and most across, least and most along.
    reaches: Vec<[u8; 4]>,
}

#[derive(Clone, Copy, Debug)]
struct GroundTriangle {
    corners: [DVec3; 3],
    label: SemanticLabel,
}

impl GroundTriangle {
    /// Corners of the rectangle outside of which [`height_on`] finds nothing: no weight of a corner is below its slack.
    fn reach(&self) -> (DVec2, DVec2) {
        let [a, b, c] = self.corners.map(DVec3::truncate);
        let extent_m = (b - a).length().max((c - a).length()).max((c - b).length());
        let beyond_m = 2.1 * SEAM_M * extent_m * extent_m / twice_area([a, b, c]).abs() + 1e-9;
        (a.min(b).min(c) - beyond_m, a.max(b).max(c) + beyond_m)
    }
}

impl GroundIndex {
    /// The ground of a town.
    pub fn new(town: &Town) -> Self {
        Self::of_surfaces(&town.surfaces, |_| true)
    }

    /// The ground of the meshes that `keep` accepts.
    pub fn of_surfaces(surfaces: &[SurfaceMesh], keep: impl Fn(&SurfaceMesh) -> bool) -> Self {
        let mut triangles = Vec::new();
        for mesh in surfaces.iter().filter(|mesh| mesh.label != SemanticLabel::RoadLine && keep(mesh)) {
            for triangle in &mesh.triangles {
                let corners = triangle.map(|corner| mesh.vertices_in_world[corner as usize]);
                if twice_area(corners.map(DVec3::truncate)).abs() > 1e-9 {
                    triangles.push(GroundTriangle { corners, label: mesh.label });
                }
            }
        }
        Self::build(triangles)
    }

    fn build(triangles: Vec<GroundTriangle>) -> Self {
        let corners = || triangles.iter().flat_map(|triangle| triangle.corners).map(DVec3::truncate);
        let low = corners().fold(DVec2::INFINITY, DVec2::min);
        let high = corners().fold(DVec2::NEG_INFINITY, DVec2::max);
        let size = if triangles.is_empty() { DVec2::ZERO } else { high - low };
        let mut cell_m = (size.max_element() / MOST_CELLS).max(SMALLEST_CELL_M);
        while entries(&triangles, cell_m) > MOST_ENTRIES && cell_m < size.max_element() {
            cell_m *= 2.0;
        }
        let [columns, rows] = size.to_array().map(|side| (side / cell_m) as usize + 1);
        let mut index =
            Self { triangles, low, cell_m, columns, rows, starts: vec![], members: vec![], reaches: vec![] };
        index.sort_into_cells();
        index
    }

    fn sort_into_cells(&mut self) {
        let mut counts = vec![0_u32; self.columns * self.rows + 1];
        for triangle in 0..self.triangles.len() {
            self.visit_cells(triangle, |cell| counts[cell + 1] += 1);
        }
        for cell in 1..counts.len() {
            counts[cell] += counts[cell - 1];
        }
        let mut next = counts.clone();
        let mut members = vec![0; counts[counts.len() - 1] as usize];
        let mut reaches = vec![[0; 4]; members.len()];
        for triangle in 0..self.triangles.len() {
            let (low, high) = self.triangles[triangle].reach();
            self.visit_cells(triangle, |cell| {
                members[next[cell] as usize] = triangle as u32;
                let ([left, top], [right, bottom]) = (self.steps_in(cell, low), self.steps_in(cell, high));
                reaches[next[cell] as usize] = [left, right, top, bottom];
                next[cell] += 1;
            });
        }
        (self.starts, self.members, self.reaches) = (counts, members, reaches);
    }

    /// Calls `visit` with every cell that the triangle's footprint touches (rows by the triangle's own extent).
    fn visit_cells(&self, triangle: usize, mut visit: impl FnMut(usize)) {
        let corners = self.triangles[triangle].corners.map(|corner| (corner.truncate() - self.low) / self.cell_m);
        let low_row = corners.iter().map(|corner| corner.y).fold(f64::INFINITY, f64::min);
        let high_row = corners.iter().map(|corner| corner.y).fold(f64::NEG_INFINITY, f64::max);
        for row in self.held(low_row - 1e-6, self.rows)..=self.held(high_row + 1e-6, self.rows) {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for i in 0..3 {
                if let Some((a, b)) =
                    clipped(corners[i], corners[(i + 1) % 3], row as f64 - 1e-6, row as f64 + 1.0 + 1e-6)
                {
                    low = low.min(a.min(b));
                    high = high.max(a.max(b));
                }
            }
            if low <= high {
                for column in self.held(low - 1e-6, self.columns)..=self.held(high + 1e-6, self.columns) {
                    visit(row * self.columns + column);
                }
            }
        }
    }

    /// Place of a point in a cell, in steps from its corner; at its edge where the point lies outside.
    fn steps_in(&self, cell: usize, point: DVec2) -> [u8; 2] {
        let corner = DVec2::new((cell % self.columns) as f64, (cell / self.columns) as f64);
        ((point - self.low) / self.cell_m * STEPS - corner * STEPS).to_array().map(|steps| steps as u8)
    }

    fn held(&self, cell: f64, count: usize) -> usize {
        (cell.max(0.0) as usize).min(count - 1)
    }

    /// Every ground surface over or under (x, y); `visit` gets height and label.
    pub fn visit_at(&self, x_m: f64, y_m: f64, mut visit: impl FnMut(GroundPoint)) {
        let at = (DVec2::new(x_m, y_m) - self.low) / self.cell_m;
        // Also false for NaN.
        if !(at.x >= -1e-6 && at.y >= -1e-6 && at.x <= self.columns as f64 && at.y <= self.rows as f64) {
            return;
        }
        let cell = self.held(at.y, self.rows) * self.columns + self.held(at.x, self.columns);
        let [x, y] = self.steps_in(cell, DVec2::new(x_m, y_m));
        let listed = self.starts[cell] as usize..self.starts[cell + 1] as usize;
        for (member, [left, right, top, bottom]) in self.members[listed.clone()].iter().zip(&self.reaches[listed]) {
            if x < *left || x > *right || y < *top || y > *bottom {
                continue;
            }
            let triangle = &self.triangles[*member as usize];
            if let Some(height_m) = height_on(triangle.corners, DVec2::new(x_m, y_m)) {
                visit(GroundPoint { height_m, label: triangle.label });
            }
        }
    }

    /// Height of the highest ground at (x, y): decks of bridges count. `None` outside the town.
    pub fn ground_height_m(&self, x_m: f64, y_m: f64) -> Option<f64> {
        let mut best: Option<f64> = None;
        self.visit_at(x_m, y_m, |ground| best = Some(best.map_or(ground.height_m, |best| best.max(ground.height_m))));
        best
    }

    /// The ground at the point's (x, y) that is closest to its z: tells a bridge from the road below it.
    pub fn ground_near(&self, point_in_world: DVec3) -> Option<GroundPoint> {
        let mut best: Option<GroundPoint> = None;
        let distance_m = |ground: &GroundPoint| (ground.height_m - point_in_world.z).abs();
        self.visit_at(point_in_world.x, point_in_world.y, |ground| {
            if best.as_ref().is_none_or(|best| distance_m(&ground) < distance_m(best)) {
                best = Some(ground);
            }
        });
        best
    }

    /// The highest ground at the point's (x, y) at most `level_m` above or below its z, as it is seen from above: of coplanar layers,
    /// grass lies below all others.
    pub fn ground_seen(&self, point_in_world: DVec3, level_m: f64) -> Option<GroundPoint> {
        const COPLANAR_M: f64 = 1e-3;
        let mut best: Option<GroundPoint> = None;
        self.visit_at(point_in_world.x, point_in_world.y, |ground| {
            let is_over = |best: &GroundPoint| match ground.height_m - best.height_m {
                above_m if above_m.abs() <= COPLANAR_M => best.label == SemanticLabel::Terrain,
                above_m => above_m > 0.0,
            };
            if (ground.height_m - point_in_world.z).abs() <= level_m && best.as_ref().is_none_or(is_over) {
                best = Some(ground);
            }
        });
        best
    }

    /// The highest ground at the point's (x, y) that is at most `reach_m` above its z.
    pub fn ground_below(&self, point_in_world: DVec3, reach_m: f64) -> Option<GroundPoint> {
        let mut best: Option<GroundPoint> = None;
        self.visit_at(point_in_world.x, point_in_world.y, |ground| {
            let reachable = ground.height_m <= point_in_world.z + reach_m;
            if reachable && best.as_ref().is_none_or(|best| ground.height_m > best.height_m) {
                best = Some(ground);
            }
        });
        best
    }
}

/// Height of the highest ground of a town at (x, y). Slow: builds an index; for many questions keep a [`GroundIndex`].
pub fn ground_height_m(town: &Town, x_m: f64, y_m: f64) -> Option<f64> {
    GroundIndex::new(town).ground_height_m(x_m, y_m)
}

/// About how many cells of a side the triangles touch, over all triangles.
fn entries(triangles: &[GroundTriangle], cell_m: f64) -> f64 {
    let touched = |triangle: &GroundTriangle| {
        let [a, b, c] = triangle.corners.map(|corner| corner.truncate() / cell_m);
        1.0 + 0.5 * twice_area([a, b, c]).abs() + a.distance(b) + b.distance(c) + c.distance(a)
    };
    triangles.iter().map(touched).sum()
}

fn twice_area([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

/// x at both ends of the part of a-b whose y lies within the band, if there is one.
fn clipped(a: DVec2, b: DVec2, low_y: f64, high_y: f64) -> Option<(f64, f64)> {
    let (a, b) = if a.y <= b.y { (a, b) } else { (b, a) };
    if b.y < low_y || a.y > high_y {
        return None;
    }
    let rise = b.y - a.y;
    let x_at = |y: f64| if rise > 0.0 { a.x + (b.x - a.x) * ((y - a.y) / rise).clamp(0.0, 1.0) } else { a.x };
    let end_x = if rise > 0.0 { x_at(high_y) } else { b.x };
    Some((x_at(low_y), end_x))
}

fn height_on(corners: [DVec3; 3], at: DVec2) -> Option<f64> {
    let [a, b, c] = corners.map(|corner| corner.truncate() - at);
    let whole = twice_area([a, b, c]);
    let weights = [b.perp_dot(c) / whole, c.perp_dot(a) / whole, a.perp_dot(b) / whole];
    // The seam in metres becomes a share by the triangle's extent.
    let extent_m = (b - a).length().max((c - a).length());
    let slack = SEAM_M * extent_m / whole.abs();
    if weights.iter().any(|weight| *weight < -slack) {
        return None;
    }
    Some(weights[0] * corners[0].z + weights[1] * corners[1].z + weights[2] * corners[2].z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::Seed;

    fn mesh(label: SemanticLabel, vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> SurfaceMesh {
        SurfaceMesh {
            label,
            vertices_in_world: vertices.iter().map(|v| DVec3::from_array(*v)).collect(),
            along_across_m: vec![DVec2::ZERO; vertices.len()],
            triangles: triangles.to_vec(),
            synthetic: false,
        }
    }

    #[test]
    fn heights_come_from_the_triangle_under_the_point() {
        let slope = mesh(
            SemanticLabel::Roads,
            &[[0.0, 0.0, 0.0], [100.0, 0.0, 10.0], [100.0, 60.0, 10.0], [0.0, 60.0, 0.0]],
            &[[0, 1, 2], [0, 2, 3]],
        );
        let deck = mesh(
            SemanticLabel::SideWalks,
            &[[40.0, -5.0, 20.0], [50.0, -5.0, 20.0], [50.0, 80.0, 20.0], [40.0, 80.0, 20.0]],
            &[[0, 1, 2], [0, 2, 3]],
        );
        let index = GroundIndex::of_surfaces(&[slope, deck], |_| true);
        for (x, y, expected) in [
            (10.0, 5.0, Some(1.0)),
            (100.0, 60.0, Some(10.0)),
            (45.0, 30.0, Some(20.0)),
            (45.0, 75.0, Some(20.0)),
            (-1.0, 5.0, None),
            (10.0, 70.0, None),
            (f64::NAN, 0.0, None),
        ] {
            let height = index.ground_height_m(x, y);
            assert_eq!(height.is_some(), expected.is_some(), "({x}, {y})");
            assert!(height.zip(expected).is_none_or(|(a, b)| (a - b).abs() < 1e-9), "({x}, {y}): {height:?}");
        }
        let under = index.ground_near(DVec3::new(45.0, 30.0, 5.0)).unwrap();
        assert_eq!((under.label, (under.height_m * 10.0).round()), (SemanticLabel::Roads, 45.0));
        assert_eq!(index.ground_below(DVec3::new(45.0, 30.0, 19.0), 0.5).unwrap().label, SemanticLabel::Roads);
    }

    #[test]
    fn a_road_is_seen_over_coplanar_grass() {
        let square = |label, height_m: f64| {
            let corners = [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]];
            mesh(label, &corners.map(|[x, y]| [x, y, height_m]), &[[0, 1, 2], [0, 2, 3]])
        };
        for order in [[1.0, 1.0 + 1e-9], [1.0 + 1e-9, 1.0]] {
            let layers = [square(SemanticLabel::Terrain, order[0]), square(SemanticLabel::Roads, order[1])];
            let index = GroundIndex::of_surfaces(&layers, |_| true);
            let label = |z: f64| index.ground_seen(DVec3::new(3.0, 4.0, z), 0.5).map(|seen| seen.label);
            assert_eq!((label(1.2), label(2.0)), (Some(SemanticLabel::Roads), None));
        }
    }

    #[test]
    fn no_triangle_under_a_point_is_passed_over() {
        let mut random = Seed([3; 32]).stream("ground");
        let mut corner = |reach_m: f64| [random.uniform(-reach_m, reach_m), random.uniform(-reach_m, reach_m), 0.0];
        let vertices: Vec<[f64; 3]> = (0..900).map(|at| corner(if at % 3 == 0 { 60.0 } else { 50.0 })).collect();
        let triangles: Vec<[u32; 3]> = (0..300).map(|at| [3 * at, 3 * at + 1, 3 * at + 2]).collect();
        let town = Town { surfaces: vec![mesh(SemanticLabel::Terrain, &vertices, &triangles)], ..Town::default() };
        let index = GroundIndex::new(&town);
        for _ in 0..2000 {
            let [x, y, _] = corner(65.0);
            let mut found = 0;
            index.visit_at(x, y, |_| found += 1);
            let by_hand = index.triangles.iter().filter(|it| height_on(it.corners, DVec2::new(x, y)).is_some()).count();
            assert_eq!(found, by_hand, "{x} {y}");
        }
    }

    #[test]
    fn an_empty_town_has_no_ground() {
        assert_eq!(GroundIndex::of_surfaces(&[], |_| true).ground_height_m(0.0, 0.0), None);
    }

    #[test]
    fn every_cell_that_a_triangle_touches_knows_it() {
        let thin =
            mesh(SemanticLabel::Roads, &[[0.0, 0.0, 1.0], [301.0, 177.0, 1.0], [300.0, 178.5, 1.0]], &[[0, 1, 2]]);
        let index = GroundIndex::of_surfaces(core::slice::from_ref(&thin), |_| true);
        for i in 0..2000 {
            let (a, b) = (f64::from(i % 50) / 50.0, f64::from(i / 50) / 40.0);
            let [p, q, r] = [0, 1, 2].map(|k| thin.vertices_in_world[k]);
            let point = p.lerp(q.lerp(r, b), a);
            assert_eq!(index.ground_height_m(point.x, point.y).map(f64::round), Some(1.0), "{point}");
        }
    }
}
