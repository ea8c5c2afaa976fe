//! Open ground as walkable plazas: what no obstacle stands on, of usable slope, in rectangles that follow the relief.

use crate::grid::Grid;
use crate::relief::Relief;
use cosfly_frames::{DVec2, DVec3};
use cosfly_geometry::OrientedBox;
use cosfly_town::{Obstacle, WalkableKind, WalkablePolygon};
use rayon::prelude::*;

/// Narrowest cells, metres.
const NARROWEST_CELL_M: f64 = 1.0;
/// Most cells.
const MOST_CELLS: f64 = 4e6;
/// Obstacles that begin higher above the ground leave room for a person, metres.
const HEADROOM_M: f64 = 2.2;
/// Steepest ground to walk on, rise over run.
const STEEPEST: f64 = 0.35;
/// Longest side of a plaza, metres; the relief bends within it by at most [`MOST_BEND_M`].
const LONGEST_M: f64 = 24.0;
/// Largest distance of the ground from a plaza, metres.
const MOST_BEND_M: f64 = 0.25;
/// Largest gap in the measured ground that counts as ground, metres.
const NEAR_MEASURED_M: f64 = 3.0;

/// Plazas on the measured ground between the obstacles, synthetic.
pub fn open_ground(obstacles: &[Obstacle], relief: &Relief) -> Vec<WalkablePolygon> {
    let across = relief.grid.point(DVec2::ZERO);
    let opposite = relief.grid.point(DVec2::new(relief.grid.columns as f64, relief.grid.rows as f64));
    let size = (opposite - across).abs();
    let cell_m = NARROWEST_CELL_M.max((size.element_product() / MOST_CELLS).sqrt());
    let grid = Grid::around([across, opposite].into_iter(), cell_m, 0.0);
    let mut is_open: Vec<bool> =
        (0..grid.cells()).into_par_iter().map(|cell| is_ground(relief, grid.center(cell), cell_m)).collect();
    for obstacle in obstacles {
        close_under(&grid, relief, &obstacle.shape, &mut is_open);
    }
    let mut plazas = Vec::new();
    for first in 0..grid.cells() {
        if is_open[first] {
            plazas.extend(plaza(&grid, relief, first, &mut is_open));
        }
    }
    plazas
}

/// Whether the ground at a place was measured nearby and is not too steep.
fn is_ground(relief: &Relief, at: DVec2, cell_m: f64) -> bool {
    let reach = (NEAR_MEASURED_M / relief.grid.cell_m).ceil() as usize;
    let in_cells = relief.grid.in_cells(at);
    let is_inside = in_cells.cmpge(DVec2::ZERO).all()
        && in_cells.x < relief.grid.columns as f64
        && in_cells.y < relief.grid.rows as f64;
    let is_measured = || relief.grid.around_cell(relief.grid.cell_of(at), reach).any(|cell| relief.is_measured[cell]);
    let rise = |axis: DVec2| relief.height_m(at + cell_m * axis) - relief.height_m(at - cell_m * axis);
    is_inside && is_measured() && DVec2::new(rise(DVec2::X), rise(DVec2::Y)).length() <= 2.0 * cell_m * STEEPEST
}

/// Closes the cells that an obstacle stands on.
fn close_under(grid: &Grid, relief: &Relief, shape: &OrientedBox, is_open: &mut [bool]) {
    let (low, high) = shape.bounds_in_world();
    let margin = DVec2::splat(0.5 * grid.cell_m);
    let from = (grid.in_cells(low.truncate() - margin)).max(DVec2::ZERO);
    let to = grid.in_cells(high.truncate() + margin).min(DVec2::new(grid.columns as f64, grid.rows as f64) - 1.0);
    if to.cmplt(DVec2::ZERO).any() {
        return;
    }
    let axis = DVec2::new(cosfly_frames::real::cos(shape.yaw_rad), cosfly_frames::real::sin(shape.yaw_rad));
    for row in from.y as usize..=to.y as usize {
        for column in from.x as usize..=to.x as usize {
            let cell = row * grid.columns + column;
            let at = grid.center(cell);
            let away = at - shape.center_in_world.truncate();
            let local = DVec2::new(away.dot(axis), away.dot(axis.perp())).abs();
            let touches = local.cmple(shape.half_extents_m.truncate() + margin).all();
            let ground_m = relief.height_m(at);
            if touches && low.z < ground_m + HEADROOM_M && high.z > ground_m + 0.1 {
                is_open[cell] = false;
            }
        }
    }
}

/// A plaza from a cell on, grown as long as the ground is open and nearly plane. Takes its cells.
fn plaza(grid: &Grid, relief: &Relief, first: usize, is_open: &mut [bool]) -> Option<WalkablePolygon> {
    let (column, row) = (first % grid.columns, first / grid.columns);
    let most = (LONGEST_M / grid.cell_m).floor().max(1.0) as usize;
    let (mut width, mut height) = (1, 1);
    let corner = |x: usize, y: usize| relief.on_ground(grid.point(DVec2::new((column + x) as f64, (row + y) as f64)));
    let mut grows = [true; 2];
    // By turns to both sides, so that plazas become wide rather than long.
    while grows != [false; 2] {
        if grows[0] {
            grows[0] = width < most
                && column + width < grid.columns
                && (0..height).all(|line| is_open[first + width + line * grid.columns])
                && is_plane(grid, relief, column, row, [width + 1, height]);
            width += usize::from(grows[0]);
        }
        if grows[1] {
            grows[1] = height < most
                && row + height < grid.rows
                && is_open[first + height * grid.columns..][..width].iter().all(|open| *open)
                && is_plane(grid, relief, column, row, [width, height + 1]);
            height += usize::from(grows[1]);
        }
    }
    for line in 0..height {
        is_open[first + line * grid.columns..][..width].fill(false);
    }
    let outline_in_world: Vec<DVec3> = vec![corner(0, 0), corner(width, 0), corner(width, height), corner(0, height)];
    Some(WalkablePolygon { kind: WalkableKind::Plaza, outline_in_world, synthetic: true })
}

/// Whether the ground bends little between the corners of a rectangle of cells.
fn is_plane(grid: &Grid, relief: &Relief, column: usize, row: usize, [width, height]: [usize; 2]) -> bool {
    let at = |x: f64, y: f64| {
        relief.height_m(grid.point(DVec2::new(column as f64 + x * width as f64, row as f64 + y * height as f64)))
    };
    let [low, right, left, high] = [at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0), at(1.0, 1.0)];
    let between = |x: f64, y: f64| (low * (1.0 - x) + right * x) * (1.0 - y) + (left * (1.0 - x) + high * x) * y;
    [(0.5, 0.5), (0.5, 0.0), (0.5, 1.0), (0.0, 0.5), (1.0, 0.5)]
        .into_iter()
        .all(|(x, y)| (at(x, y) - between(x, y)).abs() <= MOST_BEND_M)
}
