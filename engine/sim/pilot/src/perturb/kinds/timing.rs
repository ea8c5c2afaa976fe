//! `timing`: the expert's way flown early or late.

use super::kind::{Departing, Departure, Kind, straight_on};
use crate::aim::wander::Wander;
use crate::perturb::motion::Spring;
use cosfly_frames::DVec3;

pub(super) const KIND: Kind = Kind {
    name: "timing",
    doc: "The drone flies the expert's way early or late, and so turns early or late.",
    departure: Departure::Flown { offsets: timing, views: straight_on },
};

/// Time constant of the earliness, seconds.
const WANDERS_S: f64 = 6.0;
/// Times of the expert's way are shifted by this at most, in standard deviations.
const MOST_DEVIATIONS: f64 = 2.5;

/// Displacements of a drone that is on the expert's way, `places`, but early or late.
fn timing(departing: &Departing<'_>) -> Vec<DVec3> {
    let Departing { places, dt_s, config, seed } = *departing;
    let most_s = MOST_DEVIATIONS * config.timing_s;
    let late = Wander::new(seed.stream("timing"), config.timing_s, WANDERS_S, dt_s);
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
}
