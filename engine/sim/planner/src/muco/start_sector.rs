//! The sector behind the walker in which flights start (paper, algorithm 2: within 60 degrees of the rear).

use super::lattice::Lattice;
use crate::config::view::ViewConfig;
use crate::problem::Problem;
use cosfly_frames::{DVec2, DVec3, real};
use cosfly_surroundings::solid::HalfSpace;

/// Cost of a first viewpoint outside the sector: more than hiding for many frames, so that only closed viewpoints lead out.
const OUTSIDE: f32 = 1e5;
/// The first viewpoint is this much within the sector, so that refinement does not press against its sides, degrees.
const MARGIN_DEG: f64 = 5.0;
/// The sides that refinement and smoothing keep are this much within it, degrees.
const SIDE_MARGIN_DEG: f64 = 1.0;

/// Direction of the walk at the first frame; `None` where the target stands, or every side is allowed.
fn walk(problem: &Problem<'_>, view: &ViewConfig) -> Option<DVec2> {
    problem.walk.direction.first().copied().filter(|it| it.length_squared() > 0.5 && view.start_sector_deg < 180.0)
}

/// Costs of the first layer's nodes when no start is given; empty where every side is allowed.
pub(super) fn costs(problem: &Problem<'_>, lattice: &Lattice) -> Vec<f32> {
    let Some(walks) = walk(problem, problem.view) else { return Vec::new() };
    let sector = real::cos((problem.view.start_sector_deg - MARGIN_DEG).max(0.0).to_radians());
    let outside = |direction: &DVec3| -direction.truncate().dot(walks) < sector - 1e-9;
    let by_azimuth: Vec<f32> = lattice.directions.iter().map(|it| if outside(it) { OUTSIDE } else { 0.0 }).collect();
    (0..lattice.nodes()).map(|node| by_azimuth[lattice.split(node).0]).collect()
}

/// Sides of the sector at the first frame, for flights whose start `first` is chosen and lies within; none for sectors that
/// are no wedge.
pub(super) fn sides(problem: &Problem<'_>, view: &ViewConfig, first: DVec3) -> Vec<HalfSpace> {
    let Some(walks) = walk(problem, view).filter(|_| view.start_sector_deg < 90.0) else { return Vec::new() };
    let feet = problem.track.states[0].feet_in_world;
    let turn_rad = 0.5 * real::PI - (view.start_sector_deg - SIDE_MARGIN_DEG).to_radians();
    let side = |turn_rad: f64| {
        let (sin, cos) = real::sin_cos(turn_rad);
        let normal = DVec2::new(cos, sin).rotate(-walks).extend(0.0);
        HalfSpace { normal, offset_m: normal.dot(feet) }
    };
    let sides = [side(turn_rad), side(-turn_rad)];
    if sides.iter().all(|side| side.slack_m(first) >= 0.0) { sides.to_vec() } else { Vec::new() }
}
