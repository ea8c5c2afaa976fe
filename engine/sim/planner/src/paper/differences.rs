//! The gradient of the whole cost by coordinate-wise differences, on one thread or on all, with the same bytes.

use crate::obstacles::Surroundings;
use crate::problem::Problem;
use crate::terms::{TermContext, WeightedTerm};
use cosfly_frames::DVec3;
use rayon::prelude::*;

/// Who computes a gradient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Threads {
    /// The calling thread: best where whole trajectories are planned in parallel.
    Caller,
    /// The rayon pool, when it has more than one thread: best for one trajectory at a time.
    Pool,
}

/// What terms see in these surroundings.
pub fn context<'a>(problem: &Problem<'a>, surroundings: &'a dyn Surroundings) -> TermContext<'a> {
    TermContext { track: problem.track, view: problem.view, walk: problem.walk, surroundings }
}

/// One evaluation of one term: every `stride`-th waypoint from `first` moved by `step_m` along `axis`.
struct Probe<'a> {
    weighted: &'a WeightedTerm,
    first: usize,
    stride: usize,
    axis: usize,
    step_m: f64,
}

impl Probe<'_> {
    fn costs(&self, waypoints: &[DVec3], context: &TermContext<'_>) -> Vec<f64> {
        let mut moved = waypoints.to_vec();
        moved.iter_mut().skip(self.first).step_by(self.stride).for_each(|w| w[self.axis] += self.step_m);
        let mut costs = vec![0.0; waypoints.len()];
        self.weighted.term.cost(&moved, context, &mut costs);
        costs
    }
}

/// Central differences of the weighted sum of all terms, metres apart by twice `step_m` (paper, section 3.3:
/// coordinate-wise, 0.5 m). A waypoint's cost is its own and that of the neighbours that read it, so waypoints out of
/// each other's reach are moved together.
pub fn gradient(
    problem: &Problem<'_>,
    surroundings: &(dyn Surroundings + Sync),
    step_m: f64,
    threads: Threads,
    waypoints: &[DVec3],
) -> Vec<DVec3> {
    let probes = probes(problem.terms, step_m, waypoints.len());
    let evaluate = |probe: &Probe<'_>| probe.costs(waypoints, &context(problem, surroundings));
    let costs: Vec<Vec<f64>> = if threads == Threads::Pool && rayon::current_num_threads() > 1 {
        probes.par_iter().map(evaluate).collect()
    } else {
        probes.iter().map(evaluate).collect()
    };
    let mut gradient = vec![DVec3::ZERO; waypoints.len()];
    for (pair, costs) in probes.chunks_exact(2).zip(costs.chunks_exact(2)) {
        let (probe, reach) = (&pair[0], (pair[0].stride - 1) / 2);
        let factor = probe.weighted.weight / (2.0 * step_m);
        for i in (probe.first..waypoints.len()).step_by(probe.stride) {
            let readers = i.saturating_sub(reach)..(i + reach + 1).min(waypoints.len());
            let change: f64 = readers.map(|n| costs[0][n] - costs[1][n]).sum();
            gradient[i][probe.axis] += factor * change;
        }
    }
    gradient
}

/// In pairs: the step forward, then the step back.
fn probes(terms: &[WeightedTerm], step_m: f64, frames: usize) -> Vec<Probe<'_>> {
    let mut probes = Vec::new();
    for weighted in terms.iter().filter(|weighted| weighted.weight > 0.0) {
        let stride = weighted.term.support().saturating_mul(2).saturating_add(1);
        for first in 0..stride.min(frames) {
            for axis in 0..3 {
                for step_m in [step_m, -step_m] {
                    probes.push(Probe { weighted, first, stride, axis, step_m });
                }
            }
        }
    }
    probes
}

#[cfg(test)]
mod tests {
    use super::super::pipeline::tests::with_street;
    use super::*;
    use crate::gradient::total_cost;

    #[test]
    fn it_is_the_difference_of_the_whole_cost() {
        with_street(|problem, obstacles, _, path| {
            obstacles.focus_on(path);
            let found = gradient(problem, obstacles, 0.5, Threads::Caller, path);
            let cost = |path: &[DVec3]| total_cost(problem.terms, path, &context(problem, obstacles));
            for i in [0, 1, 17, 60, path.len() - 1] {
                for axis in 0..3 {
                    let mut moved = path.to_vec();
                    moved[i][axis] += 0.5;
                    let above = cost(&moved);
                    moved[i][axis] = path[i][axis] - 0.5;
                    let slope = above - cost(&moved);
                    assert!((slope - found[i][axis]).abs() < 1e-6 * (1.0 + slope.abs()), "{i} {slope}");
                }
            }
        });
    }

    #[test]
    fn one_thread_and_four_give_the_same_bytes() {
        with_street(|problem, obstacles, _, path| {
            obstacles.focus_on(path);
            let surroundings: &(dyn Surroundings + Sync) = obstacles;
            let alone = gradient(problem, surroundings, 0.5, Threads::Caller, path);
            let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build().unwrap();
            let (problem, path) = (&*problem, &*path);
            let together = pool.install(|| gradient(problem, surroundings, 0.5, Threads::Pool, path));
            assert_eq!(alone, together);
        });
    }
}
