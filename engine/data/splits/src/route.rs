//! Routes of walks: the ground they cover with the direction, and the rectangle around it.

use cosfly_frames::{DVec3, real};
use serde::{Deserialize, Serialize};

/// Edge of a cell, metres.
const CELL_M: f64 = 4.0;
/// Number of directions that are told apart.
const SECTORS: i64 = 8;
/// Shortest step that counts as walking, metres.
const LEAST_STEP_M: f64 = 0.05;

/// Ground that a walk covers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Route {
    /// Cells with directions, packed and sorted; standing adds nothing.
    cells: Vec<u64>,
    /// Smallest and largest x and y, metres; `None` without any position.
    pub extent_m: Option<[[f64; 2]; 2]>,
}

impl Route {
    /// Route of a pedestrian whose feet are at `feet_in_map`, one position per frame, in the map file's coordinates.
    pub fn of(feet_in_map: &[DVec3]) -> Self {
        let mut cells: Vec<u64> = vec![];
        let finite = feet_in_map.iter().filter(|feet| feet.is_finite());
        let extent_m = finite.fold(None, |extent, feet| {
            let [[low_x, high_x], [low_y, high_y]] = extent.unwrap_or([[feet.x; 2], [feet.y; 2]]);
            Some([[feet.x.min(low_x), feet.x.max(high_x)], [feet.y.min(low_y), feet.y.max(high_y)]])
        });
        for pair in feet_in_map.windows(2) {
            let step = (pair[1] - pair[0]).truncate();
            let length_m = step.length();
            if !(LEAST_STEP_M..1e3).contains(&length_m) {
                continue;
            }
            let turn = real::atan2(step.y, step.x) / core::f64::consts::TAU * SECTORS as f64;
            let sector = (turn + 0.5).floor() as i64;
            let stops = (length_m / (0.5 * CELL_M)).ceil().max(1.0) as i64;
            cells.extend((0..stops).map(|stop| {
                let at = (pair[0].truncate() + step * (stop as f64 / stops as f64)) / CELL_M;
                packed(at.x.floor() as i64, at.y.floor() as i64, sector)
            }));
        }
        cells.sort_unstable();
        cells.dedup();
        cells.shrink_to_fit();
        Self { cells, extent_m }
    }

    /// Cells with directions, in ascending order.
    pub fn cells(&self) -> &[u64] {
        &self.cells
    }
}

/// The cell itself and those within one cell and one direction of it.
pub fn near(cell: u64) -> impl Iterator<Item = u64> {
    let (i, j, sector) = unpacked(cell);
    (-1..=1).flat_map(move |di| {
        (-1..=1).flat_map(move |dj| (-1..=1).map(move |turn| packed(i + di, j + dj, sector + turn)))
    })
}

/// The cell in the opposite direction.
pub fn back(cell: u64) -> u64 {
    let (i, j, sector) = unpacked(cell);
    packed(i, j, sector + SECTORS / 2)
}

fn packed(i: i64, j: i64, sector: i64) -> u64 {
    let coordinate = |value: i64| (value.clamp(-(1 << 27), 1 << 27) + (1 << 28)) as u64;
    coordinate(i) << 34 | coordinate(j) << 4 | sector.rem_euclid(SECTORS) as u64
}

fn unpacked(cell: u64) -> (i64, i64, i64) {
    let coordinate = |bits: u64| (bits & ((1 << 30) - 1)) as i64 - (1 << 28);
    (coordinate(cell >> 34), coordinate(cell >> 4), (cell & 15) as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_stands_or_jumps_has_no_cells() {
        assert!(Route::of(&[DVec3::ONE; 50]).cells().is_empty());
        assert!(Route::of(&[DVec3::ZERO, DVec3::splat(f64::NAN), DVec3::splat(1e9)]).cells().is_empty());
        assert_eq!(Route::of(&[DVec3::splat(f64::NAN)]), Route::default());
        let (i, j, sector) = unpacked(packed(-7, 12, 9));
        assert_eq!((i, j, sector), (-7, 12, 1));
    }

    #[test]
    fn the_rectangle_holds_all_positions() {
        let route = Route::of(&[DVec3::new(1.0, -2.0, 0.0), DVec3::new(-3.0, 5.0, 9.0)]);
        assert_eq!(route.extent_m, Some([[-3.0, 1.0], [-2.0, 5.0]]));
    }
}
