//! Roofs and plants told apart where the file does not: roofs are smooth and hide the ground.

use super::planes::PlaneSums;
use super::sorting::Sorted;
use super::survey::{coarse_enough, grid_of, is_ground};
use super::{Cloud, class};
use crate::grid::{Grid, parts};
use crate::relief::Relief;
use cosfly_frames::DVec3;
use rayon::prelude::*;

/// Cells in which smoothness is judged are at least this wide, metres.
const NARROWEST_CELL_M: f64 = 1.0;
/// Most cells.
const MOST_CELLS: f64 = 4e6;
/// Lower points are neither roof nor crown, metres.
const LOWEST_ROOF_M: f64 = 2.0;
/// Roughness of a roof over three cells: root of the mean squared distance from a plane, metres.
const SMOOTH_M: f64 = 0.16;
/// Points deeper under the highest one of their cell are no part of its surface, metres.
const ROOF_DEPTH_M: f64 = 1.0;
/// Step between a roof and its edge, metres for each metre of a cell.
const EDGE_STEP: f64 = 1.0;
/// Share of smooth cells around a cell of a roof.
const SMOOTH_SHARE: f64 = 0.5;
/// Share of all points that must be of a class for it to count.
const LEAST_SHARE: f64 = 0.001;
/// Smallest roof, square metres.
const SMALLEST_ROOF_M2: f64 = 16.0;

/// The points of a roof or wall in a cell of the plan are a wall where their lowest one is at most so high above the ground and
/// their highest one so much higher, metres.
const LOWEST_WALL_M: f64 = 3.0;
const LEAST_WALL_M: f64 = 1.5;

/// Questions that the classes of a file leave open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unknown {
    /// Which points are buildings and which plants.
    Both,
    /// Which unclassified points are buildings.
    Buildings,
    /// Which unclassified points are plants.
    Plants,
}

impl Unknown {
    /// Questions that the classes of a cloud leave open; none where both are there.
    pub fn of(cloud: &Cloud) -> Option<Self> {
        let has = |known: fn(&u8) -> bool| {
            let count = cloud.classes.par_iter().filter(|class| known(class)).count();
            count > 0 && count as f64 >= LEAST_SHARE * cloud.len() as f64
        };
        match (has(|class| *class == class::BUILDING), has(|class| class::PLANTS.contains(class))) {
            (true, true) => None,
            (true, false) => Some(Self::Plants),
            (false, true) => Some(Self::Buildings),
            (false, false) => Some(Self::Both),
        }
    }

    /// Whether a point of a class may be of the unknown ones.
    fn is_open(self, class: u8) -> bool {
        if self == Self::Both { !is_ground(class) } else { class == class::UNCLASSIFIED }
    }

    fn note(self) -> String {
        match self {
            Self::Both => "buildings and plants are told apart by their shape: the cloud has no points of their classes",
            Self::Buildings => "unclassified points in smooth roofs are buildings: the cloud has no points of their class",
            Self::Plants => "unclassified points above 2 m and in no smooth roof are plants: the cloud has no points of their classes",
        }
        .to_owned()
    }
}

/// Gives unclassified points high above the ground the class of buildings or of plants; says so in words.
pub fn estimate(cloud: &mut Cloud, sorted: &Sorted, relief: &Relief, unknown: Unknown) -> String {
    let widest_m = ((cloud.bounds[1] - cloud.bounds[0]).element_product() / MOST_CELLS).sqrt();
    let grid = grid_of(cloud, coarse_enough(cloud, (2.0 * sorted.grid.cell_m).max(NARROWEST_CELL_M).max(widest_m)));
    let is_high_point = |point: usize, at: DVec3| {
        unknown.is_open(cloud.classes[point]) && at.z - relief.height_m(at.truncate()) > LOWEST_ROOF_M
    };
    let top_m = sorted.gathered(cloud, &grid, f64::NEG_INFINITY, |top_m, point, at| {
        if is_high_point(point, at) {
            *top_m = top_m.max(at.z);
        }
    });
    let sums = sorted.gathered(cloud, &grid, PlaneSums::default(), |sums, point, at| {
        if is_high_point(point, at) && at.z > top_m[grid.cell_of(at.truncate())] - ROOF_DEPTH_M {
            sums.add(at - cloud.bounds[0].extend(0.0));
        }
    });
    let is_high = |cell: usize| top_m[cell] > f64::NEG_INFINITY;
    let is_smooth = smooth_cells(&grid, &sums, is_high);
    let is_roof: Vec<bool> = (0..grid.cells())
        .map(|cell| {
            let near = || grid.around_cell(cell, 2).filter(|near| is_high(*near));
            let smooth = near().filter(|near| is_smooth[*near]).count();
            is_high(cell) && smooth as f64 >= SMOOTH_SHARE * near().count() as f64
        })
        .collect();
    // The edge of a roof has too few neighbours to be smooth: cells of like height beside a roof belong to it.
    let is_edge = |cell: usize| {
        let is_alike = |near: usize| is_roof[near] && (top_m[near] - top_m[cell]).abs() <= EDGE_STEP * grid.cell_m;
        is_high(cell) && grid.around_cell(cell, 2).any(is_alike)
    };
    let (part, count) = parts(&grid, |cell| is_roof[cell] || is_edge(cell));
    let mut sizes = vec![0_usize; count as usize + 1];
    for number in &part {
        sizes[*number as usize] += 1;
    }
    let least = SMALLEST_ROOF_M2 / (grid.cell_m * grid.cell_m);
    let class_of = |point: usize| {
        let at = cloud.point(point);
        let cell = grid.cell_of(at.truncate());
        let is_low = at.z - relief.height_m(at.truncate()) <= LOWEST_ROOF_M;
        match cloud.classes[point] {
            known if is_ground(known) || known == class::BRIDGE => known,
            known if is_low || !unknown.is_open(known) => known,
            open => {
                let is_roof = part[cell] != 0 && sizes[part[cell] as usize] as f64 >= least;
                match unknown {
                    Unknown::Both | Unknown::Buildings if is_roof => class::BUILDING,
                    Unknown::Both | Unknown::Plants if !is_roof => class::HIGH_PLANTS,
                    _ => open,
                }
            }
        }
    };
    let mut classes: Vec<u8> = (0..cloud.len()).into_par_iter().map(class_of).collect();
    for foot in feet_of_walls(cloud, sorted, relief, unknown, &classes) {
        classes[foot] = class::BUILDING;
    }
    cloud.classes = classes;
    unknown.note()
}

/// Open points below the height of roofs in the cells of walls, told by `classes`: without them each house would stand in a low
/// thing along its walls.
fn feet_of_walls(cloud: &Cloud, sorted: &Sorted, relief: &Relief, unknown: Unknown, classes: &[u8]) -> Vec<usize> {
    let height_m = |point: usize| {
        let at = cloud.point(point);
        at.z - relief.height_m(at.truncate())
    };
    let is_of_house = |point: &usize| classes[*point] == class::BUILDING && unknown.is_open(cloud.classes[*point]);
    let is_wall = |cell: &usize| {
        let heights = sorted.of(*cell).filter(is_of_house).map(height_m);
        let (low_m, high_m) =
            heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), it| (low.min(it), high.max(it)));
        low_m <= LOWEST_WALL_M && high_m - low_m >= LEAST_WALL_M
    };
    let is_foot = |point: &usize| {
        unknown.is_open(cloud.classes[*point])
            && cloud.classes[*point] != class::BRIDGE
            && height_m(*point) <= LOWEST_ROOF_M
    };
    let walls = (0..sorted.grid.cells()).into_par_iter().filter(is_wall);
    walls.flat_map_iter(|cell| sorted.of(cell).filter(is_foot)).collect()
}

/// Cells of which points lie in one plane with those around, or with those around a neighbour.
fn smooth_cells(grid: &Grid, sums: &[PlaneSums], is_high: impl Fn(usize) -> bool) -> Vec<bool> {
    let roughness_m: Vec<f64> = (0..grid.cells())
        .map(|cell| {
            let mut around = PlaneSums::default();
            grid.around_cell(cell, 1).filter(|_| is_high(cell)).for_each(|near| around.join(&sums[near]));
            around.roughness_m()
        })
        .collect();
    // A cell beside a ridge or an edge is smooth with one of its neighbours as the middle.
    (0..grid.cells())
        .map(|cell| is_high(cell) && grid.around_cell(cell, 1).any(|near| roughness_m[near] <= SMOOTH_M))
        .collect()
}
