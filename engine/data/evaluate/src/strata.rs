//! Kinds of windows that are scored separately.

use crate::windows::{Flights, Window, WindowSet};
use cosfly_schema::TownLayout;
use cosfly_windows::{Difficulty, WindowShape};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Number of strata.
pub const COUNT: usize = 9;

/// Kind and name of each stratum; a window is in one of each kind.
pub const STRATA: [(&str, &str); COUNT] = [
    ("difficulty", "easy"),
    ("difficulty", "medium"),
    ("difficulty", "hard"),
    ("scene", "seen"),
    ("scene", "unseen"),
    ("target in the input", "visible"),
    ("target in the input", "occluded"),
    ("target", "moving"),
    ("target", "static"),
];

/// Places in [`STRATA`], one bit each.
pub type WindowStrata = u16;

/// The strata of every window of the flights of `part`, which are loaded.
///
/// * difficulty: see [`cosfly_windows::WindowFeatures::difficulty`].
/// * scene: a town is seen when a flight of split `train` is in a town of the same ground plan, whatever its name.
/// * target in the input: occluded when rays reach less than half of it in an input frame.
/// * target: static when it stays within half a metre during the window.
pub fn memberships(
    flights: &Flights,
    windows: &WindowSet,
    seen: &[bool],
    part: &[(usize, usize)],
) -> Vec<Vec<WindowStrata>> {
    let of_flight = |entry: &(usize, usize)| -> Vec<WindowStrata> {
        let row = &flights.rows[entry.0];
        let scene = if seen[entry.0] { 3 } else { 4 };
        let numbered = windows.of_flight(*entry, row.frames);
        numbered.map(|(_, window)| (1 << scene) | of_window(flights, window, &windows.shape)).collect()
    };
    part.par_iter().map(of_flight).collect()
}

/// Whether a flight of split `train` is in a town of the same ground plan, for every flight.
pub fn is_seen(flights: &Flights) -> Vec<bool> {
    let train = flights.rows.iter().filter(|row| row.split == "train");
    let seen: BTreeMap<&str, &TownLayout> =
        train.map(|row| (row.town_layout.digest.as_str(), &*row.town_layout)).collect();
    // Each town is compared with those of the training split once.
    let layouts: BTreeMap<&str, &TownLayout> =
        flights.rows.iter().map(|row| (row.town_layout.digest.as_str(), &*row.town_layout)).collect();
    let is_seen = |layout: &TownLayout| {
        seen.contains_key(layout.digest.as_str()) || seen.values().any(|it| it.is_same_place(layout))
    };
    let known: BTreeMap<&str, bool> = layouts.into_iter().map(|(digest, layout)| (digest, is_seen(layout))).collect();
    flights.rows.iter().map(|row| known[row.town_layout.digest.as_str()]).collect()
}

fn of_window(flights: &Flights, window: Window, shape: &WindowShape) -> WindowStrata {
    let features = flights.features(window, shape);
    let difficulty = match features.difficulty() {
        Difficulty::Easy => 0,
        Difficulty::Medium => 1,
        Difficulty::Hard => 2,
    };
    let input = &flights.track(window.flight).visible[window.start..window.start + shape.history];
    let occluded = if input.iter().any(|visible| *visible < 0.5) { 6 } else { 5 };
    let target = if features.target_is_static() { 8 } else { 7 };
    (1 << difficulty) | (1 << occluded) | (1 << target)
}
