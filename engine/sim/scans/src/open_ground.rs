//! Open ground of measured scenes: where the ground was measured nearby and is not too steep.

use crate::relief::Relief;
use cosfly_domain::{Obstacle, WalkablePolygon};
use cosfly_frames::DVec2;
use cosfly_town::open_ground::{OpenGround, STEEPEST};
use rayon::prelude::*;

/// Narrowest cells, metres.
const NARROWEST_CELL_M: f64 = 1.0;
/// Largest gap in the measured ground that counts as ground, metres.
const NEAR_MEASURED_M: f64 = 3.0;

/// Plazas on the measured ground between the obstacles, synthetic.
pub fn open_ground(obstacles: &[Obstacle], relief: &Relief) -> Vec<WalkablePolygon> {
    let low = relief.grid.point(DVec2::ZERO);
    let high = relief.grid.point(DVec2::new(relief.grid.columns as f64, relief.grid.rows as f64));
    let mut open = OpenGround::new(low, high, NARROWEST_CELL_M);
    let is_ground = |cell: usize| is_ground(relief, open.middle(cell), open.cell_m);
    open.is_open = (0..open.is_open.len()).into_par_iter().map(is_ground).collect();
    let ground_m = |at: DVec2| Some(relief.height_m(at));
    for obstacle in obstacles {
        open.close_under(obstacle, &ground_m);
    }
    open.plazas(&ground_m)
}

/// Whether the ground at a place was measured nearby and is not too steep.
fn is_ground(relief: &Relief, at: DVec2, cell_m: f64) -> bool {
    let reach = (NEAR_MEASURED_M / relief.grid.cell_m).ceil() as usize;
    let is_measured = || relief.grid.around_cell(relief.grid.cell_of(at), reach).any(|cell| relief.is_measured[cell]);
    let rise = |axis: DVec2| relief.height_m(at + cell_m * axis) - relief.height_m(at - cell_m * axis);
    is_measured() && DVec2::new(rise(DVec2::X), rise(DVec2::Y)).length() <= 2.0 * cell_m * STEEPEST
}
