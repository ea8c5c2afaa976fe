//! Kinds of frames that are scored separately.

use crate::strata::is_seen;
use crate::windows::{Flights, Window};
use cosfly_windows::{Difficulty, WindowShape};
use std::collections::BTreeSet;

/// Frames before and from a frame on that say how hard it is.
const AROUND: usize = 5;

/// Kind and name of the first kinds; weathers follow.
const FIRST: [(&str, &str); 9] = [
    ("difficulty", "easy"),
    ("difficulty", "medium"),
    ("difficulty", "hard"),
    ("scene", "seen"),
    ("scene", "unseen"),
    ("target in the frame", "visible"),
    ("target in the frame", "occluded"),
    ("target", "moving"),
    ("target", "static"),
];

/// Kinds of the frames of a dataset.
pub struct FrameKinds {
    /// Kind and name of each, in the order of [`Self::of`]'s places.
    pub names: Vec<(&'static str, String)>,
    seen: Vec<bool>,
    weather: Vec<usize>,
}

impl FrameKinds {
    /// Kinds of the frames of all flights.
    pub fn new(flights: &Flights) -> Self {
        let weathers: BTreeSet<&str> = flights.rows.iter().map(|row| row.weather.as_str()).collect();
        let weathers: Vec<&str> = weathers.into_iter().collect();
        let place = |name: &str| weathers.iter().position(|it| *it == name).unwrap_or(0);
        let first = FIRST.iter().map(|(kind, name)| (*kind, (*name).to_owned()));
        Self {
            names: first.chain(weathers.iter().map(|name| ("weather", (*name).to_owned()))).collect(),
            seen: is_seen(flights),
            weather: flights.rows.iter().map(|row| FIRST.len() + place(&row.weather)).collect(),
        }
    }

    /// Places in [`Self::names`] of all frames of a flight: scene and weather.
    pub fn of_flight(&self, flight: usize) -> [usize; 2] {
        [if self.seen[flight] { 3 } else { 4 }, self.weather[flight]]
    }

    /// Places in [`Self::names`] of a frame, one of each kind.
    ///
    /// * difficulty and target: of the ten frames around it, five before and four after it, as for windows.
    /// * scene and weather: of its flight.
    /// * target in the frame: occluded when rays reach less than half of it.
    pub fn of(&self, flights: &Flights, flight: usize, frame: usize) -> [usize; 5] {
        let frames = flights.rows[flight].frames;
        let start = frame.saturating_sub(AROUND);
        let around = WindowShape { history: (frame + AROUND).min(frames) - start, horizon: 0, stride: 1 };
        let features = flights.features(Window { flight, start }, &around);
        let difficulty = match features.difficulty() {
            Difficulty::Easy => 0,
            Difficulty::Medium => 1,
            Difficulty::Hard => 2,
        };
        let [scene, weather] = self.of_flight(flight);
        [
            difficulty,
            scene,
            if flights.track(flight).visible[frame] < 0.5 { 6 } else { 5 },
            if features.target_is_static() { 8 } else { 7 },
            weather,
        ]
    }
}
