//! Columns of solid space on a grid, joined into few boxes.

use crate::grid::{Grid, parts};
use crate::window_cover::{Bases, CellWindow, Column, CoverBlock, Volumes, WIDEST};
use cosfly_domain::OrientedBox;
use cosfly_frames::DVec2;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// A cover of columns.
#[derive(Clone, Debug, Default)]
pub struct BoxCover {
    /// The boxes.
    pub shapes: Vec<OrientedBox>,
    /// Volumes, cubic metres.
    pub volumes: Volumes,
}

/// Boxes that hold every column to its top. None stands over a column by more than `tolerance_m`, or over a cell without
/// one that is not free. Each is as wide as it can be: it may reach under higher columns, and what stands on it begins at its top.
pub fn boxes_of(
    grid: &Grid,
    columns: &[Option<Column>],
    tolerance_m: f64,
    bases: Bases,
    is_free: impl Fn(usize) -> bool + Sync,
) -> BoxCover {
    let (part, _) = parts(grid, |cell| columns[cell].is_some());
    let mut pieces: BTreeMap<[usize; 3], Vec<([usize; 2], Column)>> = BTreeMap::new();
    for (cell, column) in columns.iter().enumerate() {
        let (place, Some(column)) = ([cell % grid.columns, cell / grid.columns], column) else { continue };
        let piece = [part[cell] as usize, place[1] / WIDEST, place[0] / WIDEST];
        pieces.entry(piece).or_default().push((place, *column));
    }
    let pieces: Vec<_> = pieces.into_values().collect();
    let is_free = |[column, row]: [usize; 2]| is_free(row * grid.columns + column);
    let cover = |cells: &Vec<([usize; 2], Column)>| CellWindow::of(cells, is_free).blocks(tolerance_m, bases);
    let covers: Vec<(Vec<CoverBlock>, Volumes)> = pieces.par_iter().map(cover).collect();
    let cell_m2 = grid.cell_m * grid.cell_m;
    BoxCover {
        shapes: covers.iter().flat_map(|(blocks, _)| blocks).map(|block| box_of(grid, block)).collect(),
        volumes: covers.iter().fold(Volumes::default(), |sum, (_, volumes)| sum.plus(*volumes, cell_m2)),
    }
}

fn box_of(grid: &Grid, block: &CoverBlock) -> OrientedBox {
    let [column, row, width, height] = block.cells.map(|cells| cells as f64);
    let size = DVec2::new(width, height);
    let center = grid.point(DVec2::new(column, row) + 0.5 * size);
    OrientedBox {
        center_in_world: center.extend(0.5 * (block.base_m + block.top_m)),
        half_extents_m: (0.5 * grid.cell_m * size).extend(0.5 * (block.top_m - block.base_m)),
        yaw_rad: grid.yaw_rad,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::window_cover::SAME_BASE_M;

    #[test]
    fn boxes_hold_every_column_and_little_else() {
        let grid = Grid::around([DVec2::ZERO, DVec2::new(119.9, 17.9)].into_iter(), 1.0, 0.4);
        let column = |cell: usize| {
            let top_m = 4.0 + ((cell * 7919) % 13) as f64 * 0.1 + (cell % grid.columns / 10) as f64;
            let base_m = 0.05 * (cell / grid.columns) as f64;
            (!cell.is_multiple_of(3) || cell.is_multiple_of(5)).then_some(Column { base_m, top_m })
        };
        let columns: Vec<_> = (0..grid.cells()).map(column).collect();
        let BoxCover { shapes: boxes, volumes } = boxes_of(&grid, &columns, 0.5, Bases::Lowest, |_| false);
        let solid_m3: f64 = columns.iter().flatten().map(|column| column.top_m - column.base_m).sum();
        assert!((volumes.solid - solid_m3).abs() < 1e-6 * solid_m3, "{volumes:?}");
        assert!(volumes.lost < 1e-6 * solid_m3 && volumes.gained < 0.15 * solid_m3, "{volumes:?}");
        assert!(4 * boxes.len() < 3 * columns.iter().flatten().count(), "{}", boxes.len());
        for (cell, column) in columns.iter().enumerate() {
            let at = grid.in_cells(grid.center(cell));
            let is_over = |one: &&OrientedBox| {
                let from = (at - grid.in_cells(one.center_in_world.truncate())).abs() * grid.cell_m;
                from.cmple(one.half_extents_m.truncate()).all()
            };
            let ends = |one: &OrientedBox| [-1.0, 1.0].map(|side| one.center_in_world.z + side * one.half_extents_m.z);
            let mut over: Vec<[f64; 2]> = boxes.iter().filter(is_over).map(ends).collect();
            over.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let Some(column) = column else {
                assert!(over.is_empty(), "cell {cell} is free");
                continue;
            };
            assert!(
                column.base_m - over[0][0] <= SAME_BASE_M + 1e-9 && over[0][0] <= column.base_m + 1e-9,
                "cell {cell}: {over:?}"
            );
            let top_m = over.iter().fold(over[0][0], |top_m, [from, to]| {
                assert!(*from <= top_m + 1e-9, "cell {cell} has a gap: {over:?}");
                top_m.max(*to)
            });
            assert!((-1e-9..=0.5).contains(&(top_m - column.top_m)), "cell {cell}: {top_m} for {}", column.top_m);
        }
    }

    #[test]
    fn boxes_stand_over_free_cells_alone_beside_columns() {
        let grid = Grid::around([DVec2::ZERO, DVec2::new(11.9, 19.9)].into_iter(), 1.0, 0.0);
        let notch = |cell: usize| (cell % grid.columns, cell / grid.columns) == (6, 5);
        let is_house =
            |cell: usize| (1..13).contains(&(cell % grid.columns)) && (5..12).contains(&(cell / grid.columns));
        let column = |cell: usize| (is_house(cell) && !notch(cell)).then_some(Column { base_m: 0.0, top_m: 6.0 });
        let columns: Vec<_> = (0..grid.cells()).map(column).collect();
        let closed = boxes_of(&grid, &columns, 1.0, Bases::Highest, |_| false);
        assert_eq!((closed.shapes.len(), closed.volumes.gained), (3, 0.0));
        let open = boxes_of(&grid, &columns, 1.0, Bases::Highest, notch);
        assert_eq!((open.shapes.len(), open.volumes.gained), (1, 6.0));
    }

    #[test]
    fn a_ridged_roof_is_one_box_for_each_step() {
        let grid = Grid::around([DVec2::ZERO, DVec2::new(11.9, 19.9)].into_iter(), 1.0, 0.0);
        let column = |cell: usize| {
            let (x, y) = (cell % grid.columns, cell / grid.columns);
            let is_house = (1..13).contains(&x) && (1..21).contains(&y);
            let rise_m = 0.5 * x.min(13 - x.min(13)) as f64;
            is_house.then_some(Column { base_m: 0.0, top_m: 6.0 + rise_m })
        };
        let columns: Vec<_> = (0..grid.cells()).map(column).collect();
        let boxes = boxes_of(&grid, &columns, 1.0, Bases::Highest, |_| false).shapes;
        assert!(boxes.len() <= 4, "{boxes:?}");
    }
}
