//! The search against all ways tried one by one, and resumed searches against fresh ones.

use super::super::lattice::LatticeSize;
use super::*;
use crate::config::view::ViewConfig;
use cosfly_random::{RandomStream, Seed};

const LAYERS: usize = 3;

fn setting() -> (Lattice, Vec<DVec3>, MoveCosts) {
    let size = LatticeSize { azimuths: 12, altitudes: 2, radii: 3 };
    let feet = (0..LAYERS).map(|i| DVec3::new(1.5 * i as f64, 0.5 * i as f64, 0.2 * i as f64)).collect();
    let moves = MoveCosts { relative: 0.02, absolute: 0.03, longest_m: 25.0, widest_rad: 9.0 };
    (Lattice::new(size, &ViewConfig::default()), feet, moves)
}

fn random_costs(lattice: &Lattice, stream: &mut RandomStream) -> (NodeCosts, Vec<NodeState>) {
    let mut price =
        |count: usize, scale: f64| -> Vec<f32> { (0..count).map(|_| stream.uniform(0.0, scale) as f32).collect() };
    let costs = NodeCosts {
        hidden: [8.0, 0.5],
        close: 3.0,
        ring: price(lattice.rings(), 20.0),
        azimuth: (0..LAYERS).map(|_| price(lattice.directions.len(), 20.0)).collect(),
        first: price(lattice.nodes(), 9.0),
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
    let count = search.lattice.directions.len();
    let mut sum = f64::from(search.costs.first[path[0]]);
    for (layer, &node) in path.iter().enumerate() {
        let state = search.state(layer, node);
        if state == UNSAFE {
            return None;
        }
        let hidden = if search.is_lost(layer) { 8.0 - f64::from(state) } else { f64::from(state) };
        let [linear, square] = search.costs.hidden.map(f64::from);
        sum += hidden * (linear + square * hidden)
            + f64::from(search.costs.ring[node / count])
            + f64::from(search.costs.azimuth[layer][node % count]);
        if layer > 0 {
            let target = search.feet[layer] - search.feet[layer - 1];
            sum += move_price(search.lattice, search.moves, target, path[layer - 1], node)?;
        }
    }
    Some(sum)
}

#[test]
fn the_search_finds_what_an_exhaustive_one_finds_at_every_level() {
    let (lattice, feet, moves) = setting();
    let mut stream = Seed::of_item(4, "viterbi", "exhaustive").stream("t");
    for round in 0..6 {
        let (costs, states) = random_costs(&lattice, &mut stream);
        let mut space = SearchSpace { states, ..SearchSpace::default() };
        let mut search = Viterbi::new(&lattice, feet.clone(), &mut space, costs, moves);
        search.lose(1, round == 3);
        let found = search.solve(0).expect("some way");
        for level in Level::available() {
            search.level = level;
            assert_eq!(search.solve(0).as_ref(), Ok(&found), "{}", level.name());
        }
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
    let lattice = Lattice::new(LatticeSize { azimuths: 24, altitudes: 2, radii: 3 }, &ViewConfig::default());
    let moves = MoveCosts { relative: 0.2, absolute: 0.3, longest_m: 9.0, widest_rad: 9.0 };
    let costs = || NodeCosts {
        hidden: [10.0, 0.0],
        close: 0.0,
        ring: vec![0.0; lattice.rings()],
        azimuth: vec![vec![0.0; 24]; 90],
        first: Vec::new(),
        extra: Vec::new(),
    };
    let fresh = |states: Vec<NodeState>| {
        let mut space = SearchSpace { states, ..SearchSpace::default() };
        Viterbi::new(&lattice, vec![DVec3::ZERO; 90], &mut space, costs(), moves).solve(0)
    };
    let mut stream = Seed::of_item(4, "viterbi", "resumed").stream("t");
    let states: Vec<NodeState> = (0..90 * lattice.nodes()).map(|_| stream.index(9) as NodeState).collect();
    let mut space = SearchSpace { states: states.clone(), ..SearchSpace::default() };
    let mut resumed = Viterbi::new(&lattice, vec![DVec3::ZERO; 90], &mut space, costs(), moves);
    let first = resumed.solve(0).expect("a way");
    let mut changed = states.clone();
    for layer in [40, 70] {
        changed[layer * lattice.nodes() + first[layer]] = UNSAFE;
        resumed.forbid(layer, first[layer]);
    }
    assert_eq!(resumed.solve(40), fresh(changed));
    let mut closed = states;
    closed[50 * lattice.nodes()..51 * lattice.nodes()].fill(UNSAFE);
    assert_eq!(fresh(closed), Err(50));
}
