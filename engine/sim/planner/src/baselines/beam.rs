//! A layered beam search in the manner of Track A* (arXiv 2605.05338): the same voxels and costs, but one layer at a
//! time, of which only the cheapest nodes live on.
//!
//! The authors name three devices: distances kept across time, a beam per layer, rays cast by configuration. All
//! three are here; what they do not print (the width) is ours.

use super::clearance_cache::{ClearanceCache, move_is_free};
use super::grid::{Cell, MOVES, VoxelGrid};
use super::input::BaselinePath;
use super::sight::StaticSight;
use crate::error::PlanError;

/// Nodes per layer that live on: as few as lose no visibility against A* in streets.
pub const WIDTH: usize = 4096;
/// Marks a voxel that no node of the layer stands for yet.
const NONE: u32 = u32::MAX;

/// A living node: where it is, what it cost so far, who it came from.
#[derive(Clone, Copy)]
struct Node {
    cell: Cell,
    cost: f32,
    /// Index in the layer before.
    parent: u32,
}

/// A cheap way through the grid that keeps `keep_m` from obstacles.
pub fn beam(
    grid: &VoxelGrid<'_>,
    sight: &impl StaticSight,
    keep_m: f64,
    influence_m: f64,
    width: usize,
) -> Result<BaselinePath, PlanError> {
    let mut clearance = ClearanceCache::new(grid, influence_m.max(keep_m));
    let mut slots = vec![NONE; grid.cells_per_layer()];
    let mut layers: Vec<Vec<Node>> = Vec::with_capacity(grid.layers.len());
    let first = (0..grid.cells_per_layer()).filter_map(|node| {
        let cell = grid.cell_of(node);
        Some(Node { cell, cost: grid.bare_cost(cell)?, parent: 0 })
    });
    let mut reached: Vec<Node> = first.collect();
    let mut nodes_expanded = 0;
    for layer in 0..grid.layers.len() {
        let alive = survivors(grid, sight, &mut clearance, keep_m, reached, width);
        if alive.is_empty() {
            let frame = grid.layers[layer].frame;
            return Err(PlanError::NoWay(format!("no free voxel of the beam was left at frame {frame}")));
        }
        nodes_expanded += alive.len() as u64;
        reached = successors(grid, sight, &mut clearance, keep_m, &alive, &mut slots);
        layers.push(alive);
    }
    let way = cheapest_way(&layers);
    let cost = layers.last().and_then(|alive| alive.iter().map(|node| node.cost).min_by(f32::total_cmp));
    Ok(BaselinePath { waypoints: grid.waypoints(&way), nodes_expanded, cost: f64::from(cost.unwrap_or(0.0)) })
}

/// Casts the rays of the promising nodes and keeps the `width` cheapest. Costs without rays are lower bounds, so
/// nodes are looked at by rising bound until no other can be among the cheapest.
fn survivors(
    grid: &VoxelGrid<'_>,
    sight: &impl StaticSight,
    clearance: &mut ClearanceCache,
    keep_m: f64,
    mut reached: Vec<Node>,
    width: usize,
) -> Vec<Node> {
    reached.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let mut alive: Vec<Node> = Vec::with_capacity(2 * width);
    let mut bar = f32::INFINITY;
    for mut node in reached {
        if node.cost >= bar {
            break;
        }
        let distance_m = clearance.distance_m(grid, node.cell, sight);
        if distance_m < keep_m {
            continue;
        }
        let seen = grid.visible_points(node.cell, sight);
        node.cost += grid.obstacle_cost(node.cell.layer, distance_m, seen);
        alive.push(node);
        if alive.len() == 2 * width {
            bar = prune(&mut alive, width);
        }
    }
    prune(&mut alive, width);
    alive
}

/// Keeps the `width` cheapest and returns the cost of the dearest of them.
fn prune(alive: &mut Vec<Node>, width: usize) -> f32 {
    if alive.len() > width {
        alive.select_nth_unstable_by(width - 1, |a, b| a.cost.total_cmp(&b.cost));
        alive.truncate(width);
        return alive[width - 1].cost;
    }
    f32::INFINITY
}

/// The cells that the living nodes' moves lead to, each with its cheapest arrival; then their bare costs.
fn successors(
    grid: &VoxelGrid<'_>,
    sight: &impl StaticSight,
    clearance: &mut ClearanceCache,
    keep_m: f64,
    alive: &[Node],
    slots: &mut [u32],
) -> Vec<Node> {
    let mut reached: Vec<Node> = Vec::new();
    for (parent, node) in alive.iter().enumerate() {
        for m in 0..MOVES {
            let Some(cell) = grid.moved(node.cell, m) else { continue };
            let slot = &mut slots[grid.node_of(Cell { layer: 0, ..cell })];
            let arrival = node.cost + grid.move_cost[m];
            if *slot != NONE && arrival >= reached[*slot as usize].cost {
                continue;
            }
            if !move_is_free(clearance, grid, sight, (node.cell, cell), grid.move_m[m], keep_m) {
                continue;
            }
            let found = Node { cell, cost: arrival, parent: parent as u32 };
            if *slot == NONE {
                *slot = reached.len() as u32;
                reached.push(found);
            } else {
                reached[*slot as usize] = found;
            }
        }
    }
    reached.retain_mut(|node| {
        slots[grid.node_of(Cell { layer: 0, ..node.cell })] = NONE;
        let bare = grid.bare_cost(node.cell);
        node.cost += bare.unwrap_or(0.0);
        bare.is_some()
    });
    reached
}

fn cheapest_way(layers: &[Vec<Node>]) -> Vec<Cell> {
    let Some(last) = layers.last() else { return Vec::new() };
    let Some(mut at) = (0..last.len()).min_by(|&a, &b| last[a].cost.total_cmp(&last[b].cost)) else {
        return Vec::new();
    };
    let mut way = Vec::with_capacity(layers.len());
    for alive in layers.iter().rev() {
        way.push(alive[at].cell);
        at = alive[at].parent as usize;
    }
    way.reverse();
    way
}
