//! Straighter outlines of roofs: cells in which nothing was seen follow their neighbours.

use crate::grid::Grid;
use crate::window_cover::Column;

/// Numbers of the eight neighbours: so many make a cell without points a roof, and so few make it none.
const MOST_AND_FEW: [usize; 2] = [5, 3];

/// Cells without points are roof where most around are, and as high as these in the mean.
pub fn smooth_unseen(grid: &Grid, roofs: &mut [Option<Column>], is_unseen: impl Fn(usize) -> bool) {
    let [most, few] = MOST_AND_FEW;
    let before = roofs.to_vec();
    for (cell, roof) in roofs.iter_mut().enumerate().filter(|(cell, _)| is_unseen(*cell)) {
        let near = || grid.around_cell(cell, 1).filter(|near| *near != cell).filter_map(|near| before[near]);
        let count = near().count();
        *roof = match roof {
            Some(_) if count <= few => None,
            None if count < most => None,
            _ => {
                let mean = |value: fn(Column) -> f64| near().map(value).sum::<f64>() / count as f64;
                Some(Column { base_m: mean(|column| column.base_m), top_m: mean(|column| column.top_m) })
            }
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::DVec2;

    #[test]
    fn unseen_cells_follow_their_neighbours() {
        let grid = Grid::around([DVec2::ZERO, DVec2::splat(7.9)].into_iter(), 1.0, 0.0);
        let (notch, spike) = (3 * grid.columns + 5, 6 * grid.columns + 4);
        let is_roof = |cell: usize| cell / grid.columns <= 5 && cell != notch || cell == spike;
        let roof = |cell: usize| is_roof(cell).then_some(Column { base_m: 1.0, top_m: (cell % grid.columns) as f64 });
        let mut roofs: Vec<Option<Column>> = (0..grid.cells()).map(roof).collect();
        smooth_unseen(&grid, &mut roofs, |cell| cell == notch || cell == spike);
        assert_eq!(roofs[notch], Some(Column { base_m: 1.0, top_m: 5.0 }));
        assert_eq!(roofs[spike], None);
    }
}
