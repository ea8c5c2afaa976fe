//! The global start: the cheapest way through the lattice of viewpoints over time (Viterbi).
//!
//! Moving from offset o to o' while the target moves by dp costs `r |D|^2 + a |dp + D|^2` with D = o' - o. In polar
//! coordinates |D|^2 is (almost) a sum of an altitude, a radius and an azimuth part and dp.D splits into a part of each
//! end, so the minimum over all neighbours is taken one coordinate after the other. No pointers back are kept: the
//! way is found again from the costs of all layers.

use super::lattice::{Lattice, MAX_LANES, VECTOR};
use super::scan::{CLOSE, NodeState, UNSAFE};
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec3, real, simd_kernel};

/// Furthest move in azimuth per layer, in directions.
pub const MAX_AZIMUTH_STEPS: usize = 6;
/// What forbids.
const FORBIDDEN: f32 = f32::INFINITY;
/// Room on both sides of a row of lanes, so that neighbours are read without a test.
const ROOM: usize = VECTOR;
const ROW: usize = ROOM + MAX_LANES + ROOM;

/// What a node costs beside being seen from: see [`super::search`].
pub struct NodeCosts {
    /// Per hidden body point of 8 (linear) and its square.
    pub hidden: [f32; 2],
    /// Near an obstacle.
    pub close: f32,
    /// By lane.
    pub lane: Vec<f32>,
    /// By layer and azimuth.
    pub azimuth: Vec<Vec<f32>>,
    /// By layer and node; empty when there are no further terms.
    pub extra: Vec<Vec<f32>>,
}

/// Weights and bounds of moves between layers.
#[derive(Clone, Copy)]
pub struct MoveCosts {
    /// Per square metre relative to the target.
    pub relative: f64,
    /// Per square metre in the world.
    pub absolute: f64,
    /// Longest move relative to the target in one layer, metres.
    pub longest_m: f64,
}

/// Buffers of a search, worth keeping from one to the next.
#[derive(Default)]
pub struct SearchSpace {
    /// Node states, layer by layer.
    pub states: Vec<NodeState>,
    /// Cost of reaching each node of each layer, less a number per layer.
    arrival: Vec<f32>,
    /// One layer between its two steps, with the azimuths repeated at both ends.
    turned: Vec<f32>,
}

/// The search over all layers, resumable after nodes have been forbidden.
pub struct Viterbi<'a> {
    lattice: &'a Lattice,
    space: &'a mut SearchSpace,
    feet: Vec<DVec3>,
    moves: MoveCosts,
    costs: NodeCosts,
    prices: MovePrices,
    level: Level,
}

/// Prices of single steps by the lane they lead to.
struct MovePrices {
    radii: usize,
    steps: usize,
    /// From the altitude below, from the one above.
    climb: [Vec<f32>; 2],
    /// From the radius inside, from the one outside.
    reach: [Vec<f32>; 2],
    /// From the azimuth `k - steps` further.
    turn: Vec<Vec<f32>>,
}

impl MovePrices {
    fn new(lattice: &Lattice, moves: &MoveCosts) -> Self {
        let weight = moves.relative + moves.absolute;
        let square = |gap: f64| if gap <= moves.longest_m { (weight * gap * gap) as f32 } else { FORBIDDEN };
        let radii = lattice.radii_m.len();
        let by_lane = |price: &dyn Fn(usize) -> f32| -> Vec<f32> {
            (0..lattice.stride()).map(|lane| if lane < lattice.lanes() { price(lane) } else { FORBIDDEN }).collect()
        };
        let between = |values: &[f64], from: Option<usize>, to: usize| {
            from.and_then(|from| values.get(from)).map_or(FORBIDDEN, |value| square((value - values[to]).abs()))
        };
        let climb = |from: &dyn Fn(usize) -> Option<usize>| {
            by_lane(&|lane| between(&lattice.altitudes_m, from(lane / radii), lane / radii))
        };
        let reach = |from: &dyn Fn(usize) -> Option<usize>| {
            by_lane(&|lane| between(&lattice.radii_m, from(lane % radii), lane % radii))
        };
        let angle = real::TAU / lattice.directions.len() as f64;
        let chord = |steps: usize| 2.0 * real::sin(0.5 * angle * steps as f64);
        let possible = (lattice.directions.len() - 1) / 2;
        let nearest = lattice.radii_m.first().copied().unwrap_or(0.0);
        let steps = (0..=MAX_AZIMUTH_STEPS.min(possible)).rev().find(|&k| chord(k) * nearest <= moves.longest_m);
        let steps = steps.unwrap_or(0);
        let turn = (0..=2 * steps)
            .map(|k| by_lane(&|lane| square(chord(k.abs_diff(steps)) * lattice.radii_m[lane % radii])))
            .collect();
        Self {
            radii,
            steps,
            climb: [climb(&|h| h.checked_sub(1)), climb(&|h| Some(h + 1))],
            reach: [reach(&|r| r.checked_sub(1)), reach(&|r| Some(r + 1))],
            turn,
        }
    }
}

impl<'a> Viterbi<'a> {
    /// Prepares a search over layers at which the target's feet are at `feet`; `space.states` holds the states of
    /// their nodes.
    pub fn new(
        lattice: &'a Lattice,
        feet: Vec<DVec3>,
        space: &'a mut SearchSpace,
        costs: NodeCosts,
        moves: MoveCosts,
    ) -> Self {
        space.arrival.resize(lattice.nodes() * feet.len(), 0.0);
        let prices = MovePrices::new(lattice, &moves);
        space.turned.resize((lattice.directions.len() + 2 * prices.steps) * lattice.stride(), 0.0);
        Self { lattice, space, feet, moves, costs, prices, level: Level::best() }
    }

    /// The same with other instructions; for tests.
    pub fn at_level(mut self, level: Level) -> Self {
        self.level = level;
        self
    }

    /// Forbids one node; [`Self::solve`] from its layer on before the next look.
    pub fn forbid(&mut self, layer: usize, node: usize) {
        self.space.states[layer * self.lattice.nodes() + node] = UNSAFE;
    }

    /// The state of a node.
    pub fn state(&self, layer: usize, node: usize) -> NodeState {
        self.space.states[layer * self.lattice.nodes() + node]
    }

    /// The cheapest nodes, one per layer, or the layer at which nothing is reachable. Only layers from
    /// `first_changed` on are computed again.
    pub fn solve(&mut self, first_changed: usize) -> Result<Vec<usize>, usize> {
        let nodes = self.lattice.nodes();
        for layer in first_changed..self.feet.len() {
            let (before, rest) = self.space.arrival.split_at_mut(layer * nodes);
            let here = &mut rest[..nodes];
            let moved = if layer == 0 { DVec3::ZERO } else { self.feet[layer] - self.feet[layer - 1] };
            let pull = [moved.x, moved.y, moved.z].map(|m| (2.0 * self.moves.absolute * m) as f32);
            let ground = Ground {
                radius: &self.lattice.lane_radius_m,
                altitude: &self.lattice.lane_altitude_m,
                prices: &self.prices,
                costs: &self.costs,
                azimuth: &self.costs.azimuth[layer],
                extra: self.costs.extra.get(layer).map_or(&[], Vec::as_slice),
                states: &self.space.states[layer * nodes..(layer + 1) * nodes],
                pull: &pull_along(self.lattice, pull),
                pull_up: pull[2],
            };
            if layer == 0 {
                here.fill(0.0);
            } else {
                advance(self.level, &ground, &before[(layer - 1) * nodes..], &mut self.space.turned, here);
            }
            let lowest = add_node_costs(self.level, &ground, here);
            if lowest >= FORBIDDEN {
                return Err(layer);
            }
            here.iter_mut().for_each(|cost| *cost -= lowest);
        }
        Ok(self.trace_back())
    }

    fn trace_back(&self) -> Vec<usize> {
        let nodes = self.lattice.nodes();
        let last = self.feet.len() - 1;
        let arrival = |layer: usize| &self.space.arrival[layer * nodes..(layer + 1) * nodes];
        let mut node = arrival(last).iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(node, _)| node);
        let mut path = vec![node];
        for layer in (1..=last).rev() {
            let moved = self.feet[layer] - self.feet[layer - 1];
            node = self.cheapest_before(node, arrival(layer - 1), 2.0 * self.moves.absolute * moved);
            path.push(node);
        }
        path.reverse();
        path
    }

    /// The node of the layer before from which `node` is reached at the lowest cost.
    fn cheapest_before(&self, node: usize, before: &[f32], pull: DVec3) -> usize {
        let (stride, count, prices) = (self.lattice.stride(), self.lattice.directions.len(), &self.prices);
        let (azimuth, lane) = (node / stride, node % stride);
        let mut best = (f64::INFINITY, node);
        for (k, turn) in prices.turn.iter().enumerate() {
            let row = (azimuth + count + k - prices.steps) % count * stride;
            for (reach, mid) in steps_to(lane, 1, &prices.reach) {
                for (climb, from) in steps_to(mid, prices.radii, &prices.climb) {
                    let price = turn[lane] + reach + climb;
                    let cost = before.get(row + from).copied().unwrap_or(FORBIDDEN) + price;
                    if cost < FORBIDDEN {
                        let cost = f64::from(cost) - pull.dot(self.lattice.offset(row + from));
                        best = if cost < best.0 { (cost, row + from) } else { best };
                    }
                }
            }
        }
        best.1
    }
}

/// (price, lane before) of staying, coming from the lane `gap` below and from the one above.
fn steps_to(lane: usize, gap: usize, prices: &[Vec<f32>; 2]) -> impl Iterator<Item = (f32, usize)> {
    let below = (prices[0][lane], lane.wrapping_sub(gap));
    let above = (prices[1][lane], lane + gap);
    [(0.0, lane), below, above].into_iter().filter(|(price, _)| *price < FORBIDDEN)
}

fn pull_along(lattice: &Lattice, pull: [f32; 3]) -> Vec<f32> {
    lattice.directions.iter().map(|d| pull[0] * d.x as f32 + pull[1] * d.y as f32).collect()
}

/// What one step reads.
struct Ground<'a> {
    radius: &'a [f32],
    altitude: &'a [f32],
    prices: &'a MovePrices,
    costs: &'a NodeCosts,
    azimuth: &'a [f32],
    extra: &'a [f32],
    states: &'a [NodeState],
    /// Per azimuth, cost per metre of radius, and per metre of altitude: subtracted before, added after the step.
    pull: &'a [f32],
    pull_up: f32,
}

#[inline(always)]
fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

simd_kernel! {
    /// The cheapest way to every node from the layer before, node costs left out.
    fn advance(ground: &Ground<'_>, before: &[f32], turned: &mut [f32], here: &mut [f32]) {
        let (stride, steps, radii) = (ground.radius.len(), ground.prices.steps, ground.prices.radii);
        let azimuths = ground.pull.len();
        let mut row = [FORBIDDEN; ROW];
        let mut climbed = [FORBIDDEN; ROW];
        for azimuth in 0..azimuths {
            let pull = ground.pull[azimuth];
            let from = &before[azimuth * stride..(azimuth + 1) * stride];
            for (lane, cost) in row[ROOM..ROOM + stride].iter_mut().enumerate() {
                *cost = from[lane] - (pull * ground.radius[lane] + ground.pull_up * ground.altitude[lane]);
            }
            let [low, high] = &ground.prices.climb;
            step(&row, radii, stride, low, high, &mut climbed[ROOM..ROOM + stride]);
            let [low, high] = &ground.prices.reach;
            let to = (azimuth + steps) * stride;
            step(&climbed, 1, stride, low, high, &mut turned[to..to + stride]);
        }
        turned.copy_within(azimuths * stride..(azimuths + steps) * stride, 0);
        turned.copy_within(steps * stride..2 * steps * stride, (azimuths + steps) * stride);
        for azimuth in 0..azimuths {
            let pull = ground.pull[azimuth];
            let to = &mut here[azimuth * stride..(azimuth + 1) * stride];
            for (v, to) in to.as_chunks_mut::<VECTOR>().0.iter_mut().enumerate() {
                let lanes = v * VECTOR..(v + 1) * VECTOR;
                let mut best = [FORBIDDEN; VECTOR];
                for (k, prices) in ground.prices.turn.iter().enumerate() {
                    let row = &turned[(azimuth + k) * stride..(azimuth + k + 1) * stride];
                    let (offers, prices) = (&row.as_chunks::<VECTOR>().0[v], &prices.as_chunks::<VECTOR>().0[v]);
                    for j in 0..VECTOR {
                        best[j] = least(offers[j] + prices[j], best[j]);
                    }
                }
                let (radius, altitude) = (&ground.radius[lanes.clone()], &ground.altitude[lanes]);
                for j in 0..VECTOR {
                    to[j] = best[j] + (pull * radius[j] + ground.pull_up * altitude[j]);
                }
            }
        }
    }
}

/// Staying, or coming from the lane `gap` below or above, whichever is cheapest.
#[inline(always)]
fn step(row: &[f32; ROW], gap: usize, stride: usize, low: &[f32], high: &[f32], out: &mut [f32]) {
    let gap = gap.min(ROOM);
    let below = &row[ROOM - gap..ROOM - gap + stride];
    let above = &row[ROOM + gap..ROOM + gap + stride];
    let stay = &row[ROOM..ROOM + stride];
    let lanes = stay.as_chunks::<VECTOR>().0.iter().zip(below.as_chunks::<VECTOR>().0);
    let lanes = lanes.zip(above.as_chunks::<VECTOR>().0);
    let prices = low.as_chunks::<VECTOR>().0.iter().zip(high.as_chunks::<VECTOR>().0);
    for ((((stay, below), above), (low, high)), out) in lanes.zip(prices).zip(out.as_chunks_mut::<VECTOR>().0) {
        for j in 0..VECTOR {
            out[j] = least(above[j] + high[j], least(below[j] + low[j], stay[j]));
        }
    }
}

simd_kernel! {
    /// Adds what it costs to be at every node; returns the lowest sum.
    fn add_node_costs(ground: &Ground<'_>, cost: &mut [f32]) -> f32 {
        let stride = ground.radius.len();
        let [linear, square] = ground.costs.hidden;
        let mut lowest = [FORBIDDEN; VECTOR];
        for (azimuth, (row, states)) in cost.chunks_exact_mut(stride).zip(ground.states.chunks_exact(stride)).enumerate() {
            let base = ground.azimuth[azimuth];
            let lanes = ground.costs.lane.as_chunks::<VECTOR>().0.iter().zip(states.as_chunks::<VECTOR>().0);
            for (v, (row, (lane, states))) in row.as_chunks_mut::<VECTOR>().0.iter_mut().zip(lanes).enumerate() {
                for j in 0..VECTOR {
                    let state = u32::from(states[j]);
                    let hidden = (state & 0xf) as f32;
                    let close = if state & u32::from(CLOSE) != 0 { ground.costs.close } else { 0.0 };
                    let sum = row[j] + (base + lane[j] + close + hidden * (linear + square * hidden));
                    row[j] = if state == u32::from(UNSAFE) { FORBIDDEN } else { sum };
                }
                if !ground.extra.is_empty() {
                    let extra = &ground.extra[azimuth * stride + v * VECTOR..];
                    row.iter_mut().zip(extra).for_each(|(cost, more)| *cost += more);
                }
                for j in 0..VECTOR {
                    lowest[j] = least(row[j], lowest[j]);
                }
            }
        }
        lowest.into_iter().fold(FORBIDDEN, least)
    }
}
