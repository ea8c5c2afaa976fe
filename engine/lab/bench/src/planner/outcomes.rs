//! Plans every path of every scene with every contender, and keeps every flight.

use super::contender::Contender;
use super::figures::Flight;
use super::scene::Ground;
use crate::clock::timed;
use cosfly_planner::MucoConfig;

/// Options of the measurement.
pub struct PlannerOptions<'a> {
    /// Scenes with their paths.
    pub grounds: Vec<Ground>,
    /// Planners, in the order of the table.
    pub contenders: Vec<Contender>,
    /// Limits, view and weights of every contender but `paper`, which has its own weights.
    pub config: MucoConfig,
    /// Callback after every flight: finished and total numbers.
    pub progress: &'a (dyn Fn(usize, usize) + Sync),
}

/// One path, planned by every contender.
pub struct PathOutcome {
    /// Index of the ground.
    pub ground: usize,
    /// Number of the path.
    pub path: usize,
    /// Flights, one per contender.
    pub flights: Vec<Flight>,
}

/// Plans all paths and keeps every flight.
pub fn outcomes(options: &PlannerOptions<'_>) -> Vec<PathOutcome> {
    // One thread: parallel work of a planner counts as its own time as well.
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
