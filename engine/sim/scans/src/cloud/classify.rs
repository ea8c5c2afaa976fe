//! Roofs and plants told apart where the file does not: roofs are smooth and hide the ground.

use super::survey::{coarse_enough, grid_of, is_ground};
use super::{Cloud, class};
use crate::grid::parts;
use crate::relief::Relief;

/// Cells in which smoothness is judged are at least this wide, metres.
const NARROWEST_CELL_M: f64 = 1.0;
/// Lower points are neither roof nor crown, metres.
const LOWEST_ROOF_M: f64 = 2.0;
/// Bend of a smooth surface over two cells, metres for each metre of a cell.
const SMOOTH_BEND: f64 = 0.2;
/// Depth of the points of one roof within a cell, metres.
const THICKEST_ROOF_M: f64 = 1.2;
/// Step between a roof and its edge, metres for each metre of a cell.
const EDGE_STEP: f32 = 1.5;
/// Share of smooth cells around a cell of a roof.
const SMOOTH_SHARE: f64 = 0.5;
/// Smallest roof, square metres.
const SMALLEST_ROOF_M2: f64 = 16.0;

/// Whether the file says which points are buildings or plants.
pub fn is_classified(cloud: &Cloud) -> bool {
    let known = |class: &u8| *class == class::BUILDING || class::PLANTS.contains(class);
    let count = cloud.classes.iter().filter(|class| known(class)).count();
    count > 0 && count as f64 >= 0.001 * cloud.len() as f64
}

/// Gives unclassified points high above the ground the class of buildings or of plants; says so in words.
pub fn estimate(cloud: &mut Cloud, relief: &Relief, voxel_m: f64) -> String {
    let grid = grid_of(cloud, coarse_enough(cloud, (2.0 * voxel_m).max(NARROWEST_CELL_M)));
    let mut span = vec![[f32::INFINITY, f32::NEG_INFINITY]; grid.cells()];
    for point in 0..cloud.len() {
        let at = cloud.point(point);
        if !is_ground(cloud.classes[point]) && at.z - relief.height_m(at.truncate()) > LOWEST_ROOF_M {
            let [low, high] = &mut span[grid.cell_of(at.truncate())];
            (*low, *high) = (low.min(at.z as f32), high.max(at.z as f32));
        }
    }
    let is_high = |cell: usize| span[cell][1] > f32::NEG_INFINITY;
    let is_thin = |cell: usize| span[cell][1] - span[cell][0] <= THICKEST_ROOF_M as f32;
    let bend_m = (SMOOTH_BEND * grid.cell_m) as f32;
    let is_smooth: Vec<bool> = (0..grid.cells())
        .map(|cell| {
            let (column, row) = (cell % grid.columns, cell / grid.columns);
            let is_inside = column > 0 && row > 0 && column + 1 < grid.columns && row + 1 < grid.rows;
            // A ridge is straight along itself, a slope in all four directions: one of them and a thin cell will do.
            let is_straight = |step: usize| {
                let (before, after) = (cell - step, cell + step);
                let bend = 0.5 * (span[before][1] + span[after][1]) - span[cell][1];
                is_high(before) && is_high(after) && bend.abs() <= bend_m
            };
            is_inside
                && is_high(cell)
                && is_thin(cell)
                && [1, grid.columns, grid.columns - 1, grid.columns + 1]
                    .into_iter()
                    .filter(|step| is_straight(*step))
                    .count()
                    >= 2
        })
        .collect();
    let is_roof: Vec<bool> = (0..grid.cells())
        .map(|cell| {
            let near = || grid.around_cell(cell, 2).filter(|near| is_high(*near));
            let smooth = near().filter(|near| is_smooth[*near]).count();
            is_high(cell) && smooth as f64 >= SMOOTH_SHARE * near().count() as f64
        })
        .collect();
    // The edge of a roof has too few neighbours to be smooth: thin cells of like height beside a roof belong to it.
    let is_edge = |cell: usize| {
        let is_alike =
            |near: usize| is_roof[near] && (span[near][1] - span[cell][1]).abs() <= EDGE_STEP * grid.cell_m as f32;
        is_high(cell) && is_thin(cell) && grid.around_cell(cell, 2).any(is_alike)
    };
    let (part, count) = parts(&grid, |cell| is_roof[cell] || is_edge(cell));
    let mut sizes = vec![0_usize; count as usize + 1];
    for number in &part {
        sizes[*number as usize] += 1;
    }
    let least = SMALLEST_ROOF_M2 / (grid.cell_m * grid.cell_m);
    for point in 0..cloud.len() {
        let at = cloud.point(point);
        let cell = grid.cell_of(at.truncate());
        let is_low = at.z - relief.height_m(at.truncate()) <= LOWEST_ROOF_M;
        cloud.classes[point] = match cloud.classes[point] {
            known if is_ground(known) || known == class::BRIDGE => known,
            known if is_low => known,
            _ if part[cell] != 0 && sizes[part[cell] as usize] as f64 >= least => class::BUILDING,
            _ => class::HIGH_PLANTS,
        };
    }
    "buildings and plants are told apart by their shape: the cloud has no points of their classes".to_owned()
}
