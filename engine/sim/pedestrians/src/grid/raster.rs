//! Polygons and segments on the cells of the grid.

use super::tiles::Tiles;
use super::{MAX_CELLS, WalkableGrid, better_claim};
use crate::polygon::{Cut, Polygon};
use cosfly_domain::WalkableKind;
use cosfly_frames::DVec2;

/// Ground of one cell by the polygons, while the grid is built.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cell {
    pub kind: Option<WalkableKind>,
    pub z: f32,
    /// Length of the line inside the polygon that gave the height.
    span: f32,
    /// Some outline passes through the cell.
    pub outlined: bool,
}

impl Cell {
    /// Gives whether the cell had no ground before.
    fn claim(&mut self, kind: WalkableKind, z: f32, span: f32) -> bool {
        let is_new = self.kind.is_none();
        if self.kind.is_none_or(|old| better_claim((kind, z, span), (old, self.z, self.span))) {
            (self.kind, self.z, self.span) = (Some(kind), z, span);
        }
        is_new
    }
}

/// Ground of all cells.
pub(super) struct Cells {
    pub values: Tiles<Cell>,
    /// Cells with ground.
    pub count: usize,
}

/// Claims every cell whose centre lies in the polygon, line by line along `direction`. The error is the number of cells
/// that are too many.
pub(super) fn fill(
    grid: &WalkableGrid,
    polygon: &Polygon,
    across: DVec2,
    direction: DVec2,
    cut: &mut Cut,
    cells: &mut Cells,
) -> Result<(), usize> {
    let low = ((polygon.min.truncate() - grid.corner) / grid.cell_m).floor();
    let high = ((polygon.max.truncate() - grid.corner) / grid.cell_m).floor();
    let along_rows = direction.x > 0.0;
    for line in across.dot(low) as usize..=across.dot(high) as usize {
        let origin = grid.corner + across * ((line as f64 + 0.5) * grid.cell_m) + direction * (0.5 * grid.cell_m);
        polygon.cut_by_line(origin, direction, cut);
        for piece in &cut.intervals {
            let first = (piece.from / grid.cell_m).ceil().max(0.0) as usize;
            let last = (piece.to / grid.cell_m).floor();
            if last < 0.0 {
                continue;
            }
            for place in first..=last as usize {
                let (column, row) = if along_rows { (place, line) } else { (line, place) };
                if column < grid.numbering.columns && row < grid.numbering.rows {
                    let z = piece.z_at(place as f64 * grid.cell_m);
                    let span = (piece.to - piece.from) as f32;
                    let cell = cells.values.get_mut(grid.numbering.cell(column, row));
                    cells.count += usize::from(cell.claim(polygon.kind, z as f32, span));
                }
            }
        }
        if cells.count > MAX_CELLS {
            return Err(cells.count);
        }
    }
    Ok(())
}

/// Visits every cell that the segment passes through (a line exactly on a border visits one side).
pub(super) fn cells_on_segment(grid: &WalkableGrid, from: DVec2, to: DVec2, visit: &mut dyn FnMut(usize)) {
    let (start, end) = ((from - grid.corner) / grid.cell_m, (to - grid.corner) / grid.cell_m);
    let step = end - start;
    let (mut column, mut row) = (start.x.floor() as isize, start.y.floor() as isize);
    let (last_column, last_row) = (end.x.floor() as isize, end.y.floor() as isize);
    let axis = |place: f64, cell: isize, step: f64| {
        let border = if step > 0.0 { cell as f64 + 1.0 } else { cell as f64 };
        if step == 0.0 { (f64::INFINITY, f64::INFINITY) } else { ((border - place) / step, 1.0 / step.abs()) }
    };
    let (mut next_x, stride_x) = axis(start.x, column, step.x);
    let (mut next_y, stride_y) = axis(start.y, row, step.y);
    let crossings = (last_column - column).unsigned_abs() + (last_row - row).unsigned_abs();
    for crossing in 0..=crossings {
        if column >= 0 && row >= 0 && (column as usize) < grid.numbering.columns && (row as usize) < grid.numbering.rows
        {
            visit(grid.numbering.cell(column as usize, row as usize));
        }
        if crossing == crossings {
            break;
        }
        let x_left = column != last_column;
        let y_left = row != last_row;
        if x_left && (next_x <= next_y || !y_left) {
            column += step.x.signum() as isize;
            next_x += stride_x;
        } else {
            row += step.y.signum() as isize;
            next_y += stride_y;
        }
    }
}
