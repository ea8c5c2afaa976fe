//! [`Survey`]: a classified cloud, sorted into cells.

use super::sorting::Sorted;
use super::{Cloud, class};
use crate::grid::Grid;
use crate::relief::Relief;
use cosfly_frames::DVec2;
use rayon::prelude::*;
use std::ops::Range;

/// Narrowest and widest cells that the density of the points asks for, metres.
const USUAL_VOXELS_M: [f64; 2] = [0.5, 2.0];
/// Usual height of the steps in which boxes follow roofs, metres.
const USUAL_STEP_M: f64 = 1.0;
/// Side of the cells in distances between neighbouring points.
const VOXELS_IN_SPACINGS: f64 = 0.7;
/// Cells over which the density is measured, metres.
const DENSITY_CELL_M: f64 = 4.0;
/// Most cells of a grid.
const MOST_CELLS: f64 = 16e6;
/// Most cells for each point: memory follows the size of the file.
const MOST_CELLS_PER_POINT: f64 = 64.0;
/// Gaps between points that are closed, in distances between neighbouring points.
const REACH_IN_SPACINGS: f64 = 2.0;
/// Widest gap that is closed on each side, metres.
const WIDEST_REACH_M: f64 = 4.0;

/// A cloud is of one scan where the mean number of points in a square is this many times that of the middle square.
const UNEVEN: f64 = 4.0;
/// Fewest squares for a verdict.
const FEWEST_SQUARES: usize = 50;

/// Points whose cells are marked at once.
const POINTS_AT_ONCE: usize = 1 << 20;

/// A cloud whose points all have a class.
#[derive(Debug)]
pub struct Survey<'a> {
    /// The points.
    pub cloud: &'a Cloud,
    /// Height of the ground.
    pub relief: Relief,
    /// Cells.
    pub grid: Grid,
    /// The points of each cell.
    sorted: Sorted,
    /// Cells without points take after points at most this far away, metres.
    pub reach_m: f64,
    /// Height of the steps in which boxes follow roofs and things, metres.
    pub step_m: f64,
    /// Whether boxes follow slopes in finer steps.
    pub follows_slopes: bool,
    /// Whether the file tells plants from other things.
    pub tells_plants: bool,
}

impl<'a> Survey<'a> {
    /// The cloud, its points at some distance from each other.
    pub fn new(cloud: &'a Cloud, relief: Relief, sorted: Sorted, spacing_m: f64, step_m: Option<f64>) -> Self {
        let voxel_m = sorted.grid.cell_m;
        let reach_m = (REACH_IN_SPACINGS * spacing_m).clamp(voxel_m, WIDEST_REACH_M.max(voxel_m));
        let follows_slopes = step_m.is_none();
        let step_m = step_m.unwrap_or(USUAL_STEP_M.max(voxel_m));
        Self { cloud, relief, grid: sorted.grid, sorted, reach_m, step_m, follows_slopes, tells_plants: true }
    }

    /// The points of a cell.
    pub fn points_of(&self, cell: usize) -> Range<usize> {
        self.sorted.of(cell)
    }

    /// See [`Sorted::gathered`].
    pub fn gathered<T: Clone + Send + Sync>(
        &self,
        grid: &Grid,
        empty: T,
        add: impl Fn(&mut T, usize, cosfly_frames::DVec3) + Sync,
    ) -> Vec<T> {
        self.sorted.gathered(self.cloud, grid, empty, add)
    }

    /// [`Self::reach_m`] in cells.
    pub fn reach_cells(&self) -> usize {
        (self.reach_m / self.grid.cell_m).ceil() as usize
    }

    /// Height of a point above the ground, metres.
    pub fn height_m(&self, point: usize) -> f64 {
        let at = self.cloud.point(point);
        at.z - self.relief.height_m(at.truncate())
    }
}

/// Whether a class is ground.
pub fn is_ground(class: u8) -> bool {
    matches!(class, class::GROUND | class::WATER | class::ROAD)
}

/// Cells over a cloud.
pub fn grid_of(cloud: &Cloud, cell_m: f64) -> Grid {
    Grid::around(cloud.bounds.into_iter(), cell_m, 0.0)
}

/// Distance between neighbouring points where there are points, metres.
pub fn spacing_m(cloud: &Cloud) -> f64 {
    let grid = grid_of(cloud, coarse_enough(cloud, DENSITY_CELL_M));
    let has_points = || vec![false; grid.cells()];
    let has_points = (0..cloud.len())
        .into_par_iter()
        .with_min_len(POINTS_AT_ONCE)
        .fold(has_points, |mut has, point| {
            has[grid.cell_of(cloud.point(point).truncate())] = true;
            has
        })
        .reduce(has_points, |mut a, b| {
            a.iter_mut().zip(b).for_each(|(a, b)| *a |= b);
            a
        });
    let covered = has_points.iter().filter(|has| **has).count() as f64;
    grid.cell_m * (covered / cloud.len().max(1) as f64).sqrt()
}

/// Says so where most points are near a few places, as in a single scan: things far away are fragments.
pub fn unevenness(cloud: &Cloud, sorted: &Sorted, is_classified: bool) -> Option<String> {
    let grid = grid_of(cloud, coarse_enough(cloud, DENSITY_CELL_M));
    let mut counts = sorted.gathered(cloud, &grid, 0_usize, |count, _, _| *count += 1);
    counts.retain(|count| *count > 0);
    counts.sort_unstable();
    let middle = *counts.get(counts.len() / 2)?;
    let mean = cloud.len() as f64 / counts.len() as f64;
    let is_uneven = counts.len() >= FEWEST_SQUARES && mean > UNEVEN * middle as f64;
    is_uneven.then(|| {
        let lack = if is_classified { "" } else { ", and no point has the class of ground" };
        format!(
            "the points crowd near a few places, as in a single scan or drive: half of the squares of {:.0} m have {middle} or fewer, the \
             mean is {mean:.0}{lack}; what is far from the scanner becomes fragments and bushes. Join all scans of the place, or take a \
             survey from the air",
            grid.cell_m
        )
    })
}

/// The cell size, or a larger one that gives the cloud no more cells than it may have.
pub fn coarse_enough(cloud: &Cloud, cell_m: f64) -> f64 {
    let [low, high] = cloud.bounds;
    let most = (MOST_CELLS_PER_POINT * cloud.len() as f64 + 1e4).min(MOST_CELLS);
    let cells = |cell_m: f64| ((high - low) / cell_m + 3.0).element_product();
    let mut cell_m = cell_m;
    while cells(cell_m) > most {
        cell_m *= 1.25;
    }
    cell_m
}

/// Side of the cells: as asked for, else by the density of the points.
pub fn voxel_m(cloud: &Cloud, spacing_m: f64, asked_m: Option<f64>, warnings: &mut Vec<String>) -> f64 {
    let [narrowest, widest] = USUAL_VOXELS_M;
    let wanted_m = asked_m.unwrap_or_else(|| (VOXELS_IN_SPACINGS * spacing_m).clamp(narrowest, widest));
    let voxel_m = coarse_enough(cloud, wanted_m);
    if voxel_m > wanted_m {
        warnings.push(format!("the cloud is too wide for cells of {wanted_m:.2} m: they are {voxel_m:.2} m wide"));
    }
    voxel_m
}

/// Positions in plan of points of some kind.
pub fn plan_of<'a>(cloud: &'a Cloud, points: &'a [usize]) -> impl Iterator<Item = DVec2> + 'a {
    points.iter().map(|point| cloud.point(*point).truncate())
}
