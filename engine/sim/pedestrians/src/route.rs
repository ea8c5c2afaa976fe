//! A* over the grid: eight neighbours, ground costs, a preference for the middle of the ground, deterministic ties.

use crate::WalkableGrid;
use crate::ground::rank;
use cosfly_frames::{RandomStream, Seed};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Deref;

/// Spacing of the lattice of personal preference, metres, and its number of points per side (it repeats).
const TASTE_M: f64 = 5.0;
const TASTE_POINTS: usize = 32;

/// Largest extra cost of ground by personal preference of people who walk alone, as a share.
pub(crate) const TASTE_SHARE: f32 = 0.3;

/// Extra cost of the very edge of the ground over its middle, as a share.
const EDGE_SHARE: f32 = 1.5;

/// Factor on the cost of going back over the last part of the route.
const BACK_FACTOR: f32 = 4.0;

/// Cost of a metre on each kind of ground, by its rank; never below 1, so that straight distance is a lower bound.
pub(crate) type GroundCosts = [f32; 5];

/// Costs of people who walk alone: pavement, plaza, crossing, shoulder, road.
pub(crate) const LONE_COSTS: GroundCosts = [1.0, 1.0, 1.2, 1.5, 8.0];

/// Route searches with personal preferences; scratch space is kept between searches. `G` holds the grid: a reference or an `Arc`.
pub(crate) struct RouteSearch<G> {
    grid: G,
    edge_distance_m: f32,
    costs: GroundCosts,
    /// Largest extra cost of ground by personal preference, as a share.
    taste_share: f32,
    /// Factor on the bound of the way left: above 1, routes are found sooner and may cost up to so many times the cheapest.
    haste: f32,
    taste: Vec<f32>,
    /// Number of the search that last wrote the entries of a node.
    written: Vec<u32>,
    search: u32,
    cost: Vec<f32>,
    ground: Vec<f32>,
    /// Step by which a node was reached; 8 at the start, bit 7 when it is final.
    reached_by: Vec<u8>,
}

const FINAL: u8 = 0x80;
const START: u8 = 8;

impl<G: Deref<Target = WalkableGrid>> RouteSearch<G> {
    pub fn new(grid: G, edge_distance_m: f64, costs: GroundCosts, taste_share: f32, seed: Seed) -> Self {
        let mut stream: RandomStream = seed.stream("taste");
        let count = grid.nodes.len();
        Self {
            grid,
            edge_distance_m: edge_distance_m as f32,
            costs,
            taste_share,
            haste: 1.0,
            taste: (0..TASTE_POINTS * TASTE_POINTS).map(|_| stream.unit() as f32).collect(),
            written: vec![0; count],
            search: 0,
            cost: vec![0.0; count],
            ground: vec![0.0; count],
            reached_by: vec![0; count],
        }
    }

    /// Search with a factor on the bound of the way left.
    pub fn with_haste(self, haste: f32) -> Self {
        Self { haste, ..self }
    }

    /// Nodes of the cheapest route from `start` to `goal`, both included; `None` when no route leads there.
    /// Routes over `recent` nodes cost more, so that a walk goes on rather than back.
    pub fn find(&mut self, start: u32, goal: u32, recent: &[u32]) -> Option<Vec<u32>> {
        self.find_within(start, goal, recent, f32::INFINITY)
    }

    /// Nodes as [`Self::find`] gives them; `None`, too, when the cheapest route costs more than `most` metres of pavement.
    pub fn find_within(&mut self, start: u32, goal: u32, recent: &[u32], most: f32) -> Option<Vec<u32>> {
        self.search += 1;
        for &node in recent {
            self.touch(node);
            self.ground[node as usize] *= BACK_FACTOR;
        }
        self.touch(start);
        (self.cost[start as usize], self.reached_by[start as usize]) = (0.0, START);
        // Costs are not negative, so their bits sort as they do; then the larger cost so far, then the node.
        let mut open = BinaryHeap::from([Reverse((self.bound(start, goal).to_bits(), 0_u32, start))]);
        while let Some(Reverse((bound, _, node))) = open.pop() {
            if f32::from_bits(bound) > most {
                return None;
            }
            if self.reached_by[node as usize] & FINAL != 0 {
                continue;
            }
            self.reached_by[node as usize] |= FINAL;
            if node == goal {
                return Some(self.way_back(goal));
            }
            for step in 0..8 {
                let Some(other) = self.grid.neighbour(node, step) else { continue };
                self.touch(other);
                if self.reached_by[other as usize] & FINAL != 0 {
                    continue;
                }
                let length = if step % 2 == 0 { 1.0 } else { core::f32::consts::SQRT_2 } * self.grid.cell_m as f32;
                let mean = 0.5 * (self.ground[node as usize] + self.ground[other as usize]);
                let cost = self.cost[node as usize] + length * mean;
                if cost < self.cost[other as usize] {
                    (self.cost[other as usize], self.reached_by[other as usize]) = (cost, step as u8);
                    open.push(Reverse(((cost + self.bound(other, goal)).to_bits(), !cost.to_bits(), other)));
                }
            }
        }
        None
    }

    /// Prepares a node for the running search.
    fn touch(&mut self, node: u32) {
        let i = node as usize;
        if self.written[i] != self.search {
            (self.written[i], self.cost[i], self.reached_by[i]) = (self.search, f32::INFINITY, 0);
            self.ground[i] = self.ground_at(node);
        }
    }

    /// Octile distance: no route on ground of cost 1 is shorter. Times the haste.
    fn bound(&self, node: u32, goal: u32) -> f32 {
        let (a, b) = (self.grid.column_row(node), self.grid.column_row(goal));
        let (x, y) = (a.0.abs_diff(b.0) as f32, a.1.abs_diff(b.1) as f32);
        self.haste * self.grid.cell_m as f32 * (x.max(y) + (core::f32::consts::SQRT_2 - 1.0) * x.min(y))
    }

    /// Cost of a metre at a node: kind x distance from the edge x personal preference.
    fn ground_at(&self, node: u32) -> f32 {
        let own = &self.grid.nodes[node as usize];
        let edge =
            if self.edge_distance_m > 0.0 { (1.0 - own.edge_distance_m / self.edge_distance_m).max(0.0) } else { 0.0 };
        let ground = self.costs[rank(own.kind) as usize] * (1.0 + EDGE_SHARE * edge);
        if self.taste_share > 0.0 { ground * (1.0 + self.taste_share * self.taste_at(node)) } else { ground }
    }

    /// Bilinear value noise in 0..1.
    fn taste_at(&self, node: u32) -> f32 {
        let (column, row) = self.grid.column_row(node);
        let (x, y) = (column as f64 * self.grid.cell_m / TASTE_M, row as f64 * self.grid.cell_m / TASTE_M);
        let (i, j) = (x as usize, y as usize);
        let (u, v) = ((x - i as f64) as f32, (y - j as f64) as f32);
        let value = |i: usize, j: usize| self.taste[(j % TASTE_POINTS) * TASTE_POINTS + i % TASTE_POINTS];
        let near = value(i, j) * (1.0 - u) + value(i + 1, j) * u;
        let far = value(i, j + 1) * (1.0 - u) + value(i + 1, j + 1) * u;
        near * (1.0 - v) + far * v
    }

    fn way_back(&self, goal: u32) -> Vec<u32> {
        let mut way = vec![goal];
        let mut node = goal;
        loop {
            let step = self.reached_by[node as usize] & !FINAL;
            if step == START {
                way.reverse();
                return way;
            }
            // Steps are symmetric, so the opposite step leads back.
            match self.grid.neighbour(node, (step as usize + 4) % 8) {
                Some(before) => node = before,
                None => return vec![],
            }
            way.push(node);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PedestrianConfig;
    use crate::grid::test_towns::{pillar, rectangle, streets, town};
    use cosfly_domain::WalkableKind;
    use cosfly_frames::DVec2;

    fn seed() -> Seed {
        Seed::of_item(3, "walkers", "route")
    }

    fn way(grid: &WalkableGrid, from: (f64, f64), to: (f64, f64)) -> Option<Vec<DVec2>> {
        let node = |(x, y): (f64, f64)| {
            let piece = (0..grid.components.len() as u32).find_map(|c| grid.node_near(DVec2::new(x, y), c, 2));
            piece.unwrap()
        };
        let mut search = RouteSearch::new(grid, 0.8, LONE_COSTS, TASTE_SHARE, seed());
        let way = search.find(node(from), node(to), &[])?;
        Some(way.into_iter().map(|node| grid.center(node)).collect())
    }

    #[test]
    fn a_route_takes_the_crossing_and_not_the_carriageway() {
        let mut town = streets();
        town.walkable.push(rectangle(WalkableKind::Road, (0.0, 40.0), (136.0, 48.0), 0.0));
        let grid = WalkableGrid::build(&town, &PedestrianConfig::default()).unwrap();
        let way = way(&grid, (15.0, 39.0), (15.0, 49.0)).unwrap();
        let on_road = way.iter().filter(|p| p.y > 40.0 && p.y < 48.0 && !(3.0..6.0).contains(&p.x)).count();
        assert_eq!(on_road, 0, "{way:?}");
    }

    #[test]
    fn a_route_keeps_off_the_edge_where_there_is_room() {
        let ground = rectangle(WalkableKind::Plaza, (0.0, 0.0), (60.0, 5.0), 0.0);
        let grid = WalkableGrid::build(&town(vec![ground], vec![]), &PedestrianConfig::default()).unwrap();
        let way = way(&grid, (1.0, 0.3), (59.0, 0.3)).unwrap();
        let middle = &way[10..way.len() - 10];
        assert!(middle.iter().all(|p| p.y > 0.6 && p.y < 4.4), "{middle:?}");
    }

    #[test]
    fn no_way_leads_to_another_piece_of_ground() {
        let near = rectangle(WalkableKind::Plaza, (0.0, 0.0), (10.0, 5.0), 0.0);
        let far = rectangle(WalkableKind::Plaza, (20.0, 0.0), (30.0, 5.0), 0.0);
        let grid = WalkableGrid::build(&town(vec![near, far], vec![]), &PedestrianConfig::default()).unwrap();
        assert_eq!(way(&grid, (5.0, 2.0), (25.0, 2.0)), None);
    }

    #[test]
    fn a_route_leads_round_a_post_in_its_way() {
        let ground = rectangle(WalkableKind::Plaza, (0.0, 0.0), (20.0, 5.0), 0.0);
        let grid =
            WalkableGrid::build(&town(vec![ground], vec![pillar((10.0, 2.5), 1.0, 3.0)]), &PedestrianConfig::default());
        let way = way(&grid.unwrap(), (2.0, 2.5), (18.0, 2.5)).unwrap();
        assert!(way.iter().all(|p| (p.x - 10.0).abs().max((p.y - 2.5).abs()) > 1.2));
    }
}
