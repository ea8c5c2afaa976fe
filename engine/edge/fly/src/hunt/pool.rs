//! [`Pool`]: the candidates of a hunt: episodes of a recipe with values drawn from ranges.
//!
//! A *world* is a seed and values that change towns, walks and crowds; its episodes are made once and flown in several *airs*: values of
//! `[tool.fly]`. Draw number `n` is the same in every hunt with the same seed, however many there are.

use super::range::{DrawnChange, HuntRange};
use crate::benchmark::Tier;
use crate::suite::Suite;
use cosfly_frames::Seed;

/// Airs of a world.
const AIRS: u64 = 4;

/// A recipe with drawn values.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    /// Number of its world.
    pub world: usize,
    /// Changes as of `--set`.
    pub changes: Vec<String>,
    /// Places of the values in their ranges, 0..=1.
    pub places: Vec<f64>,
}

/// The draws of a world: one for each air.
pub fn draws(name: &str, seed: u64, ranges: &[HuntRange], world: usize) -> Vec<Draw> {
    let of = |purpose: &str, number: u64| Seed::of_item(seed, "hunt", name).child(purpose, number).stream("values");
    let (air, ground): (Vec<&HuntRange>, Vec<&HuntRange>) = ranges.iter().partition(|range| range.is_of_air());
    let mut stream = of("world", world as u64);
    // Whole numbers of TOML have a sign.
    let world_seed = stream.bits() >> 1;
    let values: Vec<DrawnChange> = ground.iter().map(|range| range.drawn(&mut stream)).collect();
    let airs = if air.is_empty() { 1 } else { AIRS };
    let draw = |number: u64| {
        let mut stream = of("air", world as u64 * AIRS + number);
        let values = values.iter().cloned().chain(air.iter().map(|range| range.drawn(&mut stream)));
        let (changes, places): (Vec<String>, Vec<f64>) = values.map(|drawn| (drawn.change, drawn.place)).unzip();
        let own = [format!("name=\"{name}_{}_{}\"", world + 1, number + 1), format!("seed={world_seed}")];
        Draw { world, changes: own.into_iter().chain(changes).collect(), places }
    };
    (0..airs).map(draw).collect()
}

/// The candidates.
pub struct Pool {
    /// All episodes.
    pub suite: Suite,
    /// The draw of each part of the suite.
    pub draws: Vec<Draw>,
}

impl Pool {
    /// The episodes of suites, one for each draw; at most `most`.
    pub fn of(name: String, suites: Vec<Suite>, draws: Vec<Draw>, most: usize) -> Self {
        let mut suite = Tier { name, episodes: usize::MAX, only: None }.of(suites);
        suite.tasks.truncate(most);
        Self { suite, draws }
    }

    /// World and walk of a candidate: candidates that differ in the air have the same.
    pub fn walk(&self, task: usize) -> (usize, &str) {
        let task = &self.suite.tasks[task];
        let own = task.episode.name.strip_prefix(&self.suite.parts[task.part].name);
        (self.draws[task.part].world, own.unwrap_or(&task.episode.name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_are_the_same_again_and_airs_share_their_world() {
        let ranges = ["tool.fly.latency_ms=0..400", "stages.walkers.speed.mean_mps=1..2"];
        let ranges = ranges.map(|range| HuntRange::read(range).expect("a range"));
        let made = draws("street", 1, &ranges, 3);
        assert_eq!(made, draws("street", 1, &ranges, 3));
        assert_eq!(made.len(), 4);
        assert!(made.iter().all(|draw| draw.changes[1..3] == made[0].changes[1..3] && draw.places.len() == 2));
        assert!(made[0].changes[3] != made[1].changes[3] && made[0].changes[0] == "name=\"street_4_1\"");
        assert_ne!(made[0].changes[1], draws("street", 2, &ranges, 3)[0].changes[1]);
        assert_eq!(draws("street", 1, &[], 0).len(), 1);
    }
}
