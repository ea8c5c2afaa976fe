//! Things that are neither building nor plant: cars, walls, masts, bridges, as boxes around their points.

use super::class;
use super::houses::Houses;
use super::numbers::next_id;
use super::survey::{Survey, is_ground, plan_of};
use crate::grid::{Grid, parts};
use crate::plan::{convex_hull, smallest_rectangle_rad};
use crate::solid_cells::{BoxCover, boxes_of};
use crate::window_cover::{Bases, Column, Volumes};
use cosfly_domain::{Obstacle, ObstacleKind, OrientedBox};
use cosfly_frames::{DVec2, real};
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
/// One box is a whole thing where it holds at most so many times the space of its cells: a scan of a car has gaps.
const WHOLE: f64 = 2.5;
/// Cells around an unseen one that must be of a thing for its boxes to go over it.
const NOTCH: usize = 3;
/// Width and length of the largest vehicle that is told from undergrowth, and width of a wall, metres.
const VEHICLE_M: [f64; 2] = [2.8, 7.0];
const WALL_M: f64 = 1.2;
/// Cells of undergrowth, metres.
const UNDERGROWTH_CELL_M: f64 = 1.5;
/// Half width of a mast, metres.
const MAST_M: f64 = 0.06;
/// A thing on which one mast stands is at most so long; a longer one has a mast at each end, metres.
const ON_ONE_MAST_M: f64 = 6.0;

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
    let houses = Houses::of(obstacles);
    let mut volumes = Volumes::default();
    // Parts of houses have numbers of their own between: those of things rise apart.
    let first_id = next_id(obstacles);
    for (number, (thing, cover)) in things.iter().zip(covers).enumerate() {
        volumes = volumes.plus(cover.volumes, 1.0);
        let kind = if kind == ObstacleKind::Static && thing.is_undergrowth(survey) { ObstacleKind::Bush } else { kind };
        let hangs = kind == ObstacleKind::Static && thing.hangs(survey, &cover.shapes);
        let house = if hangs { houses.behind(&cover.shapes) } else { None };
        let (object_id, kind) = house.map_or((first_id + number as u32, kind), |house| (house, ObstacleKind::Building));
        let obstacle = |shape| Obstacle { shape, kind, object_id, synthetic: false };
        if hangs && house.is_none() && !thing.has_support(survey) {
            let mast = |shape| Obstacle { shape, kind: ObstacleKind::Pole, object_id, synthetic: true };
            obstacles.extend(masts(survey, &cover.shapes).map(mast));
        }
        obstacles.extend(cover.shapes.into_iter().map(obstacle));
    }
    volumes
}

/// A point in axes that are turned.
fn turned(at: DVec2, yaw_rad: f64) -> DVec2 {
    let (sin, cos) = real::sin_cos(yaw_rad);
    DVec2::new(cos * at.x + sin * at.y, cos * at.y - sin * at.x)
}

/// Lowest and highest places of points in axes that are turned.
fn turned_bounds(points: impl Iterator<Item = DVec2>, yaw_rad: f64) -> (DVec2, DVec2) {
    let all = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    points.map(|at| turned(at, yaw_rad)).fold(all, |(low, high), at| (low.min(at), high.max(at)))
}

/// Masts from the ground to a thing that hangs in the air: one below its middle, or one below each end of a long one.
fn masts<'a>(survey: &'a Survey<'_>, shapes: &'a [OrientedBox]) -> impl Iterator<Item = OrientedBox> + 'a {
    let place = |shape: &OrientedBox| shape.center_in_world.truncate();
    let middle = shapes.iter().map(place).sum::<DVec2>() / shapes.len().max(1) as f64;
    let away = |from: DVec2| move |shape: &&OrientedBox| place(shape).distance(from);
    let by =
        |from: DVec2, sign: f64| shapes.iter().max_by(|a, b| (sign * away(from)(a)).total_cmp(&(sign * away(from)(b))));
    let one_end = by(middle, 1.0);
    let other_end = one_end.and_then(|end| by(place(end), 1.0));
    let ends = [one_end, other_end];
    let is_long = one_end.zip(other_end).is_some_and(|(a, b)| place(a).distance(place(b)) > ON_ONE_MAST_M);
    let under = if is_long { ends } else { [by(middle, -1.0), None] };
    under.into_iter().flatten().map(move |shape| {
        let at = place(shape);
        let foot = (at - MAST_M).extend(survey.relief.height_m(at) - ABOVE_GROUND_M);
        OrientedBox::from_corners(foot, (at + MAST_M).extend(shape.center_in_world.z))
    })
}

/// One thing: the points on it, and those of the ground in its cells.
#[derive(Clone, Default)]
struct Thing {
    points: Vec<usize>,
    ground: Vec<usize>,
}

impl Thing {
    /// Boxes around its points, along the map or along the thing, as takes fewer: a wall is one box, no flight of steps. One box where
    /// that holds little else.
    fn cover(&self, survey: &Survey<'_>) -> BoxCover {
        let cell_m = if self.is_undergrowth(survey) { UNDERGROWTH_CELL_M } else { 0.0 };
        let along = |yaw_rad| {
            let grid = Grid::flush(plan_of(survey.cloud, &self.points), survey.grid.cell_m.max(cell_m), yaw_rad);
            let columns = self.columns(survey, &grid);
            let is_unseen = |cell: usize| survey.points_of(survey.grid.cell_of(grid.center(cell))).is_empty();
            let beside = |cell: usize| grid.around_cell(cell, 1).filter(|near| columns[*near].is_some()).count();
            let is_free = |cell: usize| columns[cell].is_none() && beside(cell) >= NOTCH && is_unseen(cell);
            boxes_of(&grid, &columns, survey.step_m, Bases::Highest, is_free)
        };
        let by_map = along(0.0);
        if by_map.shapes.len() < 2 {
            return by_map;
        }
        let yaw_rad = smallest_rectangle_rad(&convex_hull(plan_of(survey.cloud, &self.points).collect()));
        let by_thing = along(yaw_rad);
        let fewer = if by_thing.shapes.len() < by_map.shapes.len() { by_thing } else { by_map };
        let whole = self.whole(survey, yaw_rad, &fewer.shapes);
        let whole_m3 = 8.0 * whole.half_extents_m.element_product();
        if whole_m3 > WHOLE * fewer.volumes.solid {
            return fewer;
        }
        let gained = (whole_m3 - fewer.volumes.solid).max(0.0);
        BoxCover { volumes: Volumes { gained, ..fewer.volumes }, shapes: vec![whole] }
    }

    /// One box around its points in plan, from the lowest foot to the highest top of its boxes.
    fn whole(&self, survey: &Survey<'_>, yaw_rad: f64, shapes: &[OrientedBox]) -> OrientedBox {
        let (low, high) = turned_bounds(plan_of(survey.cloud, &self.points), yaw_rad);
        let ends = shapes.iter().map(OrientedBox::bounds_in_world);
        let base_m = ends.clone().map(|(low, _)| low.z).fold(f64::INFINITY, f64::min);
        let top_m = ends.map(|(_, high)| high.z).fold(f64::NEG_INFINITY, f64::max);
        let middle = 0.5 * (low + high);
        let half = (0.5 * (high - low)).max(DVec2::splat(0.5 * THINNEST_M));
        OrientedBox {
            center_in_world: turned(middle, -yaw_rad).extend(0.5 * (base_m + top_m)),
            half_extents_m: half.extend(0.5 * (top_m - base_m)),
            yaw_rad,
        }
    }

    /// Whether it may be low plants: the cloud does not tell them, and it is larger than a vehicle and no wall.
    fn is_undergrowth(&self, survey: &Survey<'_>) -> bool {
        if survey.tells_plants {
            return false;
        }
        let hull = convex_hull(plan_of(survey.cloud, &self.points).collect());
        let (low, high) = turned_bounds(hull.iter().copied(), smallest_rectangle_rad(&hull));
        let (width_m, length_m) = ((high - low).min_element(), (high - low).max_element());
        width_m > VEHICLE_M[0] || width_m > WALL_M && length_m > VEHICLE_M[1]
    }

    /// Whether none of its boxes comes down to the ground.
    fn hangs(&self, survey: &Survey<'_>, shapes: &[OrientedBox]) -> bool {
        let above_m = |shape: &OrientedBox| {
            let at = shape.center_in_world;
            at.z - shape.half_extents_m.z - survey.relief.height_m(at.truncate())
        };
        !shapes.is_empty() && shapes.iter().all(|shape| above_m(shape) > STANDS_M - THINNEST_M)
    }

    /// Whether a building, a bridge or a plant is in its cells or beside them.
    fn has_support(&self, survey: &Survey<'_>) -> bool {
        let carries = |class: &u8| class::PLANTS.contains(class) || matches!(*class, class::BUILDING | class::BRIDGE);
        self.points.iter().any(|point| {
            let cell = survey.grid.cell_of(survey.cloud.point(*point).truncate());
            let mut near = survey.grid.around_cell(cell, 1);
            near.any(|near| survey.cloud.classes[survey.points_of(near)].iter().any(carries))
        })
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
