//! Columns of solid space on a grid, joined into few boxes.

use crate::grid::Grid;
use cosfly_frames::DVec2;
use cosfly_geometry::OrientedBox;

/// Solid space over one cell, world, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// Lower end.
    pub base_m: f64,
    /// Upper end.
    pub top_m: f64,
}

/// Bases that differ by more are never joined, metres.
const SAME_BASE_M: f64 = 0.3;

/// Thinnest box, metres.
const THINNEST_M: f64 = 0.1;

/// Which of the bases of joined columns is that of their box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bases {
    /// The highest: nothing below a base is taken.
    Highest,
    /// The lowest: nothing solid is lost.
    Lowest,
}

/// Rectangles of cells whose tops differ by at most `tolerance_m`, as boxes to the highest top: nothing on top is lost.
pub fn boxes_of(grid: &Grid, columns: &[Option<Column>], tolerance_m: f64, bases: Bases) -> Vec<OrientedBox> {
    let mut is_taken = vec![false; columns.len()];
    let mut boxes = Vec::new();
    for first in 0..columns.len() {
        if is_taken[first] || columns[first].is_none() {
            continue;
        }
        let mut range = Range { tolerance_m, ..Range::default() };
        let mut take = |cells: &mut dyn Iterator<Item = usize>| {
            let mut wider = range;
            for cell in cells {
                if is_taken[cell] || !columns[cell].is_some_and(|column| wider.takes(column)) {
                    return false;
                }
            }
            range = wider;
            true
        };
        let (column, row) = (first % grid.columns, first / grid.columns);
        let (mut width, mut height) = (1, 1);
        let mut grows = [take(&mut std::iter::once(first)); 2];
        // By turns to both sides, so that rectangles become wide rather than long.
        while grows != [false; 2] {
            if grows[0] {
                let right = (0..height).map(|line| first + width + line * grid.columns);
                grows[0] = column + width < grid.columns && take(&mut right.into_iter());
                width += usize::from(grows[0]);
            }
            if grows[1] {
                let above = first + height * grid.columns;
                grows[1] = row + height < grid.rows && take(&mut (above..above + width));
                height += usize::from(grows[1]);
            }
        }
        for line in 0..height {
            is_taken[first + line * grid.columns..][..width].fill(true);
        }
        let size = DVec2::new(width as f64, height as f64);
        let center = grid.point(DVec2::new(column as f64, row as f64) + 0.5 * size);
        let base_m = range.base_m[usize::from(bases == Bases::Highest)];
        let top_m = range.top_m[1].max(base_m + THINNEST_M);
        boxes.push(OrientedBox {
            center_in_world: center.extend(0.5 * (base_m + top_m)),
            half_extents_m: (0.5 * grid.cell_m * size).extend(0.5 * (top_m - base_m)),
            yaw_rad: grid.yaw_rad,
        });
    }
    boxes
}

/// Smallest and largest base and top.
#[derive(Clone, Copy)]
struct Range {
    base_m: [f64; 2],
    top_m: [f64; 2],
    tolerance_m: f64,
}

impl Default for Range {
    fn default() -> Self {
        Self { base_m: [f64::INFINITY, f64::NEG_INFINITY], top_m: [f64::INFINITY, f64::NEG_INFINITY], tolerance_m: 0.0 }
    }
}

impl Range {
    /// Widens the range; whether it stays within the tolerance.
    fn takes(&mut self, column: Column) -> bool {
        for ([low, high], value) in [(&mut self.base_m, column.base_m), (&mut self.top_m, column.top_m)] {
            (*low, *high) = (low.min(value), high.max(value));
        }
        self.base_m[1] - self.base_m[0] <= SAME_BASE_M && self.top_m[1] - self.top_m[0] <= self.tolerance_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_cover_every_column_to_its_top_and_nothing_else() {
        let grid = Grid::around([DVec2::ZERO, DVec2::new(9.9, 7.9)].into_iter(), 1.0, 0.4);
        let column = |cell: usize| {
            let top_m = 4.0 + ((cell * 7919) % 13) as f64 * 0.1;
            (!cell.is_multiple_of(3) || cell.is_multiple_of(5)).then_some(Column { base_m: 0.0, top_m })
        };
        let columns: Vec<_> = (0..grid.cells()).map(column).collect();
        let boxes = boxes_of(&grid, &columns, 0.5, Bases::Highest);
        let total: f64 = boxes.iter().map(|one| 4.0 * one.half_extents_m.x * one.half_extents_m.y).sum();
        assert!((total - columns.iter().flatten().count() as f64).abs() < 1e-9, "the boxes do not overlap");
        for (cell, column) in columns.iter().enumerate() {
            let at = grid.in_cells(grid.center(cell));
            let over = boxes.iter().find(|one| {
                let from = (at - grid.in_cells(one.center_in_world.truncate())).abs() * grid.cell_m;
                from.cmple(one.half_extents_m.truncate()).all()
            });
            let top_m = over.map(|one| one.center_in_world.z + one.half_extents_m.z);
            match column {
                Some(column) => assert!((0.0..=0.5 + 1e-9).contains(&(top_m.unwrap() - column.top_m + 1e-12))),
                None => assert_eq!(top_m, None),
            }
        }
    }
}
