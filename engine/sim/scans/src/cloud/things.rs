//! Things that are neither building nor plant: cars, walls, masts, bridges, as boxes around their points.

use super::class;
use super::numbers::next_id;
use super::survey::{Survey, is_ground, plan_of};
use crate::grid::{Grid, parts};
use crate::plan::{convex_hull, smallest_rectangle_rad};
use crate::solid_cells::{BoxCover, boxes_of};
use crate::window_cover::{Bases, Column, Volumes};
use cosfly_domain::{Obstacle, ObstacleKind};
use rayon::prelude::*;

/// Lower points are kerbs and litter, metres.
const LOWEST_M: f64 = 0.4;
/// Fewer points are no thing.
const LEAST_POINTS: usize = 4;
/// Distance of a thing above ground that was seen in its cell, metres.
const ABOVE_GROUND_M: f64 = 0.15;
/// A thing whose lowest point is closer to the ground stands on it, metres.
const STANDS_M: f64 = 1.0;
/// Points of a tall thing are spread over its height; gaps wider than this part it from what hangs above, metres.
const THINNEST_M: f64 = 0.2;

/// Adds all things.
pub fn add(survey: &Survey<'_>, obstacles: &mut Vec<Obstacle>) -> Volumes {
    let mut volumes = Volumes::default();
    for (kind, belongs) in [
        (ObstacleKind::Bridge, (|class| class == class::BRIDGE) as fn(u8) -> bool),
        (ObstacleKind::Static, |class| {
            !is_ground(class) && !class::PLANTS.contains(&class) && !matches!(class, class::BUILDING | class::BRIDGE)
        }),
    ] {
        volumes = volumes.plus(add_kind(survey, kind, belongs, obstacles), 1.0);
    }
    volumes
}

fn add_kind(
    survey: &Survey<'_>,
    kind: ObstacleKind,
    belongs: fn(u8) -> bool,
    obstacles: &mut Vec<Obstacle>,
) -> Volumes {
    let (grid, cloud) = (&survey.grid, survey.cloud);
    if !cloud.classes.par_iter().any(|class| belongs(*class)) {
        return Volumes::default();
    }
    let is_of_thing = |point: &usize| belongs(cloud.classes[*point]) && survey.height_m(*point) > LOWEST_M;
    let has_thing: Vec<bool> =
        (0..grid.cells()).into_par_iter().map(|cell| survey.points_of(cell).any(|point| is_of_thing(&point))).collect();
    let (part, count) = parts(grid, |cell| has_thing[cell]);
    let mut things = vec![Thing::default(); count as usize];
    for (cell, number) in part.iter().enumerate().filter(|(_, number)| **number != 0) {
        let thing = &mut things[*number as usize - 1];
        thing.points.extend(survey.points_of(cell).filter(is_of_thing));
        thing.ground.extend(survey.points_of(cell).filter(|point| is_ground(cloud.classes[*point])));
    }
    let is_large = |thing: &Thing| thing.points.len() >= LEAST_POINTS;
    let cover = |thing: &Thing| if is_large(thing) { thing.cover(survey) } else { BoxCover::default() };
    let covers: Vec<BoxCover> = things.par_iter().map(cover).collect();
    let first_id = next_id(obstacles);
    let mut volumes = Volumes::default();
    for (number, cover) in covers.into_iter().enumerate() {
        volumes = volumes.plus(cover.volumes, 1.0);
        let object_id = first_id + number as u32;
        let obstacle = |shape| Obstacle { shape, kind, object_id, synthetic: false };
        obstacles.extend(cover.shapes.into_iter().map(obstacle));
    }
    volumes
}

/// One thing: the points on it, and those of the ground in its cells.
#[derive(Clone, Default)]
struct Thing {
    points: Vec<usize>,
    ground: Vec<usize>,
}

impl Thing {
    /// Boxes around its points, along the map or along the thing, as takes fewer: a wall is one box, no flight of steps.
    fn cover(&self, survey: &Survey<'_>) -> BoxCover {
        let along = |yaw_rad| {
            let grid = Grid::flush(plan_of(survey.cloud, &self.points), survey.grid.cell_m, yaw_rad);
            boxes_of(&grid, &self.columns(survey, &grid), survey.step_m, Bases::Highest, |_| false)
        };
        let by_map = along(0.0);
        if by_map.shapes.len() < 2 {
            return by_map;
        }
        let by_thing = along(smallest_rectangle_rad(&convex_hull(plan_of(survey.cloud, &self.points).collect())));
        if by_thing.shapes.len() < by_map.shapes.len() { by_thing } else { by_map }
    }

    /// Columns of the points over each cell of a grid.
    fn columns(&self, survey: &Survey<'_>, grid: &Grid) -> Vec<Option<Column>> {
        let place = |point: &usize| (grid.cell_of(survey.cloud.point(*point).truncate()), survey.cloud.point(*point).z);
        let mut columns: Vec<Option<Column>> = vec![None; grid.cells()];
        for (cell, z) in self.points.iter().map(place) {
            let column = columns[cell].get_or_insert(Column { base_m: z, top_m: z });
            *column = Column { base_m: column.base_m.min(z), top_m: column.top_m.max(z) };
        }
        let mut ground_m = vec![f64::NEG_INFINITY; grid.cells()];
        for (cell, z) in self.ground.iter().map(place) {
            ground_m[cell] = ground_m[cell].max(z);
        }
        for (cell, column) in columns.iter_mut().enumerate() {
            let Some(column) = column else { continue };
            let foot_m = survey.relief.height_m(grid.center(cell));
            let lowest_m = foot_m.max(ground_m[cell]) + ABOVE_GROUND_M;
            let stands = column.base_m - foot_m < STANDS_M;
            column.base_m = if stands { lowest_m } else { (column.base_m - THINNEST_M).max(lowest_m) };
            column.top_m = column.top_m.max(column.base_m + THINNEST_M);
        }
        columns
    }
}
