//! Refinement: Gauss-Newton steps from the lattice's way to a smooth flight that sees more.
//!
//! Every term adds its residuals ([`CostTerm::add_residuals`](crate::CostTerm::add_residuals)) or its gradient; beside them
//! the flight is held near the lattice's way, kept clear of obstacles and made smooth. Where a round ends worse than
//! the lattice's way, the next one holds on to it more strongly.

use super::start_sector;
use crate::config::muco::MucoConfig;
use crate::equations::NormalEquations;
use crate::gradient::total_gradient;
use crate::problem::Problem;
use cosfly_frames::DVec3;
use cosfly_surroundings::Surroundings;
use cosfly_surroundings::local::LocalObstacles;

/// Numbers of rounds, and of steps in a round.
#[derive(Clone, Copy, Debug)]
pub struct Rounds {
    /// Rounds, each with stronger holds.
    pub rounds: usize,
    /// Steps per round.
    pub steps: usize,
}

/// Weight of nearness to the lattice's way.
const HOLD: f64 = 0.02;
/// Growth of the hold on the lattice's way where a round ended worse than that way.
const HOLD_GROWTH: f64 = 30.0;
/// Weight that holds given waypoints.
const HOLD_FAST: f64 = 1e6;
/// Smoothness beside that of the terms.
const EXTRA_ACCELERATION: f64 = 0.5;
const EXTRA_JERK: f64 = 3.0;
/// Weight of missing clearance, and how far before the limit it begins, metres.
const CLEARANCE_WEIGHT: f64 = 40.0;
const CLEARANCE_EXTRA_M: f64 = 0.4;
/// The same for the lowest altitude.
const FLOOR_EXTRA_M: f64 = 0.2;
/// The same for the least horizontal distance from the target.
const RADIUS_EXTRA_M: f64 = 0.5;
/// Weight of leaving the sector in which flights start, and how far before its side it begins, metres.
const START_WEIGHT: f64 = 400.0;
const START_EXTRA_M: f64 = 1.0;
/// No waypoint moves further in one step, metres.
const LONGEST_STEP_M: f64 = 2.5;
/// Time step for which the smoothness weights are written, seconds.
const REFERENCE_DT_S: f64 = 0.5;

/// Result of a refinement.
pub struct Refined {
    /// Steps taken.
    pub steps: u32,
    /// Total cost against the planning boxes, before and after.
    pub convergence: Vec<f64>,
}

/// Buffers of a refinement, worth keeping.
#[derive(Default)]
pub struct RefineSpace {
    equations: NormalEquations,
    step: Vec<DVec3>,
}

/// Refines `waypoints` (from the lattice) in place; the first of them stay as given in `head`.
pub fn refine(
    problem: &Problem<'_>,
    obstacles: &mut LocalObstacles<'_>,
    config: &MucoConfig,
    rounds: Rounds,
    head: &[DVec3],
    space: &mut RefineSpace,
    waypoints: &mut [DVec3],
) -> Refined {
    let lattice_way = waypoints.to_vec();
    obstacles.focus_on(&lattice_way);
    let seen: Vec<f64> = (0..waypoints.len()).map(|i| obstacles.visibility(i, lattice_way[i])).collect();
    let mut hold = vec![HOLD; waypoints.len()];
    hold[..head.len()].fill(HOLD_FAST);
    for (frame, hold) in hold.iter_mut().enumerate() {
        *hold *= if obstacles.is_to_be_lost(frame) { HOLD_GROWTH } else { 1.0 };
    }
    let mut convergence = vec![problem.cost(obstacles, waypoints)];
    for round in 0..rounds.rounds {
        for _ in 0..rounds.steps {
            assemble(problem, obstacles, config, &lattice_way, &hold, &mut space.equations, waypoints);
            space.equations.solve(1e-9, &mut space.step);
            for (waypoint, step) in waypoints.iter_mut().zip(&space.step) {
                *waypoint += step.clamp_length_max(LONGEST_STEP_M);
            }
            waypoints[..head.len()].copy_from_slice(head);
            obstacles.focus_on(waypoints);
        }
        if round + 1 < rounds.rounds {
            for (i, hold) in hold.iter_mut().enumerate() {
                if obstacles.visibility(i, waypoints[i]) < seen[i] {
                    *hold *= HOLD_GROWTH;
                }
            }
        }
    }
    convergence.push(problem.cost(obstacles, waypoints));
    Refined { steps: (rounds.rounds * rounds.steps) as u32, convergence }
}

fn assemble(
    problem: &Problem<'_>,
    obstacles: &LocalObstacles<'_>,
    config: &MucoConfig,
    lattice_way: &[DVec3],
    hold: &[f64],
    equations: &mut NormalEquations,
    waypoints: &[DVec3],
) {
    equations.reset(waypoints.len());
    let context = problem.context(obstacles);
    for weighted in problem.terms.iter().filter(|weighted| weighted.weight > 0.0) {
        if !weighted.term.add_residuals(waypoints, &context, weighted.weight, equations) {
            let alone = core::slice::from_ref(weighted);
            let gradient = total_gradient(alone, waypoints, &context, config.descent.difference_m);
            gradient.iter().enumerate().for_each(|(frame, slope)| equations.add_gradient(frame, *slope));
        }
    }
    let ratio = (REFERENCE_DT_S / problem.track.dt_s).clamp(0.05, 20.0);
    equations.add_differences(2, EXTRA_ACCELERATION * ratio * ratio, waypoints);
    equations.add_differences(3, EXTRA_JERK * ratio * ratio * ratio, waypoints);
    // Sides are kept where the start is free, which a given one is not.
    if hold.first().is_some_and(|hold| *hold < HOLD_FAST) {
        for side in start_sector::sides(problem, &config.view, lattice_way[0]) {
            let missing = START_EXTRA_M - side.slack_m(waypoints[0]);
            if missing > 0.0 {
                equations.add(0, START_WEIGHT, missing, -side.normal);
            }
        }
    }
    let keep = config.limits.clearance_m + CLEARANCE_EXTRA_M;
    for (frame, &waypoint) in waypoints.iter().enumerate() {
        equations.add_anchor(frame, hold[frame], waypoint - lattice_way[frame]);
        let ground = obstacles.ground_z_m(waypoint.x, waypoint.y).max(problem.track.states[frame].feet_in_world.z);
        let below = ground + config.view.min_altitude_m + FLOOR_EXTRA_M - waypoint.z;
        if below > 0.0 && lattice_way[frame].z >= ground + config.view.min_altitude_m {
            equations.add(frame, CLEARANCE_WEIGHT, below, -DVec3::Z);
        }
        let across = (waypoint - problem.track.states[frame].feet_in_world).with_z(0.0);
        let missing = config.view.min_radius_m + RADIUS_EXTRA_M - across.length();
        if missing > 0.0 {
            equations.add(frame, CLEARANCE_WEIGHT, missing, -across.try_normalize().unwrap_or(DVec3::X));
        }
        if let Some((distance, away)) = obstacles.nearest(frame, waypoint, keep) {
            equations.add(frame, CLEARANCE_WEIGHT, keep - distance, -away);
        }
    }
}
