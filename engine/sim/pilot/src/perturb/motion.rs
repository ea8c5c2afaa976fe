//! Displacements of the drone that it could fly: drift, gusts, the expert's way early or late. World frame, metres.

use super::config::FlyableConfig;
use crate::aim::wander::Wander;
use cosfly_frames::{DVec3, real};
use cosfly_random::{RandomStream, Seed};

/// Height of the drift relative to its width.
const VERTICAL_SHARE: f64 = 0.4;
/// Steps of integration between two frames.
const STEPS: usize = 10;
/// Time in which a drone follows its wish, and in which it recovers from a gust, seconds.
const FOLLOWS_S: f64 = 1.2;
/// Time constant of the earliness, seconds.
const TIMING_WANDERS_S: f64 = 6.0;
/// Times of the expert's way are shifted by this at most, in standard deviations.
const MOST_DEVIATIONS: f64 = 2.5;
/// Shortest and longest gust, seconds.
const GUST_S: (f64, f64) = (1.0, 2.5);

/// A point that follows another one as a critically damped spring.
#[derive(Clone, Copy, Default)]
struct Spring {
    place: DVec3,
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
    fn frame(&mut self, wish: DVec3, push: impl Fn(f64) -> DVec3, dt_s: f64) {
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

/// A gust: when it begins and how long it lasts, seconds, and its largest acceleration.
struct Gust {
    from_s: f64,
    length_s: f64,
    peak_mps2: DVec3,
}

impl Gust {
    /// Acceleration at a time: half a sine.
    fn at(&self, time_s: f64) -> DVec3 {
        let share = (time_s - self.from_s) / self.length_s;
        if (0.0..1.0).contains(&share) { self.peak_mps2 * real::sin(real::PI * share) } else { DVec3::ZERO }
    }
}

/// Horizontal gusts at random times, from which the drone recovers.
pub(super) fn gusts(count: usize, dt_s: f64, config: &FlyableConfig, seed: &Seed) -> Vec<DVec3> {
    let mut stream = seed.stream("gusts");
    let mut gust = next_gust(0.0, config, &mut stream);
    let mut spring = Spring::default();
    let offset = |frame: usize| {
        let (here, now_s) = (spring.place, frame as f64 * dt_s);
        if now_s > gust.from_s + gust.length_s {
            gust = next_gust(now_s, config, &mut stream);
        }
        spring.frame(DVec3::ZERO, |since_s| gust.at(now_s + since_s), dt_s);
        here
    };
    (0..count).map(offset).collect()
}

fn next_gust(after_s: f64, config: &FlyableConfig, stream: &mut RandomStream) -> Gust {
    let from_s = after_s + waiting_s(config.gust_every_s, stream);
    let length_s = stream.uniform(GUST_S.0, GUST_S.1);
    let (sin, cos) = real::sin_cos(stream.uniform(-real::PI, real::PI));
    let peak_mps2 = stream.uniform(config.gust_mps2 / 3.0, config.gust_mps2) * DVec3::new(cos, sin, 0.0);
    Gust { from_s, length_s, peak_mps2 }
}

/// Time until the next of independent events with a mean distance, seconds (exponential, at most five times the mean).
pub(super) fn waiting_s(mean_s: f64, stream: &mut RandomStream) -> f64 {
    (-mean_s * real::ln(1.0 - stream.unit())).min(5.0 * mean_s)
}

/// Displacements of a drone that is on the expert's way, `places`, but early or late.
pub(super) fn timing(places: &[DVec3], dt_s: f64, config: &FlyableConfig, seed: &Seed) -> Vec<DVec3> {
    let most_s = MOST_DEVIATIONS * config.timing_s;
    let late = Wander::new(seed.stream("timing"), config.timing_s, TIMING_WANDERS_S, dt_s);
    let mut spring = Spring::default();
    let offset = |(frame, late_s): (usize, f64)| {
        let here_s = spring.place.x;
        spring.frame(DVec3::X * late_s.clamp(-most_s, most_s), |_| DVec3::ZERO, dt_s);
        on_way(places, frame as f64 - here_s / dt_s) - places[frame]
    };
    (0..places.len()).zip(late).map(offset).collect()
}

/// Place on a way at a frame number between its frames (a cubic with the way's mean velocities at both ends); before its
/// beginning and after its end the way stands still.
fn on_way(places: &[DVec3], frame: f64) -> DVec3 {
    let last = places.len() - 1;
    let at = frame.clamp(0.0, last as f64);
    let (first, t) = (at as usize, at.fract());
    let place = |offset: isize| places[first.saturating_add_signed(offset).min(last)];
    let (from, to) = (place(0), place(1));
    let (leaves, arrives) = (0.5 * (to - place(-1)), 0.5 * (place(2) - from));
    let (t2, t3) = (t * t, t * t * t);
    (2.0 * t3 - 3.0 * t2 + 1.0) * from + (t3 - 2.0 * t2 + t) * leaves + (3.0 * t2 - 2.0 * t3) * to + (t3 - t2) * arrives
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_way_is_met_at_its_frames_and_smooth_between_them() {
        let places: Vec<DVec3> = (0..9).map(|k| DVec3::new(f64::from(k), 0.1 * f64::from(k * k), 5.0)).collect();
        for (frame, place) in places.iter().enumerate() {
            assert!((on_way(&places, frame as f64) - *place).length() < 1e-12);
        }
        assert!((on_way(&places, 3.5) - DVec3::new(3.5, 0.1 * 12.25, 5.0)).length() < 1e-9);
        assert_eq!((on_way(&places, -4.0), on_way(&places, 99.0)), (places[0], places[8]));
    }

    #[test]
    fn displacements_have_the_asked_sizes() {
        let (config, seed) = (FlyableConfig::default(), Seed([4; 32]));
        let spread =
            |offsets: &[DVec3]| (offsets.iter().map(|it| it.x * it.x).sum::<f64>() / offsets.len() as f64).sqrt();
        let drifting = drift(20_000, 0.5, &config, &seed);
        assert!((1.7..2.6).contains(&spread(&drifting)), "{}", spread(&drifting));
        let gusty = gusts(20_000, 0.5, &config, &seed);
        let largest = gusty.iter().map(|it| it.length()).fold(0.0, f64::max);
        assert!((1.0..6.0).contains(&largest) && gusty.iter().all(|it| it.z == 0.0), "{largest}");
    }
}
