//! [`Grid`]: square cells over a plan, turned if need be, and the points that lie in each.

use cosfly_frames::{DVec2, real};

/// Square cells in rows.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// Corner of the first cell in the turned frame, metres.
    low: DVec2,
    sin: f64,
    cos: f64,
    /// Turn of the grid about the world's origin, x towards y, radians.
    pub yaw_rad: f64,
    /// Side of a cell, metres.
    pub cell_m: f64,
    /// Cells of a row.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
}

/// Distance of the lowest points from the border of their cells, in cells.
const WITHIN: f64 = 0.01;

impl Grid {
    /// Cells around points of the world, with one free cell on each side.
    pub fn around(points: impl Iterator<Item = DVec2>, cell_m: f64, yaw_rad: f64) -> Self {
        Self::with_corner(points, cell_m, yaw_rad, |low| ((low / cell_m).floor() - 1.0) * cell_m)
    }

    /// [`Self::around`] with the lowest points at borders of cells: a wall along them leaves no cells half full.
    pub fn flush(points: impl Iterator<Item = DVec2>, cell_m: f64, yaw_rad: f64) -> Self {
        Self::with_corner(points, cell_m, yaw_rad, |low| low - (1.0 + WITHIN) * cell_m)
    }

    fn with_corner(
        points: impl Iterator<Item = DVec2>,
        cell_m: f64,
        yaw_rad: f64,
        corner: impl Fn(DVec2) -> DVec2,
    ) -> Self {
        let (sin, cos) = real::sin_cos(yaw_rad);
        let turned = |point: DVec2| DVec2::new(cos * point.x + sin * point.y, cos * point.y - sin * point.x);
        let (low, high) = points
            .map(turned)
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), point| (low.min(point), high.max(point)));
        let (low, high) = if low.is_finite() && high.is_finite() { (low, high) } else { (DVec2::ZERO, DVec2::ZERO) };
        let low = corner(low);
        let [columns, rows] = ((high - low) / cell_m).to_array().map(|cells| cells as usize + 2);
        Self { low, sin, cos, yaw_rad, cell_m, columns, rows }
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.columns * self.rows
    }

    /// A point in cells from the corner of the first one.
    pub fn in_cells(&self, point: DVec2) -> DVec2 {
        let turned = DVec2::new(self.cos * point.x + self.sin * point.y, self.cos * point.y - self.sin * point.x);
        (turned - self.low) / self.cell_m
    }

    /// The cell of a point; the nearest one for points outside.
    pub fn cell_of(&self, point: DVec2) -> usize {
        let at = self.in_cells(point).max(DVec2::ZERO);
        (at.y as usize).min(self.rows - 1) * self.columns + (at.x as usize).min(self.columns - 1)
    }

    /// Place in the world of a point given in cells.
    pub fn point(&self, in_cells: DVec2) -> DVec2 {
        let turned = self.low + self.cell_m * in_cells;
        DVec2::new(self.cos * turned.x - self.sin * turned.y, self.sin * turned.x + self.cos * turned.y)
    }

    /// Middle of a cell.
    pub fn center(&self, cell: usize) -> DVec2 {
        self.point(DVec2::new((cell % self.columns) as f64 + 0.5, (cell / self.columns) as f64 + 0.5))
    }

    /// The cells at most `reach` columns and rows away, itself among them.
    pub fn around_cell(&self, cell: usize, reach: usize) -> impl Iterator<Item = usize> + use<> {
        let (column, row) = (cell % self.columns, cell / self.columns);
        let columns = column.saturating_sub(reach)..(column + reach + 1).min(self.columns);
        let (rows, width) = (row.saturating_sub(reach)..(row + reach + 1).min(self.rows), self.columns);
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }
}

/// The points of each cell.
#[derive(Debug)]
pub struct Buckets {
    starts: Vec<u32>,
    members: Vec<u32>,
}

impl Buckets {
    /// Sorts points into `cells` cells; those without one are left out.
    pub fn new(cells: usize, cell_of: impl Fn(usize) -> Option<usize>, points: usize) -> Self {
        let mut starts = vec![0_u32; cells + 1];
        for cell in (0..points).filter_map(&cell_of) {
            starts[cell + 1] += 1;
        }
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        let mut next = starts.clone();
        let mut members = vec![0_u32; starts[cells] as usize];
        for point in 0..points {
            if let Some(cell) = cell_of(point) {
                members[next[cell] as usize] = point as u32;
                next[cell] += 1;
            }
        }
        Self { starts, members }
    }

    /// The points of a cell, in their order.
    pub fn of(&self, cell: usize) -> impl Iterator<Item = usize> {
        self.members[self.starts[cell] as usize..self.starts[cell + 1] as usize].iter().map(|point| *point as usize)
    }
}

/// Number of each cell's connected part (all eight neighbours touch), from 1 in the order of the first cells; 0 for
/// cells that do not count. The second value is the number of parts.
pub fn parts(grid: &Grid, counts: impl Fn(usize) -> bool) -> (Vec<u32>, u32) {
    let mut part = vec![0_u32; grid.cells()];
    let (mut number, mut stack) = (0, Vec::new());
    for start in 0..grid.cells() {
        if part[start] != 0 || !counts(start) {
            continue;
        }
        number += 1;
        part[start] = number;
        stack.push(start);
        while let Some(cell) = stack.pop() {
            for next in grid.around_cell(cell, 1) {
                if part[next] == 0 && counts(next) {
                    part[next] = number;
                    stack.push(next);
                }
            }
        }
    }
    (part, number)
}

/// For each cell the nearest seed, at most `reach` cells away; `u32::MAX` where there is none. Rings of eight and four
/// neighbours take turns, which is near enough to true distance.
pub fn nearest_seeds(grid: &Grid, is_seed: impl Fn(usize) -> bool, reach: usize) -> Vec<u32> {
    let mut nearest = vec![u32::MAX; grid.cells()];
    let mut ring: Vec<usize> = (0..grid.cells()).filter(|cell| is_seed(*cell)).collect();
    for cell in &ring {
        nearest[*cell] = *cell as u32;
    }
    for step in 0..reach {
        let mut next = Vec::new();
        for cell in &ring {
            let is_beside = |other: &usize| {
                step % 2 == 1
                    || other % grid.columns == cell % grid.columns
                    || other / grid.columns == cell / grid.columns
            };
            for other in grid.around_cell(*cell, 1).filter(is_beside) {
                if nearest[other] == u32::MAX {
                    nearest[other] = nearest[*cell];
                    next.push(other);
                }
            }
        }
        ring = next;
    }
    nearest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flush_cells_begin_at_the_lowest_points() {
        let corners = [DVec2::new(3.21, -7.43), DVec2::new(17.21, 2.57)];
        let grid = Grid::flush(corners.into_iter(), 0.5, 0.0);
        let places = corners.map(|corner| grid.in_cells(corner));
        assert!((places[0] - 1.01).abs().max_element() < 1e-9, "{places:?}");
        assert!(places[1].cmplt(DVec2::new(grid.columns as f64, grid.rows as f64)).all(), "{places:?}");
    }
}
