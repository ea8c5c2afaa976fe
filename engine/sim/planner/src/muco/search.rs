//! The start of a flight: lattice, global search, interpolation, and a look at what lies between the nodes
//! (paper, algorithm 2, made global).

use super::lattice::{Lattice, LatticeSize};
use super::lead_in::{frames as frames_of_lead_in, lead_in};
use super::losses::{self, LossPlan};
use super::node_state::{CLOSE, NodeState, UNSAFE};
use super::pricing::{node_costs, start_costs};
use super::scan::Scanner;
use super::start_sector;
use super::viterbi::{MoveCosts, SearchSpace, Viterbi};
use crate::config::muco::MucoConfig;
use crate::error::PlanError;
use crate::problem::{Problem, frame_number};
use cosfly_frames::{DVec3, TargetTrack, real};
use cosfly_surroundings::SeveralTargets;
use cosfly_surroundings::local::LocalObstacles;

/// Searches that may be needed to go round nodes whose connections are not free.
const MAX_SEARCHES: usize = 12;
/// A connection counts as cut when its clearance is below this share of the limit; the smoother mends the rest.
const CUT_SHARE: f64 = 0.4;
/// Keyframes are at least about this far apart, so that a step of the lattice is within reach, seconds.
const SHORTEST_LAYER_S: f64 = 0.5;
/// Share of the speed limit at which nodes may follow each other; the rest is for getting up to speed and slowing down.
const STEADY_SHARE: f64 = 0.66;
/// Share of the limit of yaw rate at which nodes may follow each other.
const TURN_SHARE: f64 = 0.8;

/// The lattice of one search, and how it differs from the recipe's when that fails.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Numbers of azimuths, altitudes and radii.
    pub size: LatticeSize,
    /// Frames from layer to layer.
    pub layer_frames: usize,
    /// Multiplies the cost of motion.
    pub motion_factor: f64,
    /// Distance kept from obstacles by nodes, metres.
    pub keep_out_m: f64,
}

/// Result of a search.
pub struct Start {
    /// One waypoint per frame, free of obstacles at least at the layers.
    pub waypoints: Vec<DVec3>,
    /// Mean visibility over the layers along the best way through the lattice.
    pub visibility: f64,
    /// Share of the nodes that are not free.
    pub closed_share: f64,
    /// Searches that were needed.
    pub searches: u32,
    /// Frames in which the target is lost on purpose.
    pub losses: LossPlan,
}

/// The cheapest way through the lattice whose connections are free. The first waypoints may be given as `head`; the
/// way then starts at the last of them.
pub fn search(
    problem: &Problem<'_>,
    obstacles: &LocalObstacles<'_>,
    config: &MucoConfig,
    effort: Effort,
    head: &[DVec3],
    space: &mut SearchSpace,
) -> Result<Start, PlanError> {
    let track = problem.track;
    let lattice = Lattice::new(effort.size, &config.view);
    let stride = effort.layer_frames.max((SHORTEST_LAYER_S / track.dt_s).round() as usize).max(1);
    let first = head.len().saturating_sub(1);
    let frames = layer_frames(first, track.len() - 1, stride);
    space.states.resize(lattice.nodes() * frames.len(), 0);
    let mut scanner = Scanner::new(&lattice, track.height_m);
    for (&frame, row) in frames.iter().zip(space.states.chunks_exact_mut(lattice.nodes())) {
        scanner.evaluate(frame, &track.states[frame], obstacles, effort.keep_out_m, row);
        add_companions(&lattice, track.states[frame].feet_in_world, obstacles, frame, row);
    }
    // A sample is enough; its step has no factor in common with lattices of usual sizes.
    let sample = || space.states.iter().step_by(17);
    let closed_share = sample().filter(|&&state| state == UNSAFE).count() as f64 / sample().len().max(1) as f64;
    let mut costs = node_costs(problem, obstacles, &lattice, &frames, config);
    let moves = move_costs(config, effort, track.dt_s, stride);
    if head.is_empty() {
        costs.first = start_sector::costs(problem, &lattice);
    }
    if let Some(start) = head.last() {
        let keep_m = config.limits.clearance_m;
        let (relative, feet) = (moves.relative, track.states[first].feet_in_world);
        costs.first = start_costs(&lattice, obstacles, first, feet, *start, (relative, keep_m));
    }
    let feet = frames.iter().map(|&frame| track.states[frame].feet_in_world).collect();
    let mut viterbi = Viterbi::new(&lattice, feet, space, costs, moves);
    let losses = losses::order(&mut viterbi, &config.occlusion, &frames, track.dt_s);
    let mut changed = 0;
    for searches in 1..=MAX_SEARCHES {
        let nodes = viterbi.solve(changed).map_err(|layer| {
            PlanError::NoWay(format!(
                "no free viewpoint can be reached at frame {}: obstacles leave no room around the target{}",
                frame_number(problem.first_frame, frames[layer]),
                if head.is_empty() { "" } else { ", or it is too far to reach from where the drone is" }
            ))
        })?;
        let mut waypoints = interpolate(&lattice, track, &frames, &nodes);
        lead_in(head, frames_of_lead_in(head, &config.limits, track.dt_s, &waypoints), &mut waypoints);
        let cut = cut_layers(obstacles, &waypoints, &frames, CUT_SHARE * config.limits.clearance_m);
        let Some(&first) = cut.first() else {
            let hidden = |(layer, &node): (usize, &usize)| f64::from(viterbi.state(layer, node) & !CLOSE);
            let hidden: f64 = nodes.iter().enumerate().map(hidden).sum();
            let visibility = 1.0 - hidden / (8 * nodes.len()) as f64;
            return Ok(Start { waypoints, visibility, closed_share, searches: searches as u32, losses });
        };
        for layer in cut {
            viterbi.forbid(layer, nodes[layer]);
        }
        changed = first;
    }
    Err(PlanError::NoWay("no way between the free viewpoints was found that keeps out of obstacles".to_owned()))
}

/// Costs are per layer: a layer stands for `stride` frames, in each of which an even move goes 1 / stride of the way.
fn move_costs(config: &MucoConfig, effort: Effort, dt_s: f64, stride: usize) -> MoveCosts {
    let per_layer = effort.motion_factor / (stride * stride) as f64;
    MoveCosts {
        relative: per_layer * config.search.relative_motion,
        absolute: per_layer * config.search.absolute_motion,
        longest_m: STEADY_SHARE * config.limits.speed_mps * dt_s * stride as f64,
        widest_rad: TURN_SHARE * config.stated_limits().yaw_rate_deg_s.to_radians() * dt_s * stride as f64,
    }
}

/// Every `stride`-th frame from `first` on, and the last one.
fn layer_frames(first: usize, last: usize, stride: usize) -> Vec<usize> {
    let mut frames: Vec<usize> = (first..=last).step_by(stride).collect();
    if frames.last() != Some(&last) {
        frames.push(last);
    }
    frames
}

/// Counts the hidden body points of companions into the states.
fn add_companions(
    lattice: &Lattice,
    feet: DVec3,
    obstacles: &LocalObstacles<'_>,
    frame: usize,
    states: &mut [NodeState],
) {
    let bodies: Vec<_> = obstacles.companions(frame).collect();
    if bodies.is_empty() {
        return;
    }
    // Ankle, middle and shoulder stand for 2, 3 and 3 of the eight points.
    let points = [(1, 2.0), (3, 3.0), (5, 3.0)];
    for (node, state) in states.iter_mut().enumerate().filter(|(_, state)| **state != UNSAFE) {
        let place = feet + lattice.offset(node);
        let dark =
            |body: &[DVec3; 8], k: usize| obstacles.is_hidden(frame, (0.5 * (body[0] + body[5]), body[k]), place);
        let hidden = |body: &&[DVec3; 8]| points.iter().filter(|(k, _)| dark(body, *k)).map(|(_, n)| n).sum::<f64>();
        let own = f64::from(*state & !CLOSE);
        let together = match obstacles.seen_together() {
            SeveralTargets::Mean => (own + bodies.iter().map(hidden).sum::<f64>()) / (bodies.len() + 1) as f64,
            SeveralTargets::Minimum => bodies.iter().map(hidden).fold(own, f64::max),
        };
        *state = (*state & CLOSE) | together.round() as NodeState;
    }
}

/// Layers whose connection from the layer before comes too near an obstacle.
fn cut_layers(obstacles: &LocalObstacles<'_>, waypoints: &[DVec3], frames: &[usize], keep_m: f64) -> Vec<usize> {
    let cut = |layer: &usize| {
        (frames[*layer - 1]..frames[*layer])
            .any(|i| obstacles.segment_clearance_m(i, waypoints[i], waypoints[i + 1], keep_m) < keep_m)
    };
    (1..frames.len()).filter(cut).collect()
}

/// Offsets between keyframes: linear in azimuth, altitude and radius.
fn interpolate(lattice: &Lattice, track: &TargetTrack, frames: &[usize], nodes: &[usize]) -> Vec<DVec3> {
    let mut waypoints = vec![DVec3::ZERO; track.len()];
    let step = real::TAU / lattice.directions.len() as f64;
    for (pair, ends) in frames.windows(2).zip(nodes.windows(2)) {
        let ((a0, h0, r0), (a1, h1, r1)) = (lattice.split(ends[0]), lattice.split(ends[1]));
        let turn = real::wrap_angle_rad((a1 as f64 - a0 as f64) * step);
        for (frame, waypoint) in waypoints.iter_mut().enumerate().take(pair[1]).skip(pair[0]) {
            let t = (frame - pair[0]) as f64 / (pair[1] - pair[0]) as f64;
            let between = |values: &[f64], from: usize, to: usize| values[from] + t * (values[to] - values[from]);
            let (sin, cos) = real::sin_cos(a0 as f64 * step + t * turn);
            let radius = between(&lattice.radii_m, r0, r1);
            let up = between(&lattice.altitudes_m, h0, h1);
            *waypoint = track.states[frame].feet_in_world + DVec3::new(cos * radius, sin * radius, up);
        }
    }
    if let (Some(last), Some(&node), Some(state)) = (waypoints.last_mut(), nodes.last(), track.states.last()) {
        *last = state.feet_in_world + lattice.offset(node);
    }
    waypoints
}
