//! The ground under a cloud: from its classes, or estimated by opening the lowest surface with ever wider windows.

use super::sorting::Sorted;
use super::survey::{coarse_enough, grid_of, is_ground};
use super::{Cloud, class};
use crate::ground_filter::{least_heights, near_ground_m};
use crate::relief::Relief;
use rayon::prelude::*;

/// Share of all points that must be ground for the classes to count.
const LEAST_SHARE: f64 = 0.005;
/// Narrowest cells of the ground, metres.
const NARROWEST_CELL_M: f64 = 1.0;

/// Whether the file says which points are ground.
pub fn is_classified(cloud: &Cloud) -> bool {
    let ground = cloud.classes.par_iter().filter(|class| is_ground(**class)).count();
    ground > 0 && ground as f64 >= LEAST_SHARE * cloud.len() as f64
}

/// Heights of the ground points.
pub fn relief(cloud: &Cloud, sorted: &Sorted) -> Relief {
    let grid = grid_of(cloud, coarse_enough(cloud, sorted.grid.cell_m.max(NARROWEST_CELL_M)));
    let sums = sorted.gathered(cloud, &grid, (0.0_f64, 0_u32), |(sum, count), point, at| {
        if is_ground(cloud.classes[point]) {
            *sum += at.z;
            *count += 1;
        }
    });
    let mean = |(sum, count): &(f64, u32)| if *count > 0 { (sum / f64::from(*count)) as f32 } else { f32::NAN };
    Relief::new(grid, sums.iter().map(mean).collect())
}

/// Gives the points near the estimated ground the class of ground, all others that of no class unless they have one;
/// says so in words.
pub fn estimate(cloud: &mut Cloud, sorted: &Sorted) -> String {
    let grid = grid_of(cloud, coarse_enough(cloud, sorted.grid.cell_m.max(NARROWEST_CELL_M)));
    let lowest = sorted.gathered(cloud, &grid, f32::NAN, |lowest, _, at| *lowest = lowest.min(at.z as f32));
    let least = least_heights(lowest, [grid.columns, grid.rows], grid.cell_m);
    let lowest = sorted.gathered(cloud, &grid, f32::NAN, |lowest, _, at| {
        let height = at.z as f32;
        if height >= least[grid.cell_of(at.truncate())] {
            *lowest = lowest.min(height);
        }
    });
    let ground = Relief::new(grid, lowest);
    let above_m = |at: cosfly_frames::DVec3| at.z - ground.height_m(at.truncate());
    let class_of = |point: usize| {
        let is_near = above_m(cloud.point(point)).abs() <= near_ground_m(grid.cell_m);
        match cloud.classes[point] {
            known if class::PLANTS.contains(&known) || known == class::BUILDING => known,
            _ if is_near => class::GROUND,
            _ => class::UNCLASSIFIED,
        }
    };
    let classes = (0..cloud.len()).into_par_iter().map(class_of).collect();
    cloud.classes = classes;
    "the ground is estimated: the cloud has no points of the class for ground".to_owned()
}
