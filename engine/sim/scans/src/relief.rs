//! [`Relief`]: height of the ground on a grid, with the gaps filled smoothly, and its mesh.

use crate::grid::Grid;
use cosfly_domain::SemanticLabel;
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::mesh::MeshBuilder;

/// Most quads along one side of the mesh.
const MOST_QUADS: usize = 400;
/// Narrowest quad of the mesh, metres.
const NARROWEST_QUAD_M: f64 = 1.5;

/// Heights of the ground.
#[derive(Clone, Debug)]
pub struct Relief {
    /// Cells whose middles have a height.
    pub grid: Grid,
    /// Height of each cell's middle, world, metres.
    pub heights_m: Vec<f32>,
    /// Whether the ground was measured in a cell.
    pub is_measured: Vec<bool>,
}

impl Relief {
    /// Heights with the gaps (not a number) filled.
    pub fn new(grid: Grid, heights_m: Vec<f32>) -> Self {
        let is_measured = heights_m.iter().map(|height| !height.is_nan()).collect();
        Self { grid, heights_m: filled(heights_m, grid.columns, grid.rows), is_measured }
    }

    /// Height of the ground at a point of the world, metres.
    pub fn height_m(&self, at: DVec2) -> f64 {
        sampled(&self.heights_m, self.grid.columns, self.grid.rows, self.grid.in_cells(at))
    }

    /// Adds the ground as triangles: heights at the corners of wide cells, left out where nothing was measured nearby.
    /// `label` names the ground at a place.
    pub fn add_mesh(&self, meshes: &mut MeshBuilder, label: impl Fn(DVec2) -> SemanticLabel) {
        let longest = self.grid.columns.max(self.grid.rows);
        let step = longest.div_ceil(MOST_QUADS).max((NARROWEST_QUAD_M / self.grid.cell_m).ceil() as usize);
        let [across, along] = [self.grid.columns, self.grid.rows].map(|cells| cells.div_ceil(step));
        let corner = |column: usize, row: usize| {
            let at = self.grid.point(
                (DVec2::new(column as f64, row as f64) * step as f64)
                    .min(DVec2::new(self.grid.columns as f64, self.grid.rows as f64)),
            );
            (at.extend(self.height_m(at)), at)
        };
        for row in 0..along {
            for column in 0..across {
                if self.is_near_measured(column * step, row * step, step) {
                    let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(x, y)| corner(column + x, row + y));
                    let middle = 0.25 * corners.iter().map(|(_, plan)| *plan).sum::<DVec2>();
                    meshes.quad(label(middle), false, corners);
                }
            }
        }
    }

    fn is_near_measured(&self, column: usize, row: usize, step: usize) -> bool {
        let columns = column.saturating_sub(step)..(column + 2 * step).min(self.grid.columns);
        let mut rows = row.saturating_sub(step)..(row + 2 * step).min(self.grid.rows);
        rows.any(|row| columns.clone().any(|column| self.is_measured[row * self.grid.columns + column]))
    }

    /// A point of the world on the ground.
    pub fn on_ground(&self, at: DVec2) -> DVec3 {
        at.extend(self.height_m(at))
    }
}

/// Value between the middles of four cells; `at` in cells.
fn sampled(values: &[f32], columns: usize, rows: usize, at: DVec2) -> f64 {
    let at = (at - 0.5).max(DVec2::ZERO).min(DVec2::new((columns - 1) as f64, (rows - 1) as f64));
    let (column, row) = (at.x as usize, at.y as usize);
    let (right, above) = ((column + 1).min(columns - 1), (row + 1).min(rows - 1));
    let share = at - at.floor();
    let value = |column: usize, row: usize| f64::from(values[row * columns + column]);
    let low = value(column, row) * (1.0 - share.x) + value(right, row) * share.x;
    let high = value(column, above) * (1.0 - share.x) + value(right, above) * share.x;
    low * (1.0 - share.y) + high * share.y
}

/// Fills the gaps from means over ever larger cells, as pyramids of images do: near ground counts most, and all is smooth.
pub fn filled(mut values: Vec<f32>, columns: usize, rows: usize) -> Vec<f32> {
    if !values.iter().any(|value| value.is_nan()) {
        return values;
    }
    if columns == 1 && rows == 1 {
        return vec![0.0];
    }
    let (wide_columns, wide_rows) = (columns.div_ceil(2), rows.div_ceil(2));
    let mut sums = vec![(0.0_f64, 0_u32); wide_columns * wide_rows];
    for (cell, value) in values.iter().enumerate().filter(|(_, value)| !value.is_nan()) {
        let (sum, count) = &mut sums[cell / columns / 2 * wide_columns + cell % columns / 2];
        *sum += f64::from(*value);
        *count += 1;
    }
    let means = sums.iter().map(|(sum, count)| if *count > 0 { (sum / f64::from(*count)) as f32 } else { f32::NAN });
    let wide = filled(means.collect(), wide_columns, wide_rows);
    for (cell, value) in values.iter_mut().enumerate().filter(|(_, value)| value.is_nan()) {
        let at = 0.5 * DVec2::new((cell % columns) as f64 + 0.5, (cell / columns) as f64 + 0.5);
        *value = sampled(&wide, wide_columns, wide_rows, at) as f32;
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_of_a_slope_are_filled_within_its_range_and_measured_heights_stay() {
        let (columns, rows) = (40, 24);
        let slope = |cell: usize| 0.1 * (cell % columns) as f32;
        let is_gap = |cell: usize| (10..25).contains(&(cell % columns)) && (5..15).contains(&(cell / columns));
        let values = (0..columns * rows).map(|cell| if is_gap(cell) { f32::NAN } else { slope(cell) }).collect();
        let filled = filled(values, columns, rows);
        for (cell, value) in filled.iter().enumerate() {
            let error = (value - slope(cell)).abs();
            assert!(if is_gap(cell) { error < 0.6 } else { error == 0.0 }, "cell {cell}: {value}");
        }
    }

    #[test]
    fn ground_that_was_measured_nowhere_is_level() {
        assert_eq!(super::filled(vec![f32::NAN; 12], 4, 3), vec![0.0; 12]);
    }
}
