//! The global start: the cheapest way through the lattice of viewpoints over time (Viterbi).
//!
//! Moving from offset o to o' while the target moves by dp costs `r |D|^2 + a |dp + D|^2` with D = o' - o. In polar
//! coordinates |D|^2 is (almost) a sum of an altitude, a radius and an azimuth part and dp.D splits into a part of each
//! end, so the minimum over all neighbours is taken one coordinate after the other. No pointers back are kept: the
//! way is found again from the costs of all layers.

use super::lattice::Lattice;
use super::node_state::{CLOSE, NodeState, UNSAFE};
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec3, real, simd_kernel};

/// Furthest move in azimuth per layer, in directions.
pub const MAX_AZIMUTH_STEPS: usize = 6;
/// Cost of a forbidden node.
const FORBIDDEN: f32 = f32::INFINITY;
/// Costs of nodes beside visibility: see [`super::search`].
pub struct NodeCosts {
    /// Per hidden body point of 8 (linear) and its square.
    pub hidden: [f32; 2],
    /// Near an obstacle.
    pub close: f32,
    /// By ring.
    pub ring: Vec<f32>,
    /// By layer and azimuth.
    pub azimuth: Vec<Vec<f32>>,
    /// Further costs of the first layer's nodes; may be empty.
    pub first: Vec<f32>,
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
    /// Widest change of azimuth in one layer, radians.
    pub widest_rad: f64,
}

/// Buffers of a search, worth keeping from one to the next.
#[derive(Default)]
pub struct SearchSpace {
    /// Node states, layer by layer.
    pub states: Vec<NodeState>,
    /// Cost of reaching each node of each layer, less the lowest of the layer before.
    arrival: Vec<f32>,
    /// The lowest of each layer.
    lowest: Vec<f32>,
    /// One layer between its steps; rings before the last step have some azimuths repeated at both ends.
    climbed: Vec<f32>,
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
    /// Layers in which the target is to be lost.
    lost: Vec<bool>,
    level: Level,
}

/// Prices of single steps by the ring they lead to.
struct MovePrices {
    radii: usize,
    steps: usize,
    /// From the altitude below, from the one above.
    climb: Vec<[f32; 2]>,
    /// From the radius inside, from the one outside.
    reach: Vec<[f32; 2]>,
    /// From 1, 2 ... azimuths further, to either side.
    turn: Vec<Vec<f32>>,
}

impl MovePrices {
    fn new(lattice: &Lattice, moves: &MoveCosts) -> Self {
        let weight = moves.relative + moves.absolute;
        let square = |gap: f64| if gap <= moves.longest_m { (weight * gap * gap) as f32 } else { FORBIDDEN };
        let radii = lattice.radii_m.len();
        let between = |values: &[f64], from: Option<usize>, to: usize| {
            from.and_then(|from| values.get(from)).map_or(FORBIDDEN, |value| square((value - values[to]).abs()))
        };
        let both =
            |values: &[f64], to: usize| [between(values, to.checked_sub(1), to), between(values, Some(to + 1), to)];
        let angle = real::TAU / lattice.directions.len() as f64;
        let chord = |steps: usize| 2.0 * real::sin(0.5 * angle * steps as f64);
        let possible = (lattice.directions.len() - 1) / 2;
        let nearest = lattice.radii_m.first().copied().unwrap_or(0.0);
        let is_allowed = |k: &usize| chord(*k) * nearest <= moves.longest_m && angle * *k as f64 <= moves.widest_rad;
        let steps = (0..=MAX_AZIMUTH_STEPS.min(possible)).rev().find(is_allowed).unwrap_or(0);
        let turn = |ring: usize| (1..=steps).map(|k| square(chord(k) * lattice.ring_m(ring).1)).collect();
        Self {
            radii,
            steps,
            climb: (0..lattice.rings()).map(|ring| both(&lattice.altitudes_m, ring / radii)).collect(),
            reach: (0..lattice.rings()).map(|ring| both(&lattice.radii_m, ring % radii)).collect(),
            turn: (0..lattice.rings()).map(turn).collect(),
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
        space.lowest.resize(feet.len(), 0.0);
        let prices = MovePrices::new(lattice, &moves);
        space.climbed.resize(lattice.nodes(), 0.0);
        space.turned.resize(lattice.directions.len() + 2 * prices.steps, 0.0);
        let lost = vec![false; feet.len()];
        Self { lattice, space, feet, moves, costs, prices, lost, level: Level::best() }
    }

    /// Number of layers.
    pub fn layers(&self) -> usize {
        self.feet.len()
    }

    /// Requires the target to be lost at a layer, or no longer: at such a layer visibility costs instead of occlusion.
    pub fn lose(&mut self, layer: usize, lost: bool) {
        self.lost[layer] = lost;
    }

    /// Whether the target is to be lost at a layer.
    pub fn is_lost(&self, layer: usize) -> bool {
        self.lost[layer]
    }

    /// Cost of the cheapest way that [`Self::solve`] found last, up to a constant.
    pub fn lowest_cost(&self) -> f64 {
        self.space.lowest.iter().map(|lowest| f64::from(*lowest)).sum()
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
            let SearchSpace { states, arrival, lowest, climbed, turned } = &mut *self.space;
            let (before, rest) = arrival.split_at_mut(layer * nodes);
            let here = &mut rest[..nodes];
            let moved = if layer == 0 { DVec3::ZERO } else { self.feet[layer] - self.feet[layer - 1] };
            let pull = [moved.x, moved.y, moved.z].map(|m| (2.0 * self.moves.absolute * m) as f32);
            let ground = Ground {
                lattice: self.lattice,
                prices: &self.prices,
                costs: &self.costs,
                azimuth: &self.costs.azimuth[layer],
                extra: self.costs.extra.get(layer).map_or(&[], Vec::as_slice),
                states: &states[layer * nodes..(layer + 1) * nodes],
                pull: &pull_along(self.lattice, pull),
                pull_up: pull[2],
                lowest: if layer == 0 { 0.0 } else { lowest[layer - 1] },
                lost: self.lost[layer],
            };
            if layer == 0 {
                here.fill(0.0);
                here.iter_mut().zip(&self.costs.first).for_each(|(cost, first)| *cost = *first);
            } else {
                advance(self.level, &ground, &before[(layer - 1) * nodes..], climbed, turned, here);
            }
            let least_sum = add_node_costs(self.level, &ground, here);
            if least_sum >= FORBIDDEN {
                return Err(layer);
            }
            lowest[layer] = least_sum;
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
        let (count, prices) = (self.lattice.directions.len(), &self.prices);
        let (ring, azimuth) = (node / count, node % count);
        let mut best = (f64::INFINITY, node);
        let turns = prices.turn[ring].iter().enumerate();
        let turns = turns.flat_map(|(k, price)| [(*price, azimuth + k + 1), (*price, azimuth + count - k - 1)]);
        for (turn, from_azimuth) in core::iter::once((0.0, azimuth)).chain(turns) {
            for (reach, mid) in steps_to(ring, 1, &prices.reach) {
                for (climb, from) in steps_to(mid, prices.radii, &prices.climb) {
                    let other = from * count + from_azimuth % count;
                    let cost = before[other] + (turn + reach + climb);
                    if cost < FORBIDDEN {
                        let cost = f64::from(cost) - pull.dot(self.lattice.offset(other));
                        best = if cost < best.0 { (cost, other) } else { best };
                    }
                }
            }
        }
        best.1
    }
}

/// (price, ring before) of staying, coming from the ring `gap` below and from the one above.
fn steps_to(ring: usize, gap: usize, prices: &[[f32; 2]]) -> impl Iterator<Item = (f32, usize)> {
    let [below, above] = prices[ring];
    let ways = [(0.0, ring), (below, ring.wrapping_sub(gap)), (above, ring + gap)];
    ways.into_iter().filter(|(price, _)| *price < FORBIDDEN)
}

fn pull_along(lattice: &Lattice, pull: [f32; 3]) -> Vec<f32> {
    lattice.directions.iter().map(|d| pull[0] * d.x as f32 + pull[1] * d.y as f32).collect()
}

/// Inputs of one step.
struct Ground<'a> {
    lattice: &'a Lattice,
    prices: &'a MovePrices,
    costs: &'a NodeCosts,
    azimuth: &'a [f32],
    extra: &'a [f32],
    states: &'a [NodeState],
    /// Per azimuth, cost per metre of radius, and per metre of altitude: subtracted before, added after the step.
    pull: &'a [f32],
    pull_up: f32,
    /// The lowest cost of the layer before, taken off everything.
    lowest: f32,
    /// Whether visible points cost, instead of hidden ones.
    lost: bool,
}

#[inline(always)]
fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// Azimuths that are priced side by side.
const WIDE: usize = 16;

/// The least of a row and of the rows beside it with their prices, azimuth by azimuth: rows from starts in `costs`, none beside it
/// where a price is not below [`FORBIDDEN`]. Written to a place of its own: in place, compilers make masked stores of it, which
/// are slow on many processors.
#[inline(always)]
fn offered(to: &mut [f32], costs: &[f32], row: usize, beside: [(usize, f32); 2]) {
    let rows = beside.map(|(start, price)| if price < FORBIDDEN { (start, price) } else { (row, f32::INFINITY) });
    let [(lower, fall), (upper, rise)] = rows.map(|(start, price)| (&costs[start..], price));
    for (((to, here), lower), upper) in to.iter_mut().zip(&costs[row..]).zip(lower).zip(upper) {
        *to = least(upper + rise, least(lower + fall, *here));
    }
}

simd_kernel! {
    /// The cheapest way to every node from the layer before, node costs left out. Rings are rows of azimuths.
    fn advance(ground: &Ground<'_>, before: &[f32], climbed: &mut [f32], turned: &mut [f32], here: &mut [f32]) {
        let (count, steps, radii) = (ground.pull.len(), ground.prices.steps, ground.prices.radii);
        let rows = before.chunks_exact(count).zip(here.chunks_exact_mut(count)).enumerate();
        for (ring, (from, to)) in rows {
            let (altitude, radius) = ground.lattice.ring_m(ring);
            let (radius, level) = (radius as f32, ground.pull_up * altitude as f32 + ground.lowest);
            for ((to, from), pull) in to.iter_mut().zip(from).zip(ground.pull) {
                *to = from - (pull * radius + level);
            }
        }
        for (ring, (best, prices)) in climbed.chunks_exact_mut(count).zip(&ground.prices.climb).enumerate() {
            let start = |ring: usize| ring.wrapping_mul(count);
            let beside = [(start(ring.wrapping_sub(radii)), prices[0]), (start(ring.wrapping_add(radii)), prices[1])];
            offered(best, here, start(ring), beside);
        }
        for (ring, to) in here.chunks_exact_mut(count).enumerate() {
            let start = |ring: usize| ring.wrapping_mul(count);
            let prices = ground.prices.reach[ring];
            let beside = [(start(ring.wrapping_sub(1)), prices[0]), (start(ring.wrapping_add(1)), prices[1])];
            offered(&mut turned[steps..steps + count], climbed, start(ring), beside);
            turned.copy_within(count..count + steps, 0);
            turned.copy_within(steps..2 * steps, count + steps);
            let (wide, rest) = to.as_chunks_mut::<WIDE>();
            let first = steps.wrapping_add(wide.len().wrapping_mul(WIDE));
            for (to, middle) in wide.iter_mut().zip((steps..).step_by(WIDE)) {
                turn(to, turned, middle, &ground.prices.turn[ring]);
            }
            for (to, middle) in rest.iter_mut().zip(first..) {
                turn(core::array::from_mut(to), turned, middle, &ground.prices.turn[ring]);
            }
        }
    }
}

/// The cheapest turns to neighbouring azimuths, from `middle` on among `turned`.
#[inline(always)]
fn turn<const N: usize>(to: &mut [f32; N], turned: &[f32], middle: usize, prices: &[f32]) {
    let from = |at: usize| turned.get(at..).and_then(|rest| rest.first_chunk::<N>());
    let Some(mut best) = from(middle).copied() else { return };
    for (k, price) in (1..).zip(prices) {
        if let (Some(left), Some(right)) = (from(middle.wrapping_sub(k)), from(middle.wrapping_add(k))) {
            for lane in 0..N {
                best[lane] = least(least(left[lane], right[lane]) + price, best[lane]);
            }
        }
    }
    *to = best;
}

simd_kernel! {
    /// Adds what it costs to be at every node, and the pull; returns the lowest sum.
    fn add_node_costs(ground: &Ground<'_>, cost: &mut [f32]) -> f32 {
        let count = ground.pull.len();
        let [linear, square] = ground.costs.hidden;
        // Points that cost: the hidden ones, or 8 less them.
        let (sign, all) = if ground.lost { (-1.0, 8.0) } else { (1.0, 0.0) };
        let rows = cost.chunks_exact_mut(count).zip(ground.states.chunks_exact(count));
        for (ring, (row, states)) in rows.enumerate() {
            let (altitude, radius) = ground.lattice.ring_m(ring);
            let (radius, base) = (radius as f32, ground.pull_up * altitude as f32 + ground.costs.ring[ring]);
            let close_cost = ground.costs.close;
            let azimuths = ground.azimuth.iter().zip(ground.pull);
            for ((cost, state), (azimuth, pull)) in row.iter_mut().zip(states).zip(azimuths) {
                let state = u32::from(*state);
                let hidden = all + sign * ((state & 0xf) as i32 as f32);
                let close = if state & u32::from(CLOSE) != 0 { close_cost } else { 0.0 };
                let more = pull * radius + base + (azimuth + close + hidden * (linear + square * hidden));
                *cost += if state == u32::from(UNSAFE) { FORBIDDEN } else { more };
            }
        }
        cost.iter_mut().zip(ground.extra).for_each(|(cost, more)| *cost += more);
        let (groups, rest) = cost.as_chunks::<16>();
        let mut lowest = [FORBIDDEN; 16];
        for group in groups {
            for j in 0..16 {
                lowest[j] = least(group[j], lowest[j]);
            }
        }
        lowest.into_iter().chain(rest.iter().copied()).fold(FORBIDDEN, least)
    }
}

#[cfg(test)]
mod tests;
