//! The gradient of the whole cost by coordinate-wise differences, on one thread or on all, with the same bytes.

use super::window::Window;
use crate::problem::Problem;
use crate::terms::term::{CostTerm, TermContext};
use core::ops::Range;
use cosfly_frames::DVec3;
use cosfly_surroundings::Surroundings;
use rayon::prelude::*;

/// Frames that a thread of many takes at a time.
const FRAMES_PER_TASK: usize = 16;
/// Frames that a single thread takes at a time, so that long flights stay in its cache.
const FRAMES_AT_ONCE: usize = 256;

/// Threads that compute a gradient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Threads {
    /// The calling thread: best where whole trajectories are planned in parallel.
    Caller,
    /// The rayon pool, when it has more than one thread: best for one trajectory at a time.
    Pool,
}

/// The terms' context in these surroundings.
pub fn context<'a>(problem: &Problem<'a>, surroundings: &'a dyn Surroundings) -> TermContext<'a> {
    TermContext { track: problem.track, view: problem.view, walk: problem.walk, surroundings }
}

/// Central differences of the weighted sum of all terms, `step_m` to each side (paper, section 3.3: coordinate-wise,
/// 0.5 m). Built-in terms are taken for a few frames at a time, in parallel over the waypoints as the paper does; terms
/// from elsewhere may read anything of a flight, so each is taken for the whole of it.
pub fn gradient(
    problem: &Problem<'_>,
    surroundings: &(dyn Surroundings + Sync),
    step_m: f64,
    threads: Threads,
    waypoints: &[DVec3],
) -> Vec<DVec3> {
    let frames = waypoints.len();
    let parallel = threads == Threads::Pool && rayon::current_num_threads() > 1;
    let share = if parallel { FRAMES_PER_TASK } else { FRAMES_AT_ONCE };
    let chunks: Vec<Range<usize>> =
        (0..frames).step_by(share).map(|first| first..(first + share).min(frames)).collect();
    let built_in = |chunk: &Range<usize>| built_in_gradient(problem, surroundings, step_m, waypoints, chunk);
    let others: Vec<_> = problem.terms.iter().skip(problem.built_in).filter(|other| other.weight > 0.0).collect();
    let other = |index: usize| {
        let mut gradient = vec![DVec3::ZERO; frames];
        let context = context(problem, surroundings);
        let weighted = others[index];
        add_differences(weighted.term.as_ref(), weighted.weight, step_m, waypoints, 0..frames, &context, &mut gradient);
        gradient
    };
    let (parts, extra): (Vec<Vec<DVec3>>, Vec<Vec<DVec3>>) = if parallel {
        (chunks.par_iter().map(built_in).collect(), (0..others.len()).into_par_iter().map(other).collect())
    } else {
        (chunks.iter().map(built_in).collect(), (0..others.len()).map(other).collect())
    };
    let mut gradient = parts.concat();
    for part in extra {
        gradient.iter_mut().zip(part).for_each(|(sum, slope)| *sum += slope);
    }
    gradient
}

/// The built-in terms' part of the gradient at the frames of `chunk`.
fn built_in_gradient(
    problem: &Problem<'_>,
    surroundings: &dyn Surroundings,
    step_m: f64,
    waypoints: &[DVec3],
    chunk: &Range<usize>,
) -> Vec<DVec3> {
    let mut gradient = vec![DVec3::ZERO; chunk.len()];
    for weighted in problem.terms.iter().take(problem.built_in).filter(|weighted| weighted.weight > 0.0) {
        let margin = 2 * weighted.term.support();
        let window = Window::cut(problem, surroundings, waypoints, chunk.clone(), margin);
        let (term, inner) = (weighted.term.as_ref(), window.inner.clone());
        let context = window.context();
        add_differences(term, weighted.weight, step_m, &window.waypoints, inner, &context, &mut gradient);
    }
    gradient
}

/// Adds `weight` times the differences of a term at the frames `inner` of `waypoints` to `gradient`, which is as long as
/// `inner`. The cost of a waypoint is its own and that of the neighbours that read it, so waypoints out of each other's
/// reach are moved together.
fn add_differences(
    term: &dyn CostTerm,
    weight: f64,
    step_m: f64,
    waypoints: &[DVec3],
    inner: Range<usize>,
    context: &TermContext<'_>,
    gradient: &mut [DVec3],
) {
    let reach = term.support().min(waypoints.len());
    let stride = 2 * reach + 1;
    let factor = weight / (2.0 * step_m);
    let mut moved = waypoints.to_vec();
    let (mut above, mut below) = (vec![0.0; waypoints.len()], vec![0.0; waypoints.len()]);
    for first in inner.start..inner.end.min(inner.start + stride) {
        let moving = || (first..inner.end).step_by(stride);
        for axis in 0..3 {
            for (step, costs) in [(step_m, &mut above), (-step_m, &mut below)] {
                moving().for_each(|i| moved[i][axis] = waypoints[i][axis] + step);
                term.cost(&moved, context, costs);
            }
            for i in moving() {
                moved[i][axis] = waypoints[i][axis];
                let readers = i.saturating_sub(reach)..(i + reach + 1).min(waypoints.len());
                let change: f64 = readers.map(|n| above[n] - below[n]).sum();
                gradient[i - inner.start][axis] += factor * change;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::with_street;
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
            let path = &path[..];
            let together = pool.install(|| gradient(problem, surroundings, 0.5, Threads::Pool, path));
            assert_eq!(alone, together);
        });
    }

    /// Half the square of the distance of every waypoint from the one in the middle.
    struct FromTheMiddle;

    impl CostTerm for FromTheMiddle {
        fn name(&self) -> &str {
            "from_the_middle"
        }
        fn support(&self) -> usize {
            usize::MAX
        }
        fn cost(&self, waypoints: &[DVec3], _: &TermContext<'_>, per_frame: &mut [f64]) {
            let middle = waypoints[waypoints.len() / 2];
            per_frame.iter_mut().zip(waypoints).for_each(|(cost, w)| *cost = 0.5 * w.distance_squared(middle));
        }
    }

    #[test]
    fn a_term_from_elsewhere_may_read_the_whole_flight() {
        with_street(|problem, obstacles, _, path| {
            obstacles.focus_on(path);
            let term = Box::new(FromTheMiddle);
            let terms = [crate::terms::WeightedTerm { term, weight: 2.0 }];
            let alone = Problem { terms: &terms, built_in: 0, ..*problem };
            let found = gradient(&alone, obstacles, 0.5, Threads::Caller, path);
            let middle = path[path.len() / 2];
            for (slope, w) in found.iter().zip(&*path) {
                if *w != middle {
                    assert!((*slope - 2.0 * (w - middle)).length() < 1e-6);
                }
            }
            assert_eq!(found, gradient(&alone, obstacles, 0.5, Threads::Pool, path));
        });
    }
}
