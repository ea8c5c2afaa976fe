//! [`pave_quarters`]: open ground of dense quarters is bare, not lawn.
//!
//! Files tell which ground is street or park and leave courts, yards and the slits between them open; the terrain
//! below shows there. Between close houses that ground is stone, gravel or earth far more often than grass; a large piece
//! without a house beside it is taken for a green square.

use crate::fill::land::{Plot, visit_rows};
use cosfly_domain::{ObstacleKind, SemanticLabel, SurfaceMesh, Town};
use cosfly_frames::DVec2;
use cosfly_town::terrain::beside;
use std::collections::VecDeque;

/// Wanted side of a cell, metres.
const CELL_M: f64 = 0.75;
/// Most cells; larger towns get larger cells.
const MOST_CELLS: f64 = 16e6;
/// Half the side of the square in which houses are counted, metres.
const QUARTER_M: f64 = 50.0;
/// Least share of a dense quarter that houses cover: old towns and city blocks have 0.25 to 0.6, rows of villas 0.1 to 0.18.
const DENSE_SHARE: f64 = 0.2;
/// In towns of invented streets, ground so near to houses and streets is bare in any piece, metres.
const BESIDE_M: f64 = 7.0;
/// Largest piece of open ground that is bare; larger ones are taken for parks, square metres.
const LARGEST_M2: f64 = 6000.0;
/// Least share of houses in the border of a piece; pieces with fewer are taken for green squares, unless they are small.
const HOUSES_AROUND: f64 = 0.1;
const SMALL_M2: f64 = 400.0;

/// Triangles at the edge of bare ground are split until the side from their first to their last corner is shorter than this, metres.
const SPLIT_M: f64 = 1.2;

/// How a cell is used, as bits.
const HOUSE: u8 = 1;
const COVERED: u8 = 2;
const BARE: u8 = 4;
const SEEN: u8 = 8;

/// Gives the terrain of courts, yards and slits in dense quarters the label of bare ground. Lawns and parks that the file
/// states are left alone, as is ground that the file itself has. In a town of `invented_streets`, so has all terrain beside
/// the houses and streets of dense quarters.
pub(crate) fn pave_quarters(town: &mut Town, invented_streets: bool) {
    let is_terrain = |mesh: &SurfaceMesh| mesh.synthetic && mesh.label == SemanticLabel::Terrain;
    if !town.surfaces.iter().any(is_terrain) {
        return;
    }
    let Some(mut cells) = Cells::of_houses(town) else { return };
    for mesh in town.surfaces.iter().filter(|mesh| !is_terrain(mesh)) {
        for triangle in &mesh.triangles {
            cells.mark(&triangle.map(|corner| mesh.vertices_in_world[corner as usize].truncate()), COVERED);
        }
    }
    let houses = Sums::of(&cells, HOUSE, QUARTER_M);
    cells.find_bare(&houses, invented_streets);
    let mut bare_meshes = Vec::new();
    for mesh in town.surfaces.iter_mut().filter(|mesh| is_terrain(mesh)) {
        if invented_streets {
            cells.split_mixed(mesh);
        }
        let (bare, open): (Vec<_>, Vec<_>) = mesh.triangles.iter().partition(|triangle| {
            cells.is_bare(&triangle.map(|corner| mesh.vertices_in_world[corner as usize].truncate()), &houses)
        });
        if !bare.is_empty() {
            bare_meshes.push(part(mesh, &bare, SemanticLabel::Ground));
            *mesh = part(mesh, &open, SemanticLabel::Terrain);
        }
    }
    town.surfaces.append(&mut bare_meshes);
    if cells.bare_cells > 0 {
        let bare_m2 = cells.bare_cells as f64 * cells.cell_m * cells.cell_m;
        let is_coarse = cells.cell_m > CELL_M;
        let cells = if is_coarse {
            format!(" (seen in cells of {:.2} m: the town is wide)", cells.cell_m)
        } else {
            String::new()
        };
        let places = if invented_streets { "land" } else { "courts, yards and slits" };
        town.synthetic.notes.push(format!(
            "{bare_m2:.0} m2 of {places} between close houses are taken for bare ground, not lawn{cells}"
        ));
    }
}

/// The mesh of some of a mesh's triangles.
fn part(mesh: &SurfaceMesh, triangles: &[[u32; 3]], label: SemanticLabel) -> SurfaceMesh {
    let mut numbers = vec![u32::MAX; mesh.vertices_in_world.len()];
    let mut made = SurfaceMesh { label, vertices_in_world: vec![], along_across_m: vec![], triangles: vec![], ..*mesh };
    for triangle in triangles {
        let corners = triangle.map(|corner| {
            let number = &mut numbers[corner as usize];
            if *number == u32::MAX {
                *number = made.vertices_in_world.len() as u32;
                made.vertices_in_world.push(mesh.vertices_in_world[corner as usize]);
                made.along_across_m.push(mesh.along_across_m[corner as usize]);
            }
            *number
        });
        made.triangles.push(corners);
    }
    made
}

/// The ground around all houses, in square cells by rows.
struct Cells {
    low: DVec2,
    cell_m: f64,
    columns: usize,
    rows: usize,
    uses: Vec<u8>,
    /// Number of cells that are [`BARE`].
    bare_cells: usize,
}

impl Cells {
    /// Houses marked, and room for a quarter around them; `None` without houses.
    fn of_houses(town: &Town) -> Option<Self> {
        let houses = || town.obstacles.iter().filter(|one| one.kind == ObstacleKind::Building);
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for house in houses() {
            let (from, to) = house.shape.bounds_in_world();
            (low, high) = (low.min(from.truncate()), high.max(to.truncate()));
        }
        if !(low.is_finite() && high.is_finite()) {
            return None;
        }
        let (low, high) = (low - QUARTER_M, high + QUARTER_M);
        let cell_m = ((high - low).element_product() / MOST_CELLS).sqrt().max(CELL_M);
        let [columns, rows] = ((high - low) / cell_m).ceil().max(DVec2::ONE).to_array().map(|side| side as usize);
        let mut cells = Self { low, cell_m, columns, rows, uses: vec![0; columns * rows], bare_cells: 0 };
        for house in houses() {
            let (shape, half_m) = (&house.shape, house.shape.half_extents_m.truncate());
            let plot = Plot { center: shape.center_in_world.truncate(), half_m, yaw_rad: shape.yaw_rad };
            cells.mark(&plot.corners(0.0), HOUSE | COVERED);
        }
        Some(cells)
    }

    /// Marks the cells that a convex polygon touches.
    fn mark(&mut self, outline: &[DVec2], bits: u8) {
        let (columns, uses) = (self.columns, &mut self.uses);
        visit_rows(self.low, self.cell_m, columns, self.rows, outline, &mut |row, from, to| {
            uses[row * columns + from..=row * columns + to].iter_mut().for_each(|cell| *cell |= bits);
            true
        });
    }

    /// Marks the pieces of open ground that are small, enclosed and in dense quarters; `everywhere` also the land beside things there.
    fn find_bare(&mut self, houses: &Sums, everywhere: bool) {
        let [largest, small] = [LARGEST_M2, SMALL_M2].map(|area_m2| (area_m2 / (self.cell_m * self.cell_m)) as usize);
        let beside_things = everywhere.then(|| Sums::of(self, COVERED, BESIDE_M));
        let mut queue = VecDeque::new();
        let mut piece = Vec::new();
        for first in 0..self.uses.len() {
            if self.uses[first] & (COVERED | SEEN) != 0 {
                continue;
            }
            piece.clear();
            queue.push_back(first);
            self.uses[first] |= SEEN;
            let (mut is_enclosed, mut share, mut border, mut walls) = (true, 0.0, 0, 0);
            while let Some(cell) = queue.pop_front() {
                let (column, row) = (cell % self.columns, cell / self.columns);
                share += houses.share_around(column, row);
                piece.push(cell);
                is_enclosed &= column > 0 && row > 0 && column + 1 < self.columns && row + 1 < self.rows;
                for next in beside(cell, self.columns, self.rows) {
                    border += usize::from(self.uses[next] & COVERED != 0);
                    walls += usize::from(self.uses[next] & HOUSE != 0);
                    if self.uses[next] & (COVERED | SEEN) == 0 {
                        self.uses[next] |= SEEN;
                        queue.push_back(next);
                    }
                }
            }
            let is_yard = piece.len() <= small || walls as f64 >= HOUSES_AROUND * border as f64;
            let is_dense = share >= DENSE_SHARE * piece.len() as f64;
            let is_bare = is_enclosed && is_yard && is_dense && piece.len() <= largest;
            for cell in &piece {
                let share = |of: &Sums| of.share_around(cell % self.columns, cell / self.columns);
                let is_beside =
                    || beside_things.as_ref().is_some_and(|it| share(it) > 0.0) && share(houses) >= DENSE_SHARE;
                if is_bare || is_beside() {
                    self.uses[*cell] |= BARE;
                    self.bare_cells += 1;
                }
            }
        }
    }

    /// Splits the triangles that hold both bare and open cells into four, again and again, so that land is bare along a fine line.
    fn split_mixed(&self, mesh: &mut SurfaceMesh) {
        let mut waiting = std::mem::take(&mut mesh.triangles);
        while let Some(triangle) = waiting.pop() {
            let corners = triangle.map(|corner| mesh.vertices_in_world[corner as usize].truncate());
            let [a, b, c] = triangle;
            let (bare, open) = self.bare_and_open(&corners);
            if bare.min(open) == 0 || corners[0].distance(corners[2]) < SPLIT_M {
                mesh.triangles.push(triangle);
                continue;
            }
            let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[from, to]| {
                let [from, to] = [from as usize, to as usize];
                mesh.vertices_in_world.push(0.5 * (mesh.vertices_in_world[from] + mesh.vertices_in_world[to]));
                mesh.along_across_m.push(0.5 * (mesh.along_across_m[from] + mesh.along_across_m[to]));
                (mesh.vertices_in_world.len() - 1) as u32
            });
            waiting.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
    }

    /// Numbers of bare and of open cells that a triangle touches.
    fn bare_and_open(&self, triangle: &[DVec2; 3]) -> (usize, usize) {
        let (mut bare, mut open) = (0, 0);
        visit_rows(self.low, self.cell_m, self.columns, self.rows, triangle, &mut |row, from, to| {
            for cell in &self.uses[row * self.columns + from..=row * self.columns + to] {
                bare += usize::from(cell & BARE != 0);
                open += usize::from(cell & (BARE | COVERED) == 0);
            }
            true
        });
        (bare, open)
    }

    /// Whether more of a triangle's open cells are bare than not; without open cells, whether the quarter is dense.
    fn is_bare(&self, triangle: &[DVec2; 3], houses: &Sums) -> bool {
        let (bare, open) = self.bare_and_open(triangle);
        let middle = ((triangle.iter().sum::<DVec2>() / 3.0 - self.low) / self.cell_m).floor();
        let is_within =
            middle.cmpge(DVec2::ZERO).all() && middle.cmplt(DVec2::new(self.columns as f64, self.rows as f64)).all();
        bare > open
            || is_within && open == 0 && houses.share_around(middle.x as usize, middle.y as usize) >= DENSE_SHARE
    }
}

/// Cells of one use left of and below each corner of the cells.
struct Sums {
    columns: usize,
    rows: usize,
    reach: usize,
    sums: Vec<u32>,
}

impl Sums {
    fn of(cells: &Cells, bit: u8, reach_m: f64) -> Self {
        let (columns, rows) = (cells.columns + 1, cells.rows + 1);
        let mut sums = vec![0_u32; columns * rows];
        for row in 1..rows {
            let mut line = 0;
            for column in 1..columns {
                line += u32::from(cells.uses[(row - 1) * cells.columns + column - 1] & bit != 0);
                sums[row * columns + column] = sums[(row - 1) * columns + column] + line;
            }
        }
        Self { columns, rows, reach: (reach_m / cells.cell_m).ceil() as usize, sums }
    }

    /// Share of the use in the square around a cell; ground beyond the cells has none.
    fn share_around(&self, column: usize, row: usize) -> f64 {
        let (left, right) = (column.saturating_sub(self.reach), (column + self.reach + 1).min(self.columns - 1));
        let (low, high) = (row.saturating_sub(self.reach), (row + self.reach + 1).min(self.rows - 1));
        let at = |column: usize, row: usize| self.sums[row * self.columns + column];
        let count = at(right, high) + at(left, low) - at(left, high) - at(right, low);
        let side = (2 * self.reach + 1) as f64;
        f64::from(count) / (side * side)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::{Obstacle, OrientedBox};
    use cosfly_frames::DVec3;
    use cosfly_town::GroundIndex;
    use cosfly_town::mesh::MeshBuilder;

    /// Twenty-five blocks of 40 m: four wings of a depth around a court, streets 8 m wide between them.
    fn blocks(wing_m: f64) -> Town {
        let (mut obstacles, mut builder) = (vec![], MeshBuilder::default());
        let mut quad = |low: DVec2, high: DVec2| {
            let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
            builder.quad(SemanticLabel::Roads, false, corners.map(|corner| (corner.extend(0.0), corner)));
        };
        for line in 0..6 {
            let at = 48.0 * f64::from(line) - 8.0;
            quad(DVec2::new(-8.0, at), DVec2::new(240.0, at + 8.0));
            quad(DVec2::new(at, -8.0), DVec2::new(at + 8.0, 240.0));
        }
        for block in 0..25 {
            let low = 48.0 * DVec2::new(f64::from(block % 5), f64::from(block / 5));
            let far = 40.0 - wing_m;
            for (from, to) in [
                ([0.0, 0.0], [40.0, wing_m]),
                ([0.0, far], [40.0, 40.0]),
                ([0.0, 0.0], [wing_m, 40.0]),
                ([far, 0.0], [40.0, 40.0]),
            ] {
                let (from, to) = (low + DVec2::from(from), low + DVec2::from(to));
                let shape = OrientedBox::from_corners(from.extend(0.0), to.extend(15.0));
                obstacles.push(Obstacle {
                    shape,
                    kind: ObstacleKind::Building,
                    object_id: block as u32,
                    synthetic: false,
                });
            }
        }
        cosfly_town::terrain::add_terrain(&mut builder, &obstacles, 60.0).unwrap();
        Town { obstacles, surfaces: builder.finish(), ..Town::default() }
    }

    fn label_at(town: &Town, x: f64, y: f64) -> SemanticLabel {
        GroundIndex::new(town).ground_below(DVec3::new(x, y, 20.0), 0.5).unwrap().label
    }

    #[test]
    fn courts_of_close_houses_are_bare_and_those_of_thin_ones_and_land_outside_are_lawn() {
        let mut town = blocks(8.0);
        let triangles = |town: &Town| town.surfaces.iter().map(|mesh| mesh.triangles.len()).sum::<usize>();
        let before = triangles(&town);
        pave_quarters(&mut town, false);
        assert_eq!(label_at(&town, 116.0, 116.0), SemanticLabel::Ground, "a court");
        assert_eq!(label_at(&town, 116.0, 92.0), SemanticLabel::Roads, "a street");
        assert_eq!(label_at(&town, -40.0, 116.0), SemanticLabel::Terrain, "outside");
        assert_eq!(triangles(&town), before, "no triangle is lost");
        assert!(
            cosfly_town::assert_well_formed(&town).is_ok() && town.synthetic.notes.len() == 1,
            "{:?}",
            town.synthetic.notes
        );
        let mut thin = blocks(1.0);
        pave_quarters(&mut thin, false);
        assert_eq!(label_at(&thin, 116.0, 116.0), SemanticLabel::Terrain);
        assert!(thin.synthetic.notes.is_empty());
        let mut invented = blocks(8.0);
        pave_quarters(&mut invented, true);
        assert_eq!(label_at(&invented, -9.5, 116.0), SemanticLabel::Ground, "beside the outermost street");
        assert_eq!(label_at(&invented, -55.0, 116.0), SemanticLabel::Terrain, "outside the town");
    }

    #[test]
    fn ground_of_the_file_keeps_its_label() {
        let mut town = blocks(8.0);
        town.surfaces.iter_mut().for_each(|mesh| mesh.synthetic = false);
        let before = town.clone();
        pave_quarters(&mut town, true);
        assert_eq!(town, before);
    }
}
