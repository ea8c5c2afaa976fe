//! The paper's baseline: A* over voxels x timesteps, safety as a hard constraint (paper, section 3.4).
//!
//! The bound on the cost to go is 0: every term may vanish at every later frame, and no better bound is known without
//! casting the rays it would save. What a good implementation does is done: nodes in one dense array, a radix
//! queue, distances kept across timesteps, and rays cast only when a node is first taken from the queue
//! (its cost without them is a lower bound, so the order stays right).

use super::clearance_cache::{ClearanceCache, move_is_free};
use super::grid::{Cell, MOVES, VoxelGrid};
use super::input::BaselinePath;
use super::queue::RadixQueue;
use super::sight::StaticSight;
use crate::error::PlanError;

/// Node record: cost on arrival, cost of the node, [`Mark`]s and the move that led here. Zero means untouched.
type Record = [u32; 4];

const ARRIVAL: usize = 0;
const OWN: usize = 1;
const MARKS: usize = 2;
const MOVE: usize = 3;
/// The record has been filled in.
const TOUCHED: u32 = 1;
/// Rays have been cast.
const SEEN: u32 = 2;
/// Settled, or not allowed.
const CLOSED: u32 = 4;

struct Search<'a, S: StaticSight> {
    grid: &'a VoxelGrid<'a>,
    sight: &'a S,
    clearance: ClearanceCache,
    keep_m: f64,
    records: Vec<Record>,
    queue: RadixQueue,
    expanded: u64,
}

/// The cheapest way through the grid that keeps `keep_m` from obstacles, voxels and moves alike.
pub fn astar(
    grid: &VoxelGrid<'_>,
    sight: &impl StaticSight,
    keep_m: f64,
    influence_m: f64,
) -> Result<BaselinePath, PlanError> {
    let clearance = ClearanceCache::new(grid, influence_m.max(keep_m));
    let records = vec![[0; 4]; grid.nodes()];
    let mut search = Search { grid, sight, clearance, keep_m, records, queue: RadixQueue::default(), expanded: 0 };
    for node in 0..grid.cells_per_layer() {
        search.reach(grid.cell_of(node), 0.0, MOVES);
    }
    let last_layer = grid.layers.len() - 1;
    let mut deepest = 0;
    while let Some((cost, node)) = search.queue.pop() {
        let Some(cell) = search.settle(cost, node as usize) else { continue };
        deepest = deepest.max(cell.layer);
        if cell.layer == last_layer {
            let waypoints = grid.waypoints(&search.way_to(cell));
            return Ok(BaselinePath { waypoints, nodes_expanded: search.expanded, cost: f64::from(cost) });
        }
        search.expand(cell, cost);
    }
    let frame = grid.layers[deepest].frame;
    Err(PlanError::NoWay(format!("no free way of voxels leads beyond frame {frame}")))
}

impl<S: StaticSight> Search<'_, S> {
    /// Settles a node that came out of the queue, unless it is stale, not free, or dearer than it was thought.
    fn settle(&mut self, cost: f32, node: usize) -> Option<Cell> {
        let record = &mut self.records[node];
        let own = f32::from_bits(record[OWN]);
        if record[MARKS] & CLOSED != 0 || cost != f32::from_bits(record[ARRIVAL]) + own {
            return None;
        }
        let cell = self.grid.cell_of(node);
        if record[MARKS] & SEEN == 0 {
            let distance_m = self.clearance.distance_m(self.grid, cell, self.sight);
            if distance_m < self.keep_m {
                record[MARKS] |= CLOSED;
                return None;
            }
            let seen = self.grid.visible_points(cell, self.sight);
            let more = self.grid.obstacle_cost(cell.layer, distance_m, seen);
            record[MARKS] |= SEEN;
            if more > 0.0 {
                record[OWN] = (own + more).to_bits();
                self.queue.push(f32::from_bits(record[ARRIVAL]) + (own + more), node as u32);
                return None;
            }
        }
        record[MARKS] |= CLOSED;
        self.expanded += 1;
        Some(cell)
    }

    fn expand(&mut self, cell: Cell, cost: f32) {
        for m in 0..MOVES {
            let Some(next) = self.grid.moved(cell, m) else { continue };
            let record = self.records[self.grid.node_of(next)];
            let arrival = cost + self.grid.move_cost[m];
            let better = record[MARKS] & TOUCHED == 0 || arrival < f32::from_bits(record[ARRIVAL]);
            if record[MARKS] & CLOSED != 0 || !better {
                continue;
            }
            let length_m = self.grid.move_m[m];
            if move_is_free(&mut self.clearance, self.grid, self.sight, (cell, next), length_m, self.keep_m) {
                self.reach(next, arrival, m);
            }
        }
    }

    /// Records a cheaper arrival at a cell and queues it.
    fn reach(&mut self, cell: Cell, arrival: f32, m: usize) {
        let node = self.grid.node_of(cell);
        let record = &mut self.records[node];
        if record[MARKS] & TOUCHED == 0 {
            record[MARKS] |= TOUCHED;
            match self.grid.bare_cost(cell) {
                Some(bare) => record[OWN] = bare.to_bits(),
                None => record[MARKS] |= CLOSED,
            }
        }
        if record[MARKS] & CLOSED != 0 {
            return;
        }
        record[ARRIVAL] = arrival.to_bits();
        record[MOVE] = m as u32;
        self.queue.push(arrival + f32::from_bits(record[OWN]), node as u32);
    }

    /// The cells from the first layer to `cell`.
    fn way_to(&self, mut cell: Cell) -> Vec<Cell> {
        let mut way = vec![cell];
        while cell.layer > 0 {
            cell = self.grid.came_from(cell, self.records[self.grid.node_of(cell)][MOVE] as usize);
            way.push(cell);
        }
        way.reverse();
        way
    }
}
