//! Plants: trees found as hills of the canopy, each a stack of boxes on a trunk; low plants as bushes; narrow high ones on
//! the walls of a house as parts of the house.

use super::class;
use super::houses::Houses;
use super::numbers::next_id;
use super::survey::{Survey, coarse_enough, grid_of};
use crate::grid::{Buckets, Grid};
use cosfly_domain::{Obstacle, ObstacleKind, OrientedBox};
use cosfly_frames::{DVec2, DVec3};
use rayon::prelude::*;

/// Narrowest cells of the canopy, metres.
const NARROWEST_CELL_M: f64 = 1.0;
/// Lower points are grass, metres.
const GRASS_M: f64 = 0.5;
/// Lower plants are bushes, metres.
const LOWEST_TREE_M: f64 = 3.0;
/// Height of the boxes of a crown that is aimed at, metres, and most boxes of a crown.
const LAYER_M: f64 = 3.0;
const MOST_LAYERS: f64 = 5.0;
/// Neighbouring boxes of a crown become one where they fill at least this share of it.
const LEAST_FILLED: f64 = 0.8;
/// Distance of plants above the ground under them, metres.
const ABOVE_GROUND_M: f64 = 0.15;
/// Half width of a trunk as a share of the tree's height, and its limits, metres.
const TRUNK_SHARE: f64 = 0.012;
const TRUNK_M: [f64; 2] = [0.06, 0.4];
/// Extent of a layer: standard deviations of its points about their middle, at most. Wider ones are twigs.
const DEVIATIONS: f64 = 2.2;

/// Adds all trees and bushes.
pub fn add(survey: &Survey<'_>, obstacles: &mut Vec<Obstacle>) {
    let cloud = survey.cloud;
    let is_plant = |point: usize| class::PLANTS.contains(&cloud.classes[point]) && survey.height_m(point) > GRASS_M;
    let plants: Vec<usize> = (0..cloud.len()).into_par_iter().filter(|point| is_plant(*point)).collect();
    if plants.is_empty() {
        return;
    }
    let cell_m = coarse_enough(cloud, (2.0 * survey.grid.cell_m).max(NARROWEST_CELL_M));
    let grid = grid_of(cloud, cell_m);
    let top_m = survey.gathered(&grid, f32::NEG_INFINITY, |top_m, point, _| {
        if class::PLANTS.contains(&cloud.classes[point]) {
            let height_m = survey.height_m(point);
            *top_m = if height_m > GRASS_M { top_m.max(height_m as f32) } else { *top_m };
        }
    });
    let peaks = peaks(&grid, &top_m);
    let peak_of = |point: &usize| peaks[grid.cell_of(cloud.point(*point).truncate())];
    let peak_of: Vec<u32> = plants.par_iter().map(peak_of).collect();
    let members = Buckets::new(grid.cells(), |member| Some(peak_of[member] as usize), plants.len());
    let is_peak = |cell: &usize| peaks[*cell] as usize == *cell && top_m[*cell] > f32::NEG_INFINITY;
    let crown = |peak: usize| {
        let points: Vec<DVec3> = members.of(peak).map(|member| cloud.point(plants[member])).collect();
        let is_tree = f64::from(top_m[peak]) >= LOWEST_TREE_M;
        (peak, layers(survey, &points, cell_m, if is_tree { MOST_LAYERS } else { 1.0 }))
    };
    let crowns: Vec<(usize, Vec<OrientedBox>)> = (0..grid.cells()).into_par_iter().filter(is_peak).map(crown).collect();
    let houses = Houses::of(obstacles);
    // Parts of houses have numbers of their own between: those of plants rise apart.
    let mut object_id = next_id(obstacles);
    for (peak, crown) in crowns {
        if let Some(object_id) = houses.behind(&crown).filter(|_| f64::from(top_m[peak]) >= LOWEST_TREE_M) {
            let part = |shape| Obstacle { shape, kind: ObstacleKind::Building, object_id, synthetic: false };
            obstacles.extend(crown.into_iter().map(part));
            continue;
        }
        let has_boxes = !crown.is_empty();
        let obstacle = |shape, kind, synthetic| Obstacle { shape, kind, object_id, synthetic };
        let height_m = f64::from(top_m[peak]);
        let is_tree = height_m >= LOWEST_TREE_M;
        let kind = if is_tree { ObstacleKind::TreeCrown } else { ObstacleKind::Bush };
        if let Some(lowest) = crown.first().filter(|_| is_tree) {
            obstacles
                .extend(trunk(survey, lowest, height_m).map(|shape| obstacle(shape, ObstacleKind::TreeTrunk, true)));
        }
        obstacles.extend(crown.into_iter().map(|shape| obstacle(shape, kind, false)));
        object_id += u32::from(has_boxes);
    }
}

/// The hilltop of each cell: the way up over the highest cell within two, to where there is none higher.
fn peaks(grid: &Grid, top_m: &[f32]) -> Vec<u32> {
    let smooth: Vec<f32> = (0..grid.cells())
        .into_par_iter()
        .map(|cell| {
            let near = || grid.around_cell(cell, 1).map(|near| top_m[near]).filter(|top| top.is_finite());
            if top_m[cell].is_finite() { near().sum::<f32>() / near().count() as f32 } else { f32::NEG_INFINITY }
        })
        .collect();
    let higher = |a: &usize, b: &usize| smooth[*a].total_cmp(&smooth[*b]).then(b.cmp(a));
    let highest = |cell: usize| grid.around_cell(cell, 2).max_by(higher).unwrap_or(cell) as u32;
    let up: Vec<u32> = (0..grid.cells()).into_par_iter().map(highest).collect();
    let mut peaks = up.clone();
    for cell in 0..peaks.len() {
        while up[peaks[cell] as usize] != peaks[cell] {
            peaks[cell] = up[peaks[cell] as usize];
        }
    }
    peaks
}

/// Boxes around the points of a plant, from below to above.
fn layers(survey: &Survey<'_>, points: &[DVec3], cell_m: f64, most: f64) -> Vec<OrientedBox> {
    let low_m = points.iter().map(|point| point.z).fold(f64::INFINITY, f64::min);
    let high_m = points.iter().map(|point| point.z).fold(f64::NEG_INFINITY, f64::max);
    let count = ((high_m - low_m) / LAYER_M).ceil().clamp(1.0, most);
    let layer_m = (high_m - low_m) / count;
    let mut sums = vec![Extent::default(); count as usize];
    for point in points {
        let layer = if layer_m > 0.0 { ((point.z - low_m) / layer_m) as usize } else { 0 };
        sums[layer.min(count as usize - 1)].add(point.truncate());
    }
    let bounds = sums.iter().enumerate().filter(|(_, extent)| extent.count > 0.0);
    let boxes = bounds.filter_map(|(layer, extent)| {
        let (low, high) = extent.bounds(0.5 * cell_m);
        let ground_m = [low, high, DVec2::new(low.x, high.y), DVec2::new(high.x, low.y), 0.5 * (low + high)]
            .map(|corner| survey.relief.height_m(corner))
            .into_iter()
            .fold(f64::NEG_INFINITY, f64::max);
        let base_m = (low_m + layer_m * layer as f64).max(ground_m + ABOVE_GROUND_M);
        let top_m = low_m + layer_m * (layer + 1) as f64;
        let is_above = top_m > base_m + 0.1 || count == 1.0;
        is_above.then(|| OrientedBox::from_corners(low.extend(base_m), high.extend(top_m.max(base_m + 0.2))))
    });
    joined(boxes.collect())
}

/// Neighbouring boxes of a crown as one where that fills little more, the best fit first.
fn joined(mut boxes: Vec<OrientedBox>) -> Vec<OrientedBox> {
    let volume_m3 = |one: &OrientedBox| 8.0 * one.half_extents_m.element_product();
    loop {
        let both = boxes.windows(2).enumerate().map(|(lower, pair)| {
            let whole = around(&pair[0], &pair[1]);
            (lower, volume_m3(&pair[0]) + volume_m3(&pair[1]), whole)
        });
        let fits = both.map(|(lower, filled_m3, whole)| (filled_m3 / volume_m3(&whole).max(1e-9), lower, whole));
        let best = fits.filter(|(share, ..)| *share >= LEAST_FILLED).max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, lower, whole)) = best else { return boxes };
        boxes[lower] = whole;
        boxes.remove(lower + 1);
    }
}

fn around(a: &OrientedBox, b: &OrientedBox) -> OrientedBox {
    let ((a_low, a_high), (b_low, b_high)) = (a.bounds_in_world(), b.bounds_in_world());
    OrientedBox::from_corners(a_low.min(b_low), a_high.max(b_high))
}

/// A trunk under the lowest box of a crown that hangs; it reaches a little into the crown.
fn trunk(survey: &Survey<'_>, lowest: &OrientedBox, height_m: f64) -> Option<OrientedBox> {
    let middle = lowest.center_in_world.truncate();
    let foot_m = survey.relief.height_m(middle);
    let top_m = lowest.center_in_world.z;
    let half_m = (TRUNK_SHARE * height_m).clamp(TRUNK_M[0], TRUNK_M[1]);
    let corners = || (middle - half_m).extend(foot_m - 0.1);
    (top_m > foot_m + 0.5).then(|| OrientedBox::from_corners(corners(), (middle + half_m).extend(top_m)))
}

/// Sums over the points of a layer, from its first one.
#[derive(Clone, Copy, Default)]
struct Extent {
    first: DVec2,
    low: DVec2,
    high: DVec2,
    sum: DVec2,
    squares: DVec2,
    count: f64,
}

impl Extent {
    fn add(&mut self, point: DVec2) {
        if self.count == 0.0 {
            *self = Self { first: point, low: point, high: point, ..Self::default() };
        }
        let from_first = point - self.first;
        (self.low, self.high) = (self.low.min(point), self.high.max(point));
        self.sum += from_first;
        self.squares += from_first * from_first;
        self.count += 1.0;
    }

    /// Bounds without far twigs; at least `narrowest_m` on each side of the middle.
    fn bounds(&self, narrowest_m: f64) -> (DVec2, DVec2) {
        let mean = self.sum / self.count;
        let deviation = (self.squares / self.count - mean * mean).max(DVec2::ZERO).map(f64::sqrt);
        let middle = self.first + mean;
        let reach = DEVIATIONS * deviation;
        let (low, high) = (self.low.max(middle - reach), self.high.min(middle + reach));
        (low.min(middle - narrowest_m), high.max(middle + narrowest_m))
    }
}
