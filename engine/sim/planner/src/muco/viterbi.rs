//! The global start: the cheapest way through the lattice of viewpoints over time (Viterbi).
//!
//! Moving from offset o to o' while the target moves by dp costs `r |D|^2 + a |dp + D|^2` with D = o' - o. In polar
//! coordinates |D|^2 is (almost) a sum of an altitude, a radius and an azimuth part and dp.D splits into a part of each
//! end, so the minimum over all neighbours is taken one coordinate after the other.

use super::lattice::{CLOSE, Lattice, NodeState, UNSAFE};
use cosfly_frames::{DVec3, TargetTrack, real};

/// Layers between stored cost layers, from which a changed search is resumed.
const CHECKPOINT: usize = 32;
/// Furthest move in azimuth per layer, in directions.
const MAX_AZIMUTH_STEPS: usize = 6;
/// What forbids.
const FORBIDDEN: f32 = f32::INFINITY;

/// What a node costs beside being seen from: see [`super::start`].
pub struct NodeCosts {
    /// By number of visible body points, 0..=8.
    pub visibility: [f32; 9],
    /// Near an obstacle.
    pub close: f32,
    /// By (altitude, radius).
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

/// The search over all layers, resumable after nodes have been forbidden.
pub struct Viterbi<'a> {
    lattice: &'a Lattice,
    feet: Vec<DVec3>,
    moves: MoveCosts,
    costs: NodeCosts,
    /// Node states, layer by layer.
    pub states: Vec<NodeState>,
    from_lane: Vec<u8>,
    from_azimuth: Vec<u8>,
    checkpoints: Vec<Vec<f32>>,
    steps: usize,
    climb: Vec<[f32; 3]>,
    reach: Vec<[f32; 3]>,
    turn: Vec<Vec<f32>>,
}

impl<'a> Viterbi<'a> {
    /// Prepares a search over the keyframes `frames` of the track, whose nodes' `states` are given.
    pub fn new(
        lattice: &'a Lattice,
        track: &TargetTrack,
        frames: &[usize],
        states: Vec<NodeState>,
        costs: NodeCosts,
        moves: MoveCosts,
    ) -> Self {
        let total = lattice.nodes() * frames.len();
        let weight = moves.relative + moves.absolute;
        let square = |gap: f64| if gap <= moves.longest_m { (weight * gap * gap) as f32 } else { FORBIDDEN };
        let neighbours = |values: &[f64]| -> Vec<[f32; 3]> {
            let price = |from: Option<usize>, to: usize| {
                from.and_then(|from| values.get(from)).map_or(FORBIDDEN, |value| square((value - values[to]).abs()))
            };
            (0..values.len()).map(|i| [price(i.checked_sub(1), i), 0.0, price(Some(i + 1), i)]).collect()
        };
        let steps = MAX_AZIMUTH_STEPS.min(lattice.directions.len() / 2 - 1);
        let angle = real::TAU / lattice.directions.len() as f64;
        let turn = (0..=2 * steps)
            .map(|k| {
                let chord = 2.0 * real::sin(0.5 * angle * (k as f64 - steps as f64).abs());
                let radii = lattice.radii_m.len();
                (0..lattice.lanes()).map(|lane| square(chord * lattice.radii_m[lane % radii])).collect()
            })
            .collect();
        Self {
            feet: frames.iter().map(|&frame| track.states[frame].feet_in_world).collect(),
            climb: neighbours(&lattice.altitudes_m),
            reach: neighbours(&lattice.radii_m),
            lattice,
            moves,
            costs,
            states,
            from_lane: vec![0; total],
            from_azimuth: vec![0; total],
            checkpoints: Vec::new(),
            steps,
            turn,
        }
    }

    fn layers(&self) -> usize {
        self.feet.len()
    }

    /// Cost of being at every node of a layer.
    fn add_node_costs(&self, layer: usize, cost: &mut [f32]) {
        let lanes = self.lattice.lanes();
        let nodes = self.lattice.nodes();
        let states = &self.states[layer * nodes..(layer + 1) * nodes];
        for (azimuth, (row, seen)) in cost.chunks_exact_mut(lanes).zip(states.chunks_exact(lanes)).enumerate() {
            let base = self.costs.azimuth[layer][azimuth];
            for ((out, &state), &lane) in row.iter_mut().zip(seen).zip(&self.costs.lane) {
                *out += if state == UNSAFE {
                    FORBIDDEN
                } else {
                    let close = if state & CLOSE != 0 { self.costs.close } else { 0.0 };
                    base + lane + close + self.costs.visibility[usize::from(state & !CLOSE).min(8)]
                };
            }
        }
        if let Some(extra) = self.costs.extra.get(layer) {
            cost.iter_mut().zip(extra).for_each(|(out, more)| *out += more);
        }
    }

    /// The cheapest nodes, one per layer, or the layer at which nothing is reachable. Only layers from
    /// `first_changed` on are computed again.
    pub fn solve(&mut self, first_changed: usize) -> Result<Vec<usize>, usize> {
        let first = (first_changed / CHECKPOINT).min(self.checkpoints.len().saturating_sub(1));
        self.checkpoints.truncate(first + 1);
        let mut layer = first * CHECKPOINT;
        let mut cost = vec![0.0_f32; self.lattice.nodes()];
        if layer == 0 {
            self.checkpoints.clear();
            self.add_node_costs(0, &mut cost);
            self.checkpoints.push(cost.clone());
        } else {
            cost.clone_from(&self.checkpoints[first]);
        }
        let mut spare = [cost.clone(), cost.clone()];
        loop {
            let lowest = cost.iter().copied().fold(FORBIDDEN, f32::min);
            if !lowest.is_finite() {
                return Err(layer);
            }
            cost.iter_mut().for_each(|c| *c -= lowest);
            if layer + 1 == self.layers() {
                return Ok(self.trace_back(&cost));
            }
            layer += 1;
            self.advance(layer, &mut cost, &mut spare);
            if layer.is_multiple_of(CHECKPOINT) {
                self.checkpoints.push(cost.clone());
            }
        }
    }

    fn advance(&mut self, layer: usize, cost: &mut [f32], spare: &mut [Vec<f32>; 2]) {
        let moved = self.feet[layer] - self.feet[layer - 1];
        self.add_potential(cost, moved, -2.0 * self.moves.absolute);
        let nodes = self.lattice.nodes();
        let (climbed, reached) = spare.split_at_mut(1);
        let back = &mut self.from_lane[layer * nodes..(layer + 1) * nodes];
        let lanes = self.lattice.lanes();
        for azimuth in 0..self.lattice.directions.len() {
            let row = azimuth * lanes..(azimuth + 1) * lanes;
            change_lane(
                (&self.climb, &self.reach),
                &cost[row.clone()],
                &mut climbed[0][row.clone()],
                &mut reached[0][row.clone()],
                &mut back[row],
            );
        }
        let back = &mut self.from_azimuth[layer * nodes..(layer + 1) * nodes];
        turn(lanes, self.steps, &self.turn, &reached[0], cost, back);
        self.add_potential(cost, moved, 2.0 * self.moves.absolute);
        self.add_node_costs(layer, cost);
    }

    /// Adds `factor * moved . offset` to every node.
    fn add_potential(&self, cost: &mut [f32], moved: DVec3, factor: f64) {
        let lanes = self.lattice.lanes();
        let radii = self.lattice.radii_m.len();
        for (direction, row) in self.lattice.directions.iter().zip(cost.chunks_exact_mut(lanes)) {
            let along = factor * moved.dot(*direction);
            for (lane, out) in row.iter_mut().enumerate() {
                let up = factor * moved.z * self.lattice.altitudes_m[lane / radii];
                *out += (along * self.lattice.radii_m[lane % radii] + up) as f32;
            }
        }
    }

    fn trace_back(&self, cost: &[f32]) -> Vec<usize> {
        let (nodes, lanes, radii) = (self.lattice.nodes(), self.lattice.lanes(), self.lattice.radii_m.len());
        let count = self.lattice.directions.len();
        let mut node = cost.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(node, _)| node);
        let mut path = vec![node];
        for layer in (1..self.layers()).rev() {
            let (azimuth, lane) = (node / lanes, node % lanes);
            let turned = usize::from(self.from_azimuth[layer * nodes + node]);
            let azimuth = (azimuth + count + turned - self.steps) % count;
            let packed = usize::from(self.from_lane[layer * nodes + azimuth * lanes + lane]);
            let radius = (lane % radii + packed % 3).saturating_sub(1);
            let altitude = (lane / radii + packed / 3).saturating_sub(1);
            node = azimuth * lanes + altitude * radii + radius;
            path.push(node);
        }
        path.reverse();
        path
    }
}

/// Best way to each (altitude, radius) of one azimuth from its neighbours; `back` packs 3 * climb + reach.
fn change_lane(
    (climb, reach): (&[[f32; 3]], &[[f32; 3]]),
    cost: &[f32],
    climbed: &mut [f32],
    reached: &mut [f32],
    back: &mut [u8],
) {
    let (altitudes, radii) = (climb.len(), reach.len());
    let mut climb_step = [1_u8; super::lattice::MAX_LANES];
    for (h, prices) in climb.iter().enumerate() {
        let here = h * radii;
        climbed[here..here + radii].copy_from_slice(&cost[here..here + radii]);
        for (step, other) in [(0, h.wrapping_sub(1)), (2, h + 1)] {
            if other >= altitudes {
                continue;
            }
            for r in 0..radii {
                let offered = cost[other * radii + r] + prices[step];
                if offered < climbed[here + r] {
                    climbed[here + r] = offered;
                    climb_step[here + r] = step as u8;
                }
            }
        }
    }
    for h in 0..altitudes {
        for (r, prices) in reach.iter().enumerate() {
            let here = h * radii + r;
            let (mut best, mut best_step) = (climbed[here], 1_usize);
            for (step, other) in [(0, r.wrapping_sub(1)), (2, r + 1)] {
                if other < radii && climbed[h * radii + other] + prices[step] < best {
                    best = climbed[h * radii + other] + prices[step];
                    best_step = step;
                }
            }
            reached[here] = best;
            back[here] = 3 * climb_step[h * radii + r + best_step - 1] + best_step as u8;
        }
    }
}

/// Best way to each azimuth from those within `steps`; `back` holds the step plus `steps`.
fn turn(lanes: usize, steps: usize, prices: &[Vec<f32>], from: &[f32], to: &mut [f32], back: &mut [u8]) {
    let count = from.len() / lanes;
    let rows = to.chunks_exact_mut(lanes).zip(back.chunks_exact_mut(lanes));
    for (azimuth, (best, arg)) in rows.enumerate() {
        best.copy_from_slice(&from[azimuth * lanes..(azimuth + 1) * lanes]);
        arg.fill(steps as u8);
        for (k, price) in prices.iter().enumerate() {
            if k == steps {
                continue;
            }
            let other = (azimuth + count + k - steps) % count;
            let offers = &from[other * lanes..(other + 1) * lanes];
            for (((best, arg), offer), price) in best.iter_mut().zip(arg.iter_mut()).zip(offers).zip(price) {
                let offered = offer + price;
                let better = offered < *best;
                *best = if better { offered } else { *best };
                *arg = if better { k as u8 } else { *arg };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{SearchConfig, ViewConfig};
    use cosfly_frames::{RandomStream, Seed, TargetState};

    const LAYERS: usize = 3;

    fn setting() -> (Lattice, TargetTrack, MoveCosts) {
        let search = SearchConfig { azimuths: 12, altitudes: 2, radii: 3, ..SearchConfig::default() };
        let state = |i: usize| TargetState {
            feet_in_world: DVec3::new(1.5 * i as f64, 0.5 * i as f64, 0.2 * i as f64),
            heading_rad: 0.0,
            speed_mps: 1.0,
        };
        let track = TargetTrack { dt_s: 0.5, height_m: 1.75, radius_m: 0.3, states: (0..LAYERS).map(state).collect() };
        let moves = MoveCosts { relative: 0.02, absolute: 0.03, longest_m: 25.0 };
        (Lattice::new(&search, &ViewConfig::default()), track, moves)
    }

    fn random_costs(lattice: &Lattice, stream: &mut RandomStream) -> (NodeCosts, Vec<NodeState>) {
        let mut price =
            |count: usize, scale: f64| -> Vec<f32> { (0..count).map(|_| stream.uniform(0.0, scale) as f32).collect() };
        let costs = NodeCosts {
            visibility: core::array::from_fn(|seen| 10.0 * (8 - seen) as f32),
            close: 3.0,
            lane: price(lattice.lanes(), 20.0),
            azimuth: (0..LAYERS).map(|_| price(lattice.directions.len(), 20.0)).collect(),
            extra: Vec::new(),
        };
        let states = (0..LAYERS * lattice.nodes())
            .map(|_| if stream.chance(0.3) { UNSAFE } else { stream.index(9) as NodeState })
            .collect();
        (costs, states)
    }

    /// The model's price of one move, written without the separation; `None` when it is not allowed.
    fn move_price(lattice: &Lattice, moves: MoveCosts, target: DVec3, from: usize, to: usize) -> Option<f64> {
        let ((a0, h0, r0), (a1, h1, r1)) = (lattice.split(from), lattice.split(to));
        let count = lattice.directions.len();
        let turned = (a1 + count - a0) % count;
        let turned = turned.min(count - turned);
        if h0.abs_diff(h1) > 1 || r0.abs_diff(r1) > 1 || turned > MAX_AZIMUTH_STEPS.min(count / 2 - 1) {
            return None;
        }
        let chord = 2.0 * real::sin(0.5 * real::TAU / count as f64 * turned as f64) * lattice.radii_m[r1];
        let climb = lattice.altitudes_m[h1] - lattice.altitudes_m[h0];
        let reach = lattice.radii_m[r1] - lattice.radii_m[r0];
        if [chord, climb, reach].iter().any(|gap| gap.abs() > moves.longest_m) {
            return None;
        }
        let squared = chord * chord + climb * climb + reach * reach;
        let along = target.dot(lattice.offset(to) - lattice.offset(from));
        Some((moves.relative + moves.absolute) * squared + 2.0 * moves.absolute * along)
    }

    fn path_price(search: &Viterbi<'_>, path: &[usize]) -> Option<f64> {
        let nodes = search.lattice.nodes();
        let mut sum = 0.0;
        for (layer, &node) in path.iter().enumerate() {
            let state = search.states[layer * nodes + node];
            if state == UNSAFE {
                return None;
            }
            let (azimuth, _, _) = search.lattice.split(node);
            sum += f64::from(search.costs.visibility[usize::from(state)])
                + f64::from(search.costs.lane[node % search.lattice.lanes()])
                + f64::from(search.costs.azimuth[layer][azimuth]);
            if layer > 0 {
                let target = search.feet[layer] - search.feet[layer - 1];
                sum += move_price(search.lattice, search.moves, target, path[layer - 1], node)?;
            }
        }
        Some(sum)
    }

    #[test]
    fn the_search_finds_what_an_exhaustive_one_finds() {
        let (lattice, track, moves) = setting();
        let mut stream = Seed::of_item(4, "viterbi", "exhaustive").stream("t");
        for _ in 0..6 {
            let (costs, states) = random_costs(&lattice, &mut stream);
            let mut search = Viterbi::new(&lattice, &track, &[0, 1, 2], states, costs, moves);
            let found = search.solve(0).expect("some way");
            let mut best = f64::INFINITY;
            for a in 0..lattice.nodes() {
                for b in 0..lattice.nodes() {
                    if path_price(&search, &[a, b]).is_some() {
                        for c in 0..lattice.nodes() {
                            best = best.min(path_price(&search, &[a, b, c]).unwrap_or(f64::INFINITY));
                        }
                    }
                }
            }
            let price = path_price(&search, &found).expect("the way found is allowed");
            assert!((price - best).abs() < 1e-3 * best.abs().max(1.0), "{price} {best}");
        }
    }

    #[test]
    fn a_resumed_search_equals_a_fresh_one_and_closed_layers_are_named() {
        let search_config = SearchConfig { azimuths: 24, altitudes: 2, radii: 3, ..SearchConfig::default() };
        let lattice = Lattice::new(&search_config, &ViewConfig::default());
        let state = TargetState { feet_in_world: DVec3::ZERO, heading_rad: 0.0, speed_mps: 0.0 };
        let track = TargetTrack { dt_s: 0.5, height_m: 1.75, radius_m: 0.3, states: vec![state; 90] };
        let frames: Vec<usize> = (0..90).collect();
        let moves = MoveCosts { relative: 0.2, absolute: 0.3, longest_m: 9.0 };
        let new = |states: Vec<NodeState>| {
            let costs = NodeCosts {
                visibility: core::array::from_fn(|seen| 10.0 * (8 - seen) as f32),
                close: 0.0,
                lane: vec![0.0; lattice.lanes()],
                azimuth: vec![vec![0.0; 24]; 90],
                extra: Vec::new(),
            };
            Viterbi::new(&lattice, &track, &frames, states, costs, moves)
        };
        let mut stream = Seed::of_item(4, "viterbi", "resumed").stream("t");
        let states: Vec<NodeState> = (0..90 * lattice.nodes()).map(|_| stream.index(9) as NodeState).collect();
        let mut resumed = new(states.clone());
        let first = resumed.solve(0).expect("a way");
        let mut changed = states.clone();
        for layer in [40, 70] {
            changed[layer * lattice.nodes() + first[layer]] = UNSAFE;
        }
        resumed.states.clone_from(&changed);
        assert_eq!(resumed.solve(40), new(changed).solve(0));
        let mut closed = states;
        closed[50 * lattice.nodes()..51 * lattice.nodes()].fill(UNSAFE);
        assert_eq!(new(closed).solve(0), Err(50));
    }
}
