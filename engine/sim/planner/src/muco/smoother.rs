//! The flyable path nearest to a wished one: a banded quadratic programme in the safe corridor, by ADMM.
//!
//! Minimise `sum q |x - wished|^2 + a |D2 x|^2 + j |D3 x|^2` subject to the corridor's half-spaces and to
//! `|D1 x|`, `|D2 x|`, `|D3 x|` within the limits of speed, acceleration and jerk. The splitting keeps every
//! constraint in a copy that is cheap to project: balls for the differences, planes for the positions.

use super::banded::{Banded, Factor, add_transposed, differences};
use super::corridor::{self, CorridorInput, FrameCorridor};
use super::turning::add_turning;
use cosfly_domain::Limits;
use cosfly_frames::DVec3;
use cosfly_surroundings::Surroundings;

/// Iterations between looks at whether all holds.
const CHECK_EVERY: usize = 10;
/// The programme aims at this share of each limit, so that what is left of it holds the limit.
const AIM_SHARE: f64 = 0.97;
/// Penalties of the copies (position, speed, acceleration, jerk) at the reference time step.
const PENALTY: [f64; 4] = [1.0, 0.5, 2.0, 4.0];
/// Time step at which penalties and objectives are written, seconds. Differences of order k shrink with the
/// k-th power of the time step; their weights grow with its square, so that other steps converge alike.
const REFERENCE_DT_S: f64 = 0.5;
/// Over-relaxation.
const RELAXATION: f64 = 1.6;
/// Share of a missing line of sight that one projection mends.
const SIGHT_SHARE: f64 = 0.95;

/// Nearness that holds given waypoints.
const HOLD_FAST: f64 = 1e4;

/// Weights of the programme's objective, and the effort.
#[derive(Clone, Copy)]
pub struct Objective {
    /// Rounds of planes and programme.
    pub rounds: usize,
    /// Iterations of one programme at most.
    pub iterations: usize,
    /// Nearness to the wished waypoints.
    pub nearness: f64,
    /// Acceleration.
    pub acceleration: f64,
    /// Jerk.
    pub jerk: f64,
}

/// Result of smoothing.
pub struct Smoothed {
    /// One per frame.
    pub waypoints: Vec<DVec3>,
    /// Iterations of the programme, all rounds.
    pub iterations: u32,
}

/// Smooths `wished` (from the nearby safe path `start`) to the limits.
pub fn smooth(input: &CorridorInput<'_>, start: &[DVec3], limits: &Limits, objective: Objective) -> Smoothed {
    let dt = input.track.dt_s;
    let reach = [limits.speed_mps * dt, limits.acceleration_mps2 * dt * dt, limits.jerk_mps3 * dt * dt * dt];
    let ratio = (REFERENCE_DT_S / dt).clamp(0.05, 20.0);
    let scale = [1.0, ratio, ratio * ratio, ratio * ratio * ratio].map(|s| s * s);
    let mut waypoints = start.to_vec();
    let mut nearness = vec![objective.nearness; start.len()];
    nearness[..input.head.len()].fill(HOLD_FAST);
    let mut iterations = 0;
    for round in 0..objective.rounds {
        let mut corridor = corridor::build(input, &waypoints);
        add_turning(input, &waypoints, &mut corridor);
        let mut programme = Programme::new(&nearness, objective, input.wished, &waypoints, reach, scale);
        iterations += programme.run(&corridor, objective.iterations);
        waypoints = programme.x;
        waypoints[..input.head.len()].copy_from_slice(input.head);
        if round + 1 < objective.rounds {
            hold_on_where_sight_was_lost(input, &waypoints, &mut nearness);
        }
    }
    Smoothed { waypoints, iterations }
}

/// Frames that were seen better from where they were wished are drawn there more strongly.
fn hold_on_where_sight_was_lost(input: &CorridorInput<'_>, waypoints: &[DVec3], nearness: &mut [f64]) {
    for (frame, weight) in nearness.iter_mut().enumerate() {
        let now = input.obstacles.visibility(frame, waypoints[frame]);
        if now < 1.0 && now < input.obstacles.visibility(frame, input.wished[frame]) {
            *weight *= 4.0;
        }
    }
}

struct Programme<'a> {
    wished: &'a [DVec3],
    nearness: &'a [f64],
    reach: [f64; 3],
    penalty: [f64; 4],
    factor: Factor,
    x: Vec<DVec3>,
    row: Vec<DVec3>,
    /// Copies of position and the three differences, and their scaled multipliers.
    copy: [Vec<DVec3>; 4],
    multiplier: [Vec<DVec3>; 4],
}

impl<'a> Programme<'a> {
    fn new(
        nearness: &'a [f64],
        objective: Objective,
        wished: &'a [DVec3],
        start: &[DVec3],
        reach: [f64; 3],
        scale: [f64; 4],
    ) -> Self {
        let penalty: [f64; 4] = core::array::from_fn(|order| PENALTY[order] * scale[order]);
        let diagonal: Vec<f64> = nearness.iter().map(|q| q + penalty[0]).collect();
        let mut matrix = Banded::diagonal(&diagonal);
        matrix.add_differences(1, penalty[1]);
        matrix.add_differences(2, penalty[2] + objective.acceleration * scale[2]);
        matrix.add_differences(3, penalty[3] + objective.jerk * scale[3]);
        let copy: [Vec<DVec3>; 4] = core::array::from_fn(|order| {
            let mut row = Vec::new();
            differences(order, start, &mut row);
            row
        });
        let multiplier = core::array::from_fn(|k| vec![DVec3::ZERO; copy[k].len()]);
        Self {
            wished,
            nearness,
            reach,
            penalty,
            factor: matrix.factor(),
            x: start.to_vec(),
            row: Vec::new(),
            copy,
            multiplier,
        }
    }

    /// Iterates until everything holds or the iterations are used up; returns how many it took.
    fn run(&mut self, corridor: &[FrameCorridor], iterations: usize) -> u32 {
        for iteration in 1..=iterations {
            self.iterate(corridor);
            if iteration % CHECK_EVERY == 0 && self.holds(corridor) {
                return iteration as u32;
            }
        }
        iterations as u32
    }

    fn iterate(&mut self, corridor: &[FrameCorridor]) {
        self.solve_for_x();
        let mut row = core::mem::take(&mut self.row);
        for order in 0..4 {
            differences(order, &self.x, &mut row);
            self.update_copy(order, &row, corridor);
        }
        self.row = row;
    }

    fn solve_for_x(&mut self) {
        for ((x, wished), nearness) in self.x.iter_mut().zip(self.wished).zip(self.nearness) {
            *x = *nearness * *wished;
        }
        let mut pulled = Vec::new();
        for (order, penalty) in self.penalty.into_iter().enumerate() {
            pulled.clear();
            pulled.extend(self.copy[order].iter().zip(&self.multiplier[order]).map(|(copy, m)| *copy - *m));
            add_transposed(order, &pulled, penalty, &mut self.x);
        }
        self.factor.solve(&mut self.x);
    }

    fn update_copy(&mut self, order: usize, row: &[DVec3], corridor: &[FrameCorridor]) {
        for (i, &value) in row.iter().enumerate() {
            let relaxed = RELAXATION * value + (1.0 - RELAXATION) * self.copy[order][i];
            let asked = relaxed + self.multiplier[order][i];
            let allowed = if order == 0 {
                corridor[i].pull_in(asked, SIGHT_SHARE)
            } else {
                asked.clamp_length_max(AIM_SHARE * self.reach[order - 1])
            };
            self.copy[order][i] = allowed;
            self.multiplier[order][i] = asked - allowed;
        }
    }

    fn holds(&self, corridor: &[FrameCorridor]) -> bool {
        let mut row = Vec::new();
        let smooth = (1..=3).all(|order| {
            differences(order, &self.x, &mut row);
            row.iter().all(|value| value.length() <= 0.995 * self.reach[order - 1])
        });
        smooth && self.x.iter().zip(corridor).all(|(x, frame)| frame.violation_m(*x) < 0.02)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clarabel::algebra::CscMatrix;
    use clarabel::solver::SupportedConeT::{NonnegativeConeT, SecondOrderConeT};
    use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus};
    use cosfly_random::Seed;
    use cosfly_surroundings::solid::HalfSpace;

    const FRAMES: usize = 24;
    const OBJECTIVE: Objective =
        Objective { rounds: 1, iterations: 20_000, nearness: 0.3, acceleration: 0.5, jerk: 2.0 };
    const REACH: [f64; 3] = [4.0, 1.2, 1.0];

    /// The same programme for an interior-point solver: positions frame by frame, axis by axis.
    fn by_interior_point(wished: &[DVec3], corridor: &[FrameCorridor]) -> Vec<DVec3> {
        let n = 3 * wished.len();
        let mut quadratic = vec![vec![0.0; n]; n];
        for order in [0, 2, 3] {
            let weight = [OBJECTIVE.nearness, 0.0, OBJECTIVE.acceleration, OBJECTIVE.jerk][order];
            let coefficients = super::super::banded::DIFFERENCES[order];
            for first in 0..wished.len() - order {
                for (a, ca) in coefficients.iter().enumerate() {
                    for (b, cb) in coefficients.iter().enumerate() {
                        for axis in 0..3 {
                            quadratic[3 * (first + a) + axis][3 * (first + b) + axis] += 2.0 * weight * ca * cb;
                        }
                    }
                }
            }
        }
        let linear: Vec<f64> =
            wished.iter().flat_map(|w| w.to_array()).map(|w| -2.0 * OBJECTIVE.nearness * w).collect();
        let (mut rows, mut right, mut cones) = (Vec::new(), Vec::new(), Vec::new());
        for (frame, corridor) in corridor.iter().enumerate() {
            for plane in &corridor.hard {
                let mut row = vec![0.0; n];
                row[3 * frame..3 * frame + 3].copy_from_slice(&(-plane.normal).to_array());
                rows.push(row);
                right.push(-plane.offset_m);
                cones.push(NonnegativeConeT(1));
            }
        }
        for order in 1..=3 {
            for first in 0..wished.len() - order {
                rows.push(vec![0.0; n]);
                right.push(AIM_SHARE * REACH[order - 1]);
                for axis in 0..3 {
                    let mut row = vec![0.0; n];
                    for (k, c) in super::super::banded::DIFFERENCES[order].iter().enumerate() {
                        row[3 * (first + k) + axis] = -c;
                    }
                    rows.push(row);
                    right.push(0.0);
                }
                cones.push(SecondOrderConeT(4));
            }
        }
        let (quadratic, rows) = (CscMatrix::from(&quadratic), CscMatrix::from(&rows));
        let settings = DefaultSettings { verbose: false, ..DefaultSettings::default() };
        let mut solver = DefaultSolver::new(&quadratic.to_triu(), &linear, &rows, &right, &cones, settings)
            .expect("a well-formed programme");
        solver.solve();
        assert_eq!(solver.solution.status, SolverStatus::Solved);
        solver.solution.x.chunks_exact(3).map(DVec3::from_slice).collect()
    }

    #[test]
    fn the_programme_ends_where_an_interior_point_solver_does() {
        let mut stream = Seed::of_item(3, "smoother", "clarabel").stream("t");
        for _ in 0..4 {
            let mut v = |low: f64, high: f64| stream.uniform(low, high);
            let wished: Vec<DVec3> = (0..FRAMES)
                .map(|i| DVec3::new(1.5 * i as f64 + v(-1.0, 1.0), v(-2.0, 2.0), 20.0 + v(-1.0, 1.0)))
                .collect();
            let corridor: Vec<FrameCorridor> = (0..FRAMES)
                .map(|i| {
                    let wall = HalfSpace { normal: DVec3::new(0.6, -0.8, 0.0), offset_m: 0.9 * i as f64 - 1.0 };
                    let floor = HalfSpace { normal: DVec3::Z, offset_m: 20.0 };
                    FrameCorridor::for_test(wished[i], vec![wall, floor])
                })
                .collect();
            let scale = [1.0; 4];
            let nearness = vec![OBJECTIVE.nearness; FRAMES];
            let mut programme = Programme::new(&nearness, OBJECTIVE, &wished, &wished, REACH, scale);
            for _ in 0..OBJECTIVE.iterations {
                programme.iterate(&corridor);
            }
            let other = by_interior_point(&wished, &corridor);
            let off = programme.x.iter().zip(&other).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            assert!(off < 2e-3, "{off} m apart");
        }
    }
}
