//! Distances from obstacles, kept per voxel of the world: what stands still is asked once, not once per layer.

use super::grid::{Cell, VoxelGrid};
use super::sight::StaticSight;

/// Largest number of voxels that are kept; wider paths ask anew.
const MAX_VOXELS: f64 = (1 << 24) as f64;

/// Signed distances of voxels' middles, capped at the safety influence radius.
pub struct ClearanceCache {
    low: [i32; 3],
    size: [i32; 3],
    distance_m: Vec<f32>,
    within_m: f64,
}

impl ClearanceCache {
    /// Nothing asked yet.
    pub fn new(grid: &VoxelGrid<'_>, within_m: f64) -> Self {
        let (mut low, mut high) = ([i32::MAX; 3], [i32::MIN; 3]);
        for layer in &grid.layers {
            for k in 0..3 {
                low[k] = low[k].min(layer.low[k]);
                high[k] = high[k].max(layer.low[k] + grid.size[k]);
            }
        }
        let size: [i32; 3] = core::array::from_fn(|k| high[k].saturating_sub(low[k]).max(0));
        let voxels: f64 = size.iter().map(|&count| f64::from(count)).product();
        let kept = if voxels <= MAX_VOXELS { voxels as usize } else { 0 };
        Self { low, size, distance_m: vec![f32::NAN; kept], within_m }
    }

    /// The distance of a cell's middle from all obstacles.
    #[inline]
    pub fn distance_m(&mut self, grid: &VoxelGrid<'_>, cell: Cell, sight: &impl StaticSight) -> f64 {
        let still_m = self.still_m(grid, cell, sight);
        grid.moving.distance_m(grid.layers[cell.layer].frame, grid.position(cell), still_m)
    }

    /// The distance from what stands still.
    #[inline]
    fn still_m(&mut self, grid: &VoxelGrid<'_>, cell: Cell, sight: &impl StaticSight) -> f64 {
        if self.distance_m.is_empty() {
            return sight.distance_m(grid.position(cell), self.within_m);
        }
        let from = grid.layers[cell.layer].low;
        let [x, y, z]: [usize; 3] = core::array::from_fn(|k| (cell.at[k] + from[k] - self.low[k]) as usize);
        let slot = &mut self.distance_m[(z * self.size[1] as usize + y) * self.size[0] as usize + x];
        if slot.is_nan() {
            // Rounded down: a hair too near rather than too far.
            *slot = (sight.distance_m(grid.position(cell), self.within_m) as f32).next_down();
        }
        f64::from(*slot)
    }
}

/// Whether the straight move between two cells keeps `keep_m`; the voxels' own distances settle most cases.
#[inline]
pub fn move_is_free(
    cache: &mut ClearanceCache,
    grid: &VoxelGrid<'_>,
    sight: &impl StaticSight,
    (from, to): (Cell, Cell),
    length_m: f64,
    keep_m: f64,
) -> bool {
    let (frames, ends) =
        (grid.layers[from.layer].frame..grid.layers[to.layer].frame, (grid.position(from), grid.position(to)));
    grid.moving.is_free(frames, ends.0, ends.1, keep_m)
        && still_is_free(cache, grid, sight, (from, to), length_m, keep_m)
}

#[inline]
fn still_is_free(
    cache: &mut ClearanceCache,
    grid: &VoxelGrid<'_>,
    sight: &impl StaticSight,
    (from, to): (Cell, Cell),
    length_m: f64,
    keep_m: f64,
) -> bool {
    let at_start = cache.still_m(grid, from, sight);
    if at_start - length_m >= keep_m {
        return true;
    }
    // No point of the segment is nearer than either end's distance less the way from that end.
    let at_end = cache.still_m(grid, to, sight);
    if at_end < keep_m || 0.5 * (at_start + at_end - length_m) >= keep_m {
        return at_end >= keep_m;
    }
    sight.segment_clearance_m(grid.position(from), grid.position(to), keep_m) >= keep_m
}
