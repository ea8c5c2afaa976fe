//! [`Clearance`]: distance of open ground from what stands on it, in square cells by rows.

use crate::fill::land::{Plot, visit_rows};
use cosfly_domain::{Obstacle, ObstacleKind, SemanticLabel, SurfaceMesh, Town};
use cosfly_frames::DVec2;
use cosfly_town::terrain::stands_on_ground;

/// Ground farther from all houses is open, metres: streets end there.
pub(super) const OPEN_M: f64 = 24.0;
/// Distances count up to so many cells.
const FARTHEST: usize = 30;

/// The ground around all houses.
pub(super) struct Clearance {
    low: DVec2,
    /// Side of a cell, metres.
    pub cell_m: f64,
    /// Cells along x.
    pub columns: usize,
    /// Cells along y.
    pub rows: usize,
    /// Squared distance of each cell from the nearest taken one, cells.
    pub squared: Vec<u32>,
    /// The same from the nearest house.
    from_houses: Vec<u32>,
}

impl Clearance {
    /// The ground between two corners, taken where things stand and where the file has ground of its own, such as water.
    pub fn of(town: &Town, low: DVec2, high: DVec2, cell_m: f64) -> Self {
        let [columns, rows] = ((high - low) / cell_m).ceil().max(DVec2::ONE).to_array().map(|side| side as usize);
        let mut is_house = vec![false; columns * rows];
        let take = |is_taken: &mut [bool], outline: &[DVec2]| {
            visit_rows(low, cell_m, columns, rows, outline, &mut |row, from, to| {
                is_taken[row * columns + from..=row * columns + to].fill(true);
                true
            });
        };
        let mut is_taken = is_house.clone();
        for Obstacle { shape, kind, .. } in town.obstacles.iter().filter(|one| stands_on_ground(one.kind)) {
            let half_m = shape.half_extents_m.truncate();
            let plot = Plot { center: shape.center_in_world.truncate(), half_m, yaw_rad: shape.yaw_rad };
            take(&mut is_taken, &plot.corners(0.0));
            if *kind == ObstacleKind::Building {
                take(&mut is_house, &plot.corners(0.0));
            }
        }
        let is_open = |mesh: &SurfaceMesh| matches!(mesh.label, SemanticLabel::Terrain | SemanticLabel::Ground);
        for mesh in town.surfaces.iter().filter(|mesh| !is_open(mesh)) {
            for triangle in &mesh.triangles {
                take(&mut is_taken, &triangle.map(|corner| mesh.vertices_in_world[corner as usize].truncate()));
            }
        }
        let [squared, from_houses] = [is_taken, is_house].map(|taken| squared_distances(&taken, columns, rows));
        Self { low, cell_m, columns, rows, squared, from_houses }
    }

    /// The ground between two corners, taken by some meshes.
    pub fn of_meshes(meshes: &[SurfaceMesh], low: DVec2, high: DVec2, cell_m: f64) -> Self {
        let town = Town { surfaces: meshes.to_vec(), ..Town::default() };
        Self::of(&town, low, high, cell_m)
    }

    /// Distance from the middle of a cell to the nearest taken one, metres.
    pub fn of_cell_m(&self, cell: usize) -> f64 {
        self.metres(self.squared[cell])
    }

    /// Distance at a place; 0 outside the cells.
    pub fn at_m(&self, at: DVec2) -> f64 {
        self.cell_at(at).map_or(0.0, |cell| self.of_cell_m(cell))
    }

    /// Distance at a place from the nearest house; 0 outside the cells.
    pub fn house_distance_m(&self, at: DVec2) -> f64 {
        self.cell_at(at).map_or(0.0, |cell| self.metres(self.from_houses[cell]))
    }

    fn metres(&self, squared: u32) -> f64 {
        (f64::from(squared).sqrt() - 0.5).max(0.0) * self.cell_m
    }

    fn cell_at(&self, at: DVec2) -> Option<usize> {
        let [x, y] = ((at - self.low) / self.cell_m).floor().to_array();
        let is_inside = x >= 0.0 && y >= 0.0 && x < self.columns as f64 && y < self.rows as f64;
        is_inside.then(|| y as usize * self.columns + x as usize)
    }

    /// Middle of a cell.
    pub fn middle(&self, cell: usize) -> DVec2 {
        self.low + self.cell_m * (DVec2::new((cell % self.columns) as f64, (cell / self.columns) as f64) + 0.5)
    }

    /// Whether a cell lies at the edge.
    pub fn is_edge(&self, cell: usize) -> bool {
        let (column, row) = (cell % self.columns, cell / self.columns);
        column == 0 || row == 0 || column + 1 == self.columns || row + 1 == self.rows
    }

    /// The eight cells around one that is not at the edge, in order around it.
    pub fn around(&self, cell: usize) -> [usize; 8] {
        let (up, down) = (cell + self.columns, cell - self.columns);
        [cell + 1, up + 1, up, up - 1, cell - 1, down - 1, down, down + 1]
    }
}

/// Squared distances to the nearest taken cell: along the columns first, then along the rows.
fn squared_distances(is_taken: &[bool], columns: usize, rows: usize) -> Vec<u32> {
    let mut along = vec![FARTHEST as u32; is_taken.len()];
    for column in 0..columns {
        let mut pass = |rows: &mut dyn Iterator<Item = usize>| {
            let mut distance = FARTHEST as u32;
            for cell in rows.map(|row| row * columns + column) {
                distance = if is_taken[cell] { 0 } else { (distance + 1).min(FARTHEST as u32) };
                along[cell] = along[cell].min(distance);
            }
        };
        pass(&mut (0..rows));
        pass(&mut (0..rows).rev());
    }
    let squared = |cell: usize| {
        let (column, row) = (cell % columns, cell / columns);
        let reach = column.saturating_sub(FARTHEST)..(column + FARTHEST + 1).min(columns);
        let nearest = reach.map(|other| {
            let (aside, along) = (column.abs_diff(other) as u32, along[row * columns + other]);
            aside * aside + along * along
        });
        nearest.min().unwrap_or(0).min((FARTHEST * FARTHEST) as u32)
    };
    (0..is_taken.len()).map(squared).collect()
}
