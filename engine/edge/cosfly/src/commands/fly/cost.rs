//! [`Clock`]: time that flights take. Nothing but a line for people depends on it.

use cosfly_runner::{processor_s, processor_s_of_children};
use std::time::Instant;

/// Measures flights from its start on.
pub struct Clock {
    started: Instant,
    core_s: Option<f64>,
}

/// Core-seconds of this program and of policies in Python that have ended.
fn core_s() -> Option<f64> {
    processor_s().zip(processor_s_of_children()).map(|(own_s, children_s)| own_s + children_s)
}

impl Clock {
    /// Begins to measure.
    pub fn start() -> Self {
        Self { started: Instant::now(), core_s: core_s() }
    }

    /// Time of each of `episodes` flights until now, in words.
    pub fn words(&self, episodes: usize) -> String {
        let each = |seconds: f64| {
            let each_s = seconds / episodes.max(1) as f64;
            if each_s < 10.0 { format!("{each_s:.3}") } else { format!("{each_s:.0}") }
        };
        let seconds = each(self.started.elapsed().as_secs_f64());
        let cores = core_s().zip(self.core_s).map(|(now_s, then_s)| each(now_s - then_s));
        let cores = cores.map_or(String::new(), |cores| format!(" and {cores} core-seconds"));
        format!("{seconds} s{cores} an episode")
    }
}
