//! [`Sorted`]: the points of a cloud in the order of the cells of a grid, so that a cell's points lie side by side.

use super::Cloud;
use crate::grid::Grid;
use cosfly_frames::{DVec2, DVec3};
use rayon::prelude::*;
use std::ops::Range;

/// Points that are told apart at once.
const SHARE: usize = 1 << 18;
/// Bands of rows that are sorted side by side.
const BANDS: usize = 64;
/// Rows of another grid that are filled at once.
const ROWS_AT_ONCE: usize = 16;

/// Where the points of each cell lie.
#[derive(Debug)]
pub struct Sorted {
    /// Cells.
    pub grid: Grid,
    starts: Vec<u32>,
}

/// The points of some rows.
struct Band {
    starts: Vec<u32>,
    positions: Vec<[f32; 3]>,
    classes: Vec<u8>,
}

impl Sorted {
    /// Sorts the points of a cloud; those of one cell keep their order.
    pub fn new(cloud: &mut Cloud, grid: Grid) -> Self {
        let rows = grid.rows.div_ceil(BANDS);
        let shares: Vec<Vec<Vec<[u32; 2]>>> = (0..cloud.len().div_ceil(SHARE))
            .into_par_iter()
            .map(|share| {
                let mut bands = vec![Vec::new(); BANDS];
                for point in share * SHARE..((share + 1) * SHARE).min(cloud.len()) {
                    let cell = grid.cell_of(cloud.point(point).truncate());
                    bands[cell / grid.columns / rows].push([cell as u32, point as u32]);
                }
                bands
            })
            .collect();
        let band = |band: usize| {
            let first = band * rows * grid.columns;
            let cells = (rows * grid.columns).min(grid.cells().saturating_sub(first));
            Band::new(cloud, first as u32, cells, || shares.iter().flat_map(|share| share[band].iter().copied()))
        };
        let bands: Vec<Band> = (0..BANDS).into_par_iter().map(band).collect();
        drop(shares);
        let count = cloud.len();
        let mut starts = Vec::with_capacity(grid.cells() + 1);
        (cloud.positions, cloud.classes) = (Vec::new(), Vec::new());
        cloud.positions.reserve_exact(count);
        cloud.classes.reserve_exact(count);
        for band in bands {
            let before = cloud.positions.len() as u32;
            starts.extend(band.starts[..band.starts.len() - 1].iter().map(|start| before + start));
            cloud.positions.extend(band.positions);
            cloud.classes.extend(band.classes);
        }
        starts.push(count as u32);
        Self { grid, starts }
    }

    /// The points of a cell.
    pub fn of(&self, cell: usize) -> Range<usize> {
        self.starts[cell] as usize..self.starts[cell + 1] as usize
    }

    /// Values for the cells of another grid over the same points, not turned: `add` takes the points of each cell in
    /// their order.
    pub fn gathered<T: Clone + Send + Sync>(
        &self,
        cloud: &Cloud,
        grid: &Grid,
        empty: T,
        add: impl Fn(&mut T, usize, DVec3) + Sync,
    ) -> Vec<T> {
        let mut values = vec![empty; grid.cells()];
        values.par_chunks_mut(ROWS_AT_ONCE * grid.columns).enumerate().for_each(|(band, values)| {
            let first = band * ROWS_AT_ONCE * grid.columns;
            let end = first + values.len();
            let own_row = |row: usize| self.grid.in_cells(grid.point(DVec2::new(0.0, row as f64))).y;
            let low = if first == 0 { 0 } else { (own_row(first / grid.columns) as usize).saturating_sub(1) };
            let high = if end == grid.cells() { self.grid.rows } else { own_row(end / grid.columns) as usize + 2 };
            let start = |row: usize| self.starts[row.min(self.grid.rows) * self.grid.columns] as usize;
            for point in start(low)..start(high) {
                let at = cloud.point(point);
                let cell = grid.cell_of(at.truncate());
                if (first..end).contains(&cell) {
                    add(&mut values[cell - first], point, at);
                }
            }
        });
        values
    }
}

impl Band {
    /// Cells from the first on, and their points: pairs of a cell and a point of the cloud.
    fn new<I: Iterator<Item = [u32; 2]>>(cloud: &Cloud, first: u32, cells: usize, members: impl Fn() -> I) -> Self {
        let mut starts = vec![0_u32; cells + 1];
        for [cell, _] in members() {
            starts[(cell - first) as usize + 1] += 1;
        }
        for cell in 0..cells {
            starts[cell + 1] += starts[cell];
        }
        let count = starts[cells] as usize;
        let (mut positions, mut classes) = (vec![[0.0; 3]; count], vec![0; count]);
        let mut next = starts.clone();
        for [cell, point] in members() {
            let place = &mut next[(cell - first) as usize];
            positions[*place as usize] = cloud.positions[point as usize];
            classes[*place as usize] = cloud.classes[point as usize];
            *place += 1;
        }
        Self { starts, positions, classes }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::{CloudBuilder, class};

    #[test]
    fn sorted_points_lie_in_their_cells_and_other_grids_find_them_all() {
        let mut builder = CloudBuilder::default();
        for i in 0..5000_u32 {
            let at = |step: u32, across: u32| f64::from((i * step) % across) * 0.1;
            builder.push(DVec3::new(at(7919, 997), at(104_729, 613), f64::from(i) * 0.01), class::GROUND);
        }
        let mut cloud = builder.finish(None, Vec::new()).unwrap();
        let heights: f64 = cloud.points().map(|at| at.z).sum();
        let [own, other] = [0.7, 1.3].map(|cell_m| Grid::around(cloud.bounds.into_iter(), cell_m, 0.0));
        let sorted = Sorted::new(&mut cloud, own);
        for cell in 0..own.cells() {
            let points: Vec<DVec3> = sorted.of(cell).map(|point| cloud.point(point)).collect();
            assert!(points.iter().all(|at| own.cell_of(at.truncate()) == cell), "cell {cell}");
            assert!(points.windows(2).all(|pair| pair[0].z < pair[1].z), "cell {cell} keeps the order");
        }
        let sums = sorted.gathered(&cloud, &other, [0.0; 2], |sums, _, at| *sums = [sums[0] + 1.0, sums[1] + at.z]);
        assert_eq!(sums.iter().map(|sums| sums[0]).sum::<f64>(), 5000.0);
        assert!((sums.iter().map(|sums| sums[1]).sum::<f64>() - heights).abs() < 1e-6);
    }
}
