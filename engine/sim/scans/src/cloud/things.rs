//! Things that are neither building nor plant: cars, walls, masts, bridges, as boxes around the points of each cell.

use super::class;
use super::numbers::next_id;
use super::survey::{Survey, is_ground};
use crate::grid::parts;
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

/// Column of points over a cell that `belongs` accepts, and their number.
fn column(survey: &Survey<'_>, cell: usize, belongs: fn(u8) -> bool) -> (Option<Column>, usize) {
    let (mut ground_m, mut ends, mut count) = (f64::NEG_INFINITY, [f64::INFINITY, f64::NEG_INFINITY], 0);
    for point in survey.points_of(cell) {
        let at = survey.cloud.point(point);
        if is_ground(survey.cloud.classes[point]) {
            ground_m = ground_m.max(at.z);
        } else if belongs(survey.cloud.classes[point]) && survey.height_m(point) > LOWEST_M {
            ends = [ends[0].min(at.z), ends[1].max(at.z)];
            count += 1;
        }
    }
    if count == 0 {
        return (None, 0);
    }
    let foot_m = survey.relief.height_m(survey.grid.center(cell));
    let lowest_m = foot_m.max(ground_m) + ABOVE_GROUND_M;
    let base_m = if ends[0] - foot_m < STANDS_M { lowest_m } else { (ends[0] - THINNEST_M).max(lowest_m) };
    (Some(Column { base_m, top_m: ends[1].max(base_m + THINNEST_M) }), count)
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
    let columns = (0..grid.cells()).into_par_iter().map(|cell| column(survey, cell, belongs));
    let (mut columns, counts): (Vec<Option<Column>>, Vec<usize>) = columns.unzip();
    let (part, count) = parts(grid, |cell| columns[cell].is_some());
    let mut sizes = vec![0_usize; count as usize + 1];
    for (cell, number) in part.iter().enumerate() {
        sizes[*number as usize] += counts[cell];
    }
    for (cell, column) in columns.iter_mut().enumerate() {
        if sizes[part[cell] as usize] < LEAST_POINTS {
            *column = None;
        }
    }
    let first_id = next_id(obstacles);
    let BoxCover { shapes, volumes } = boxes_of(grid, &columns, survey.step_m, Bases::Highest, |_| false);
    let number = |shape: &cosfly_domain::OrientedBox| part[grid.cell_of(shape.center_in_world.truncate())];
    let mut numbered: Vec<_> = shapes.into_iter().map(|shape| (number(&shape), shape)).collect();
    numbered.sort_by_key(|(number, _)| *number);
    obstacles.extend(numbered.into_iter().map(|(number, shape)| Obstacle {
        shape,
        kind,
        object_id: first_id + number,
        synthetic: false,
    }));
    volumes
}
