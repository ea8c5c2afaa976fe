//! Plans every path of every scene with every contender, and keeps every flight.

use super::contender::Contender;
use super::figures::Flight;
use super::scene::Ground;
use crate::clock::timed;
use cosfly_planner::MucoConfig;

/// Grounds, contenders and limits of a measurement.
pub struct PlannerOptions<'a> {
    /// Maps and targets.
    pub grounds: Vec<Ground>,
    /// Planners, in the order of the table.
    pub contenders: Vec<Contender>,
    /// Limits, view and weights of every contender but `paper`, which has its own weights.
    pub config: MucoConfig,
    /// Told after every flight: how many of how many are done.
    pub progress: &'a (dyn Fn(usize, usize) + Sync),
}

/// One path, planned by everyone.
pub struct PathOutcome {
    /// Index of the ground.
    pub ground: usize,
    /// Number of the path.
    pub path: usize,
    /// One per contender.
    pub flights: Vec<Flight>,
}

/// Plans everything and keeps every flight.
pub fn outcomes(options: &PlannerOptions<'_>) -> Vec<PathOutcome> {
    // One thread: what a planner would do in parallel counts as its own time, too.
    match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
        Ok(pool) => pool.install(|| outcomes_on_this_thread(options)),
        Err(_) => outcomes_on_this_thread(options),
    }
}

fn outcomes_on_this_thread(options: &PlannerOptions<'_>) -> Vec<PathOutcome> {
    let paths: usize = options.grounds.iter().map(|ground| ground.tracks.len()).sum();
    let total = paths * options.contenders.len();
    let mut done = 0;
    let mut outcomes = Vec::with_capacity(paths);
    for (index, ground) in options.grounds.iter().enumerate() {
        for (path, track) in ground.tracks.iter().enumerate() {
            let mut flights = Vec::with_capacity(options.contenders.len());
            for contender in &options.contenders {
                let (planned, cpu_s) = timed(|| contender.plan(ground, track, &options.config));
                flights.push(Flight::judge(planned, cpu_s, track, ground.exact.as_ref(), &options.config));
                done += 1;
                (options.progress)(done, total);
            }
            outcomes.push(PathOutcome { ground: index, path, flights });
        }
    }
    outcomes
}
