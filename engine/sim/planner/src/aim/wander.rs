//! Ornstein-Uhlenbeck processes, sampled exactly at equal steps.

use cosfly_frames::real;
use cosfly_random::RandomStream;

/// A correlated random value of mean 0 that wanders and returns.
pub struct Wander {
    stream: RandomStream,
    value: f64,
    /// Share of the value that remains after a step.
    kept: f64,
    deviation: f64,
}

impl Wander {
    /// The process with a standard deviation and a time constant, sampled every `dt_s`; begins in its stationary state.
    pub fn new(mut stream: RandomStream, deviation: f64, time_s: f64, dt_s: f64) -> Self {
        let value = stream.normal(0.0, deviation);
        Self { stream, value, kept: real::exp(-dt_s / time_s.max(1e-9)), deviation }
    }
}

impl Iterator for Wander {
    type Item = f64;

    fn next(&mut self) -> Option<f64> {
        let now = self.value;
        let fresh = self.deviation * (1.0 - self.kept * self.kept).max(0.0).sqrt();
        self.value = self.kept * now + self.stream.normal(0.0, fresh);
        Some(now)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_random::Seed;

    #[test]
    fn a_wander_has_its_deviation_and_its_correlation() {
        let stream = Seed::of_item(1, "aim", "w").stream("wander");
        let values: Vec<f64> = Wander::new(stream, 3.0, 2.0, 0.5).take(40_000).collect();
        let count = values.len() as f64;
        let variance = values.iter().map(|x| x * x).sum::<f64>() / count;
        let next = values.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / count;
        assert!((variance.sqrt() - 3.0).abs() < 0.15, "{variance}");
        assert!((next / variance - real::exp(-0.25)).abs() < 0.02, "{}", next / variance);
    }
}
