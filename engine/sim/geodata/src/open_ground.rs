//! Open ground around obstacles as walkable plazas, for maps that know of buildings only.

use cosfly_domain::{Obstacle, SurfaceMesh, WalkablePolygon};
use cosfly_frames::DVec2;
use cosfly_town::GroundIndex;
use cosfly_town::open_ground::OpenGround;

/// Narrowest cells, metres.
const NARROWEST_CELL_M: f64 = 2.0;
/// Distance from obstacles within which the ground is walkable, metres.
const REACH_M: f64 = 20.0;
/// Widest ground that becomes plazas, metres: walks of a few hundred metres need no more, and grids over it stay small.
const WIDEST_M: f64 = 2000.0;
/// Cells in which obstacles are counted to find their densest part, and how many of them make the widest ground.
const COUNTED_M: f64 = 250.0;
const COUNTED: usize = (WIDEST_M / COUNTED_M) as usize;

/// Adds plazas, synthetic, on the ground of `surfaces` near the obstacles, in their densest part where they lie far
/// apart. Gives a note about them.
pub(crate) fn add_open_ground(
    walkable: &mut Vec<WalkablePolygon>,
    obstacles: &[Obstacle],
    surfaces: &[SurfaceMesh],
) -> String {
    let before = walkable.len();
    let (obstacles, is_part) = densest(obstacles);
    walkable.extend(plazas(&obstacles, surfaces));
    let part = if is_part { format!(", in the densest {WIDEST_M} m square of the map") } else { String::new() };
    format!(
        "{} plazas on the open ground around the buildings are invented{part}: the file has no ground for people to walk on",
        walkable.len() - before
    )
}

/// The obstacles in the square that holds most of them; whether some are left out.
fn densest(obstacles: &[Obstacle]) -> (Vec<&Obstacle>, bool) {
    let center = |obstacle: &Obstacle| obstacle.shape.center_in_world.truncate();
    let low = obstacles.iter().map(center).fold(DVec2::INFINITY, DVec2::min);
    let size = obstacles.iter().map(center).fold(DVec2::NEG_INFINITY, DVec2::max) - low;
    if obstacles.is_empty() || size.max_element() <= WIDEST_M || !size.is_finite() {
        return (obstacles.iter().collect(), false);
    }
    let [columns, rows] = size.to_array().map(|side_m| (side_m / COUNTED_M) as usize + 1);
    let cell = |obstacle: &Obstacle| ((center(obstacle) - low) / COUNTED_M).as_usizevec2().to_array();
    let mut counts = vec![0_usize; columns * rows];
    for [column, row] in obstacles.iter().map(cell) {
        counts[row * columns + column] += 1;
    }
    let within = |first: usize| {
        let (column, row) = (first % columns, first / columns);
        let rows = row..(row + COUNTED).min(rows);
        rows.map(|row| {
            counts[row * columns + column..row * columns + (column + COUNTED).min(columns)].iter().sum::<usize>()
        })
        .sum::<usize>()
    };
    // The first one of equals.
    let best = (0..counts.len()).rev().max_by_key(|first| within(*first)).unwrap_or(0);
    let (column, row) = (best % columns, best / columns);
    let is_inside = |obstacle: &&Obstacle| {
        let [x, y] = cell(obstacle);
        (column..column + COUNTED).contains(&x) && (row..row + COUNTED).contains(&y)
    };
    (obstacles.iter().filter(is_inside).collect(), true)
}

fn plazas(obstacles: &[&Obstacle], surfaces: &[SurfaceMesh]) -> Vec<WalkablePolygon> {
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for obstacle in obstacles {
        let (a, b) = obstacle.shape.bounds_in_world();
        (low, high) = (low.min(a.truncate()), high.max(b.truncate()));
    }
    if !(low.is_finite() && high.is_finite()) {
        return Vec::new();
    }
    let mut open = OpenGround::new(low - REACH_M, high + REACH_M, NARROWEST_CELL_M);
    obstacles.iter().for_each(|obstacle| open.open_near(&obstacle.shape, REACH_M));
    let ground = GroundIndex::of_surfaces(surfaces, |_| true);
    let ground_m = |at: DVec2| ground.ground_height_m(at.x, at.y);
    obstacles.iter().for_each(|obstacle| open.close_under(obstacle, &ground_m));
    open.plazas(&ground_m)
}
