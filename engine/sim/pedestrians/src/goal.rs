//! Starts and goals: pieces of ground with room, places on them, and the next goal of a walk.

use crate::{PedestrianError, WalkableGrid};
use cosfly_domain::WalkableKind;
use cosfly_frames::{DVec2, RandomStream, real};

/// Longest straight distance to the next goal, metres: bounds the work of one search.
pub(crate) const LONGEST_LEG_M: f64 = 120.0;

/// Largest angle between the direction of the walk so far and that to the next goal, radians.
const AHEAD_RAD: f64 = 1.9;

/// Straight distances between the turns of restless people, metres; smoothing takes about a metre of each.
const RESTLESS_LEG_M: [f64; 2] = [3.0, 6.0];

/// Nodes of the route that tell restless people where they came from, and the longest way to their next turn, metres of
/// pavement.
pub(crate) const TURN_NODES: usize = 4;
pub(crate) const LONGEST_TURN_M: f32 = 20.0;

/// Largest angle between the way back and the next direction of restless people, radians.
const ABOUT_RAD: f64 = 1.7;

/// Attempts to find a start, or a goal that a route leads to.
pub(crate) const GOAL_ATTEMPTS: usize = 48;

/// Numbers of the connected pieces of ground that are at least so far across.
///
/// # Errors
/// When there is none.
pub(crate) fn roomy_pieces(grid: &WalkableGrid, min_route_m: f64) -> Result<Vec<u32>, PedestrianError> {
    let roomy: Vec<u32> = (0..grid.components.len() as u32)
        .filter(|&piece| grid.components[piece as usize].extent_m >= min_route_m)
        .collect();
    if roomy.iter().all(|piece| grid.components[*piece as usize].nodes.is_empty()) {
        let largest_m = grid.components.iter().map(|piece| piece.extent_m).fold(0.0, f64::max);
        return Err(PedestrianError::NoRoom { largest_m, min_route_m });
    }
    let roomy: Vec<u32> = roomy.into_iter().filter(|piece| grid.components[*piece as usize].weight > 0.0).collect();
    if roomy.is_empty() {
        return Err(PedestrianError::NoWeight);
    }
    Ok(roomy)
}

/// Piece and node of a start. Every square metre is as likely as any other; crossings and carriageways only when nothing
/// else is drawn.
pub(crate) fn draw_start(grid: &WalkableGrid, roomy: &[u32], stream: &mut RandomStream) -> (u32, u32) {
    let size = |piece: &u32| grid.components[*piece as usize].nodes.len();
    let total: usize = roomy.iter().map(size).sum();
    let mut start = (0, 0);
    for _ in 0..GOAL_ATTEMPTS {
        if grid.is_weighted() {
            start = draw_by_weight(grid, roomy, stream);
            if is_goal(grid, start.1) {
                break;
            }
            continue;
        }
        let mut place = stream.index(total);
        for piece in roomy {
            if place < size(piece) {
                start = (*piece, grid.components[*piece as usize].nodes[place]);
                break;
            }
            place -= size(piece);
        }
        if is_goal(grid, start.1) {
            break;
        }
    }
    start
}

/// A node about `leg_m` from the node `here`, ahead at first, nearer and anywhere later; at last any node of the piece.
/// `before` is a node behind, which says where ahead is.
pub(crate) fn draw_goal(
    grid: &WalkableGrid,
    piece: u32,
    (here, before): (u32, Option<u32>),
    leg_m: f64,
    attempt: usize,
    stream: &mut RandomStream,
) -> Option<u32> {
    let center = grid.center(here);
    let late = attempt as f64 / GOAL_ATTEMPTS as f64;
    if late > 0.8 {
        let nodes = &grid.components[piece as usize].nodes;
        let node = if grid.is_weighted() {
            draw_by_weight(grid, &[piece], stream).1
        } else {
            nodes[stream.index(nodes.len())]
        };
        let apart_m = (grid.center(node) - center).length();
        return (node != here && apart_m <= 2.0 * LONGEST_LEG_M).then_some(node);
    }
    let distance_m = leg_m * stream.uniform(0.5, 1.0) * (1.0 - late);
    let turn = stream.uniform(-1.0, 1.0);
    let angle = match before {
        Some(before) if late < 0.5 => {
            let came = center - grid.center(before);
            real::atan2(came.y, came.x) + AHEAD_RAD * turn
        }
        _ => real::PI * turn,
    };
    let (sin, cos) = real::sin_cos(angle);
    let node = grid.node_near(center + distance_m * DVec2::new(cos, sin), piece, 10)?;
    let apart_m = (grid.center(node) - center).length();
    (is_goal(grid, node) && apart_m > 0.25 * distance_m && node != here && is_drawn(grid, node, stream)).then_some(node)
}

/// A node a few metres from the node `here`, where restless people turn to: to the sides or back towards `before`.
pub(crate) fn draw_turn(
    grid: &WalkableGrid,
    piece: u32,
    (here, before): (u32, Option<u32>),
    stream: &mut RandomStream,
) -> Option<u32> {
    let center = grid.center(here);
    let back = before.map_or(DVec2::X, |before| grid.center(before) - center);
    let angle = real::atan2(back.y, back.x) + ABOUT_RAD * stream.uniform(-1.0, 1.0);
    let distance_m = stream.uniform(RESTLESS_LEG_M[0], RESTLESS_LEG_M[1]);
    let (sin, cos) = real::sin_cos(angle);
    let way = distance_m * DVec2::new(cos, sin);
    let node = grid.node_near(center + way, piece, 10)?;
    let taken = grid.center(node) - center;
    (is_goal(grid, node)
        && grid.weight(node) > 0.0
        && taken.length() > 0.5 * RESTLESS_LEG_M[0]
        && taken.dot(back) > -0.3 * taken.length() * back.length())
    .then_some(node)
}

/// Piece and node, each square metre as likely as its weight says.
fn draw_by_weight(grid: &WalkableGrid, pieces: &[u32], stream: &mut RandomStream) -> (u32, u32) {
    let total: f64 = pieces.iter().map(|piece| grid.components[*piece as usize].weight).sum();
    let mut left = total * stream.unit();
    let mut last = (0, 0);
    for piece in pieces {
        let own = &grid.components[*piece as usize];
        if left >= own.weight {
            left -= own.weight;
            continue;
        }
        for &node in &own.nodes {
            let weight = grid.weight(node);
            if weight > 0.0 {
                last = (*piece, node);
                left -= weight;
            }
            if left < 0.0 {
                return last;
            }
        }
    }
    last
}

/// Whether the weight of a node lets it be a goal; draws a number where weights differ.
fn is_drawn(grid: &WalkableGrid, node: u32, stream: &mut RandomStream) -> bool {
    !grid.is_weighted() || stream.unit() < grid.weight(node)
}

/// Whether a walk may start or choose a new goal here.
fn is_goal(grid: &WalkableGrid, node: u32) -> bool {
    !matches!(grid.nodes[node as usize].kind, WalkableKind::Crossing | WalkableKind::Road)
}
