//! Displacements that a drone could fly: a spring that follows, the drift of every twin, waiting times. World frame, metres.

use super::sizes::FlyableConfig;
use crate::aim::wander::Wander;
use cosfly_frames::{DVec3, real};
use cosfly_random::{RandomStream, Seed};

/// Height of the drift relative to its width.
const VERTICAL_SHARE: f64 = 0.4;
/// Steps of integration between two frames.
const STEPS: usize = 10;
/// Time in which a drone follows its wish, and in which it recovers from a gust, seconds.
const FOLLOWS_S: f64 = 1.2;

/// A point that follows another one as a critically damped spring.
#[derive(Clone, Copy, Default)]
pub(super) struct Spring {
    /// Place, metres.
    pub place: DVec3,
    velocity: DVec3,
}

impl Spring {
    /// Moves on by a time step, drawn to `wish` and pushed by an acceleration (semi-implicit Euler).
    fn step(&mut self, wish: DVec3, push: DVec3, dt_s: f64) {
        let rate = 1.0 / FOLLOWS_S;
        self.velocity += dt_s * (push + rate * rate * (wish - self.place) - 2.0 * rate * self.velocity);
        self.place += dt_s * self.velocity;
    }

    /// Moves on by the time between two frames.
    pub fn frame(&mut self, wish: DVec3, push: impl Fn(f64) -> DVec3, dt_s: f64) {
        let step_s = dt_s / STEPS as f64;
        for step in 0..STEPS {
            self.step(wish, push(step as f64 * step_s), step_s);
        }
    }
}

/// A drift that wanders and returns.
pub(super) fn drift(count: usize, dt_s: f64, config: &FlyableConfig, seed: &Seed) -> Vec<DVec3> {
    let axis = |purpose, share: f64| Wander::new(seed.stream(purpose), share * config.drift_m, config.drift_s, dt_s);
    let wishes = axis("drift x", 1.0).zip(axis("drift y", 1.0)).zip(axis("drift z", VERTICAL_SHARE));
    let mut spring: Option<Spring> = None;
    let offset = |((x, y), z)| {
        let wish = DVec3::new(x, y, z);
        let moved = spring.get_or_insert(Spring { place: wish, velocity: DVec3::ZERO });
        let here = moved.place;
        moved.frame(wish, |_| DVec3::ZERO, dt_s);
        here
    };
    wishes.take(count).map(offset).collect()
}

/// Time until the next of independent events with a mean distance, seconds (exponential, at most five times the mean).
pub(super) fn waiting_s(mean_s: f64, stream: &mut RandomStream) -> f64 {
    (-mean_s * real::ln(1.0 - stream.unit())).min(5.0 * mean_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_drift_has_the_asked_size() {
        let (config, seed) = (FlyableConfig::default(), Seed([4; 32]));
        let spread =
            |offsets: &[DVec3]| (offsets.iter().map(|it| it.x * it.x).sum::<f64>() / offsets.len() as f64).sqrt();
        let drifting = drift(20_000, 0.5, &config, &seed);
        assert!((1.7..2.6).contains(&spread(&drifting)), "{}", spread(&drifting));
    }
}
