//! Which ground is taken: a coarse grid seen from above that marks every cell a street or a thing touches.

use cosfly_domain::{SemanticLabel, Town};
use cosfly_frames::{DVec2, real};
use cosfly_town::polygons::triangulated;

/// Wanted size of a cell, metres.
const CELL_M: f64 = 0.25;
/// Most cells; larger towns get larger cells.
const MOST_CELLS: f64 = 32e6;

/// Use of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// A road, pavement, crossing or something that the file has.
    Street,
    /// Something invented, or a lot that stays open.
    Lot,
}

impl Use {
    fn bit(self) -> u8 {
        match self {
            Self::Street => 1,
            Self::Lot => 2,
        }
    }
}

/// A rectangle seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plot {
    /// Middle, metres.
    pub center: DVec2,
    /// Half the lengths of the sides, metres.
    pub half_m: DVec2,
    /// Direction of the first side, radians.
    pub yaw_rad: f64,
}

impl Plot {
    /// Corners in order, grown by `margin_m`.
    pub fn corners(&self, margin_m: f64) -> [DVec2; 4] {
        let (sin, cos) = real::sin_cos(self.yaw_rad);
        let half = self.half_m + DVec2::splat(margin_m);
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| {
            let (x, y) = (x * half.x, y * half.y);
            self.center + DVec2::new(cos * x - sin * y, sin * x + cos * y)
        })
    }
}

/// The grid.
#[derive(Clone, Debug)]
pub struct Land {
    low: DVec2,
    cell_m: f64,
    columns: usize,
    rows: usize,
    uses: Vec<u8>,
}

impl Land {
    /// Roads, pavements, walkable ground and obstacles of a town, and open land for 60 m around them.
    pub fn of_town(town: &Town) -> Self {
        let is_street = |label| !matches!(label, SemanticLabel::Terrain | SemanticLabel::Ground);
        let streets = || town.surfaces.iter().filter(|mesh| is_street(mesh.label));
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let corners = streets().flat_map(|mesh| &mesh.vertices_in_world);
        for corner in corners.chain(town.walkable.iter().flat_map(|area| &area.outline_in_world)) {
            low = low.min(corner.truncate());
            high = high.max(corner.truncate());
        }
        let margin = DVec2::splat(60.0);
        let size = if low.cmple(high).all() { high - low + 2.0 * margin } else { DVec2::ZERO };
        let cell_m = (size.x * size.y / MOST_CELLS).sqrt().max(CELL_M);
        let [columns, rows] = (size / cell_m).ceil().max(DVec2::ONE).to_array().map(|cells| cells as usize);
        let mut land = Self { low: low - margin, cell_m, columns, rows, uses: vec![0; columns * rows] };
        for mesh in streets() {
            for triangle in &mesh.triangles {
                land.mark(&triangle.map(|corner| mesh.vertices_in_world[corner as usize].truncate()), Use::Street);
            }
        }
        for area in &town.walkable {
            let outline: Vec<DVec2> = area.outline_in_world.iter().map(|corner| corner.truncate()).collect();
            let triangles = triangulated(&outline);
            if triangles.is_empty() {
                land.mark(&outline, Use::Street);
            }
            for triangle in triangles {
                land.mark(&triangle.map(|corner| outline[corner as usize]), Use::Street);
            }
        }
        for obstacle in &town.obstacles {
            let (shape, half) = (&obstacle.shape, obstacle.shape.half_extents_m.truncate());
            let plot = Plot { center: shape.center_in_world.truncate(), half_m: half, yaw_rad: shape.yaw_rad };
            land.mark(&plot.corners(0.0), Use::Street);
        }
        land
    }

    /// Marks every cell that the polygon touches (of a polygon with bays, the bays along x, too).
    pub fn mark(&mut self, outline: &[DVec2], by: Use) {
        let (columns, uses) = (self.columns, &mut self.uses);
        visit_rows(self.low, self.cell_m, columns, self.rows, outline, &mut |row, from, to| {
            uses[row * columns + from..=row * columns + to].iter_mut().for_each(|cell| *cell |= by.bit());
            true
        });
    }

    /// Whether the whole polygon lies on the grid and no cell that it touches is used so.
    pub fn is_free(&self, outline: &[DVec2], of: Use) -> bool {
        let high = self.low + self.cell_m * DVec2::new(self.columns as f64, self.rows as f64);
        let is_on_grid = |corner: &DVec2| corner.cmpge(self.low).all() && corner.cmple(high).all();
        outline.iter().all(is_on_grid)
            && visit_rows(self.low, self.cell_m, self.columns, self.rows, outline, &mut |row, from, to| {
                self.uses[row * self.columns + from..=row * self.columns + to].iter().all(|cell| cell & of.bit() == 0)
            })
    }

    /// Whether the cells are larger than wanted.
    pub fn is_coarse(&self) -> bool {
        self.cell_m > CELL_M
    }

    /// Side of a cell, metres.
    pub fn cell_m(&self) -> f64 {
        self.cell_m
    }
}

/// Calls `visit` with (row, first column, last column) of the cells that a polygon touches; false from `visit` stops,
/// and is the answer.
pub(crate) fn visit_rows(
    low: DVec2,
    cell_m: f64,
    columns: usize,
    rows: usize,
    outline: &[DVec2],
    visit: &mut impl FnMut(usize, usize, usize) -> bool,
) -> bool {
    /// So that a side on the line between two cells counts for both, cells.
    const SLACK: f64 = 1e-6;
    let in_cells = |corner: &DVec2| (*corner - low) / cell_m;
    let (mut first, mut last) = (f64::INFINITY, f64::NEG_INFINITY);
    for corner in outline {
        let y = in_cells(corner).y;
        (first, last) = (first.min(y), last.max(y));
    }
    if !(first.is_finite() && last.is_finite()) {
        return true;
    }
    let held = |cell: f64, count: usize| (cell.max(0.0) as usize).min(count - 1);
    for row in held(first - SLACK, rows)..=held(last + SLACK, rows) {
        let (from_y, to_y) = (row as f64 - SLACK, row as f64 + 1.0 + SLACK);
        let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
        for (index, corner) in outline.iter().enumerate() {
            let (a, b) = (in_cells(corner), in_cells(&outline[(index + 1) % outline.len()]));
            if a.y.max(b.y) < from_y || a.y.min(b.y) > to_y {
                continue;
            }
            let x_at = |y: f64| {
                if a.y == b.y { a.x } else { a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)).clamp(0.0, 1.0) }
            };
            let ends = if a.y == b.y { [a.x, b.x] } else { [x_at(from_y), x_at(to_y)] };
            left = left.min(ends[0]).min(ends[1]);
            right = right.max(ends[0]).max(ends[1]);
        }
        let is_beside = right + SLACK < 0.0 || left - SLACK >= columns as f64;
        if left <= right && !is_beside && !visit(row, held(left - SLACK, columns), held(right + SLACK, columns)) {
            return false;
        }
    }
    true
}
