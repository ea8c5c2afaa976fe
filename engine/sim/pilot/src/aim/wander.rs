//! Ornstein-Uhlenbeck processes, sampled at equal steps, and smooth ones.

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

/// Time constant of the filter of [`smooth`] relative to that of the process.
const FILTER_SHARE: f64 = 0.25;

/// A [`Wander`] with the same deviation and a continuous rate: the process goes through a filter of a quarter of its time
/// constant. What it does next can be seen from what it did.
pub fn smooth(stream: RandomStream, deviation: f64, time_s: f64, dt_s: f64) -> impl Iterator<Item = f64> {
    let followed = 1.0 - real::exp(-dt_s / (FILTER_SHARE * time_s).max(1e-9));
    let mut value: Option<f64> = None;
    // The filter leaves 1 / (1 + FILTER_SHARE) of the variance.
    Wander::new(stream, deviation * (1.0 + FILTER_SHARE).sqrt(), time_s, dt_s).map(move |wish| {
        let now = value.map_or(wish, |value| value + followed * (wish - value));
        value = Some(now);
        now
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_random::Seed;

    #[test]
    fn a_smooth_wander_has_its_deviation_and_goes_on_as_it_went() {
        let stream = Seed::of_item(1, "aim", "w").stream("smooth");
        let values: Vec<f64> = smooth(stream, 8.0, 20.0, 0.5).take(80_000).collect();
        let count = values.len() as f64;
        let spread = |of: &[f64]| (of.iter().map(|x| x * x).sum::<f64>() / count).sqrt();
        assert!((spread(&values) - 8.0).abs() < 0.6, "{}", spread(&values));
        let steps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let changes: Vec<f64> = steps.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(spread(&steps) < 0.5 && spread(&changes) < 0.6 * spread(&steps), "{}", spread(&steps));
    }

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
