//! `gusts`: gusts push the drone aside, from which it recovers.

use super::kind::{Departing, Departure, Kind, straight_on};
use crate::perturb::motion::{Spring, waiting_s};
use crate::perturb::sizes::FlyableConfig;
use cosfly_frames::{DVec3, real};
use cosfly_random::RandomStream;

pub(super) const KIND: Kind = Kind {
    name: "gusts",
    doc: "Gusts push the drone aside, from which it recovers.",
    departure: Departure::Flown { offsets: gusts, views: straight_on },
};

/// Shortest and longest gust, seconds.
const GUST_S: (f64, f64) = (1.0, 2.5);

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
fn gusts(departing: &Departing<'_>) -> Vec<DVec3> {
    let Departing { places, dt_s, config, seed } = *departing;
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
    (0..places.len()).map(offset).collect()
}

fn next_gust(after_s: f64, config: &FlyableConfig, stream: &mut RandomStream) -> Gust {
    let from_s = after_s + waiting_s(config.gust_every_s, stream);
    let length_s = stream.uniform(GUST_S.0, GUST_S.1);
    let (sin, cos) = real::sin_cos(stream.uniform(-real::PI, real::PI));
    let peak_mps2 = stream.uniform(config.gust_mps2 / 3.0, config.gust_mps2) * DVec3::new(cos, sin, 0.0);
    Gust { from_s, length_s, peak_mps2 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_random::Seed;

    #[test]
    fn gusts_push_along_the_level_as_far_as_asked() {
        let (config, seed, places) = (FlyableConfig::default(), Seed([4; 32]), vec![DVec3::ZERO; 20_000]);
        let gusty = gusts(&Departing { places: &places, dt_s: 0.5, config: &config, seed: &seed });
        let largest = gusty.iter().map(|it| it.length()).fold(0.0, f64::max);
        assert!((1.0..6.0).contains(&largest) && gusty.iter().all(|it| it.z == 0.0), "{largest}");
    }
}
