//! A simulation of a million trajectories on a thousand workers: how often the shared store and the engine are asked, what
//! waits for what, and what a crash costs. Deterministic: the same settings give the same table.
//!
//! Workers take commands of stages in the order of the pipeline. A command costs its CPU time, one round through the engine, and
//! operations of the store: a queue with a number of operations and of bytes per second. Numbers of operations were counted with
//! `strace` on `cosfly task run`.

use cosfly_frames::real::exp;
use cosfly_random::Seed;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Operations of a command apart from its tasks: locks, a temporary folder, two syncs.
const OPERATIONS_PER_COMMAND: f64 = 45.0;
/// Start of a process that decodes a town, seconds.
const START_S: f64 = 0.05;
/// Time of the engine for a command, seconds: one thread places all of them.
const ENGINE_S: f64 = 0.001;

/// Tasks of one stage for each walk, with measured costs of a task.
#[derive(Clone, Copy, Debug)]
pub struct FleetStage {
    /// Kind of the stage.
    pub name: &'static str,
    /// Tasks for each walk.
    pub per_walk: u64,
    /// CPU time, seconds.
    pub cpu_s: f64,
    /// Operations of the store.
    pub operations: f64,
    /// Bytes read, MB.
    pub read_mb: f64,
    /// Bytes written, MB.
    pub written_mb: f64,
    /// Tasks of one command.
    pub batch: u64,
}

/// The stages of `recipes/carla_town.toml` in its full look at 1280 x 720, measured on one core of the project's machine.
pub const STAGES: [FleetStage; 8] = [
    stage("walkers", 1, [0.004, 32.0, 1.0, 0.01], 16),
    stage("crowd", 1, [0.004, 36.0, 1.0, 0.01], 16),
    stage("expert", 1, [0.020, 42.0, 1.1, 0.10], 4),
    stage("perturbed", 1, [0.005, 46.0, 1.1, 0.10], 16),
    stage("nearby", 2, [0.030, 40.0, 1.1, 0.10], 4),
    stage("frames", 2, [10.900, 51.0, 1.2, 165.00], 1),
    stage("captions", 2, [0.002, 38.0, 1.1, 0.01], 64),
    stage("logs", 2, [0.450, 65.0, 166.0, 166.00], 1),
];

const fn stage(name: &'static str, per_walk: u64, costs: [f64; 4], batch: u64) -> FleetStage {
    let [cpu_s, operations, read_mb, written_mb] = costs;
    FleetStage { name, per_walk, cpu_s, operations, read_mb, written_mb, batch }
}

/// A fleet of workers and the store that they share.
#[derive(Clone, Copy, Debug)]
pub struct Fleet {
    /// Trajectories to make.
    pub trajectories: u64,
    /// Workers, one core each.
    pub workers: usize,
    /// Operations of the store per second.
    pub operations_per_s: f64,
    /// Bytes of the store per second, MB.
    pub mb_per_s: f64,
    /// Crashes of a worker per hour.
    pub crashes_per_hour: f64,
    /// Tasks share commands as by default; otherwise every task has its own.
    pub batches: bool,
}

/// Figures that the simulation shows.
#[derive(Clone, Debug)]
pub struct FleetFigures {
    /// Commands.
    pub commands: u64,
    /// Wall time, seconds.
    pub wall_s: f64,
    /// CPU time of all tasks, seconds.
    pub cpu_s: f64,
    /// Mean operations of the store per second.
    pub operations_per_s: f64,
    /// Operations in the busiest minute, per second.
    pub busiest_operations_per_s: f64,
    /// Mean MB of the store per second.
    pub mb_per_s: f64,
    /// Share of the workers' time in which they wait for the store.
    pub waiting_for_store: f64,
    /// Share of the workers' time in which they wait for the engine.
    pub waiting_for_engine: f64,
    /// Crashes, and the CPU time that they cost, seconds.
    pub crashes: u64,
    /// CPU time of the work that crashes lost, seconds.
    pub lost_s: f64,
    /// Reads of the town's map alone, per second: the most read key.
    pub town_reads_per_s: f64,
}

/// A server that does one thing after another.
#[derive(Default)]
struct Queue {
    free_at: f64,
}

impl Queue {
    /// End of work of `seconds` that arrives at `now`.
    fn serve(&mut self, now: f64, seconds: f64) -> f64 {
        self.free_at = self.free_at.max(now) + seconds;
        self.free_at
    }
}

/// Order of moments.
#[derive(PartialEq)]
struct Moment(f64);

impl Eq for Moment {}

impl PartialOrd for Moment {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Moment {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

/// Simulates the fleet.
pub fn simulate(fleet: &Fleet) -> FleetFigures {
    let mut random = Seed::of_item(1, "fleet", "all").stream("durations");
    let (mut operations_of_store, mut bytes_of_store, mut engine) =
        (Queue::default(), Queue::default(), Queue::default());
    let mut idle: BinaryHeap<Reverse<(Moment, usize)>> =
        (0..fleet.workers).map(|worker| Reverse((Moment(0.0), worker))).collect();
    let (mut commands, mut operations, mut mb, mut cpu, mut lost, mut crashes, mut reads) =
        (0, 0.0, 0.0, 0.0, 0.0, 0, 0.0);
    let (mut for_store, mut for_engine, mut end) = (0.0, 0.0, 0.0_f64);
    let mut minutes: Vec<f64> = Vec::new();
    for stage in STAGES {
        let tasks = fleet.trajectories.div_ceil(2) * stage.per_walk;
        let batch = if fleet.batches { stage.batch } else { 1 };
        let mut left = tasks;
        while left > 0 {
            let Some(Reverse((Moment(now), worker))) = idle.pop() else { break };
            let here = batch.min(left);
            commands += 1;
            let placed = engine.serve(now, ENGINE_S);
            let asked = OPERATIONS_PER_COMMAND + stage.operations * here as f64;
            // A node's page cache keeps the town for the tasks of one command, no longer.
            let moved = 1.0 + (stage.read_mb - 1.0 + stage.written_mb) * here as f64;
            let served = operations_of_store.serve(placed, asked / fleet.operations_per_s);
            let served = served.max(bytes_of_store.serve(placed, moved / fleet.mb_per_s));
            let work: f64 = (0..here).map(|_| stage.cpu_s * exp(random.normal(0.0, 0.25))).sum();
            let busy = START_S + work;
            let minute = (served / 60.0) as usize;
            minutes.resize(minutes.len().max(minute + 1), 0.0);
            minutes[minute] += asked;
            operations += asked;
            mb += moved;
            reads += 1.0;
            for_engine += placed - now;
            for_store += served - placed;
            let crashed = random.chance(1.0 - exp(-fleet.crashes_per_hour * busy / 3600.0));
            let took = if crashed { busy * random.unit() } else { busy };
            if crashed {
                crashes += 1;
                lost += took;
            } else {
                cpu += work;
                left -= here;
            }
            let ended = served + took;
            end = end.max(ended);
            idle.push(Reverse((Moment(ended), worker)));
        }
    }
    let wall = end.max(1e-9);
    let workers = wall * fleet.workers as f64;
    FleetFigures {
        commands,
        wall_s: wall,
        cpu_s: cpu,
        operations_per_s: operations / wall,
        busiest_operations_per_s: minutes.iter().fold(0.0, |most: f64, it| most.max(*it)) / 60.0,
        mb_per_s: mb / wall,
        waiting_for_store: for_store / workers,
        waiting_for_engine: for_engine / workers,
        crashes,
        lost_s: lost,
        town_reads_per_s: reads / wall,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fleet() -> Fleet {
        Fleet {
            trajectories: 2000,
            workers: 50,
            operations_per_s: 20_000.0,
            mb_per_s: 2000.0,
            crashes_per_hour: 0.0,
            batches: true,
        }
    }

    #[test]
    fn the_same_settings_give_the_same_figures_and_all_work_is_done() {
        let (first, second) = (simulate(&fleet()), simulate(&fleet()));
        assert_eq!(format!("{first:?}"), format!("{second:?}"));
        let expected: f64 = STAGES.iter().map(|stage| 1000.0 * stage.per_walk as f64 * stage.cpu_s).sum();
        assert!((first.cpu_s / expected - 1.03).abs() < 0.03, "{first:?}");
        assert!(first.wall_s >= first.cpu_s / 50.0);
    }

    #[test]
    fn a_slow_store_and_crashes_cost_time_and_crashes_lose_no_work() {
        let slow = simulate(&Fleet { operations_per_s: 500.0, ..fleet() });
        let crashing = simulate(&Fleet { crashes_per_hour: 20.0, ..fleet() });
        let calm = simulate(&fleet());
        assert!(slow.wall_s > calm.wall_s && slow.waiting_for_store > 0.3, "{slow:?}");
        assert!(crashing.crashes > 50 && crashing.wall_s > calm.wall_s, "{crashing:?}");
        assert!((crashing.cpu_s / calm.cpu_s - 1.0).abs() < 0.03);
    }

    #[test]
    fn commands_of_several_tasks_ask_less() {
        let alone = simulate(&Fleet { batches: false, ..fleet() });
        let together = simulate(&fleet());
        assert!(alone.commands > together.commands && alone.operations_per_s > together.operations_per_s);
    }
}
