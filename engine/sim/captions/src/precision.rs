//! Precision of numbers in texts: the step to which each quantity is rounded. Templates and checker both keep to it.

use crate::facts::Facts;

/// Metres between drone and target, and of altitude.
pub const DISTANCE_STEP_M: f64 = 1.0;
/// Degrees of pitch.
pub const PITCH_STEP_DEG: f64 = 1.0;
/// Metres per second of walking.
pub const SPEED_STEP_MPS: f64 = 0.1;
/// Seconds of standing.
pub const STOP_STEP_S: f64 = 1.0;

/// Step for a time in seconds.
pub fn duration_step_s(duration_s: f64) -> f64 {
    match duration_s {
        brief if brief < 1.0 => 0.1,
        short if short < 30.0 => 1.0,
        _ => 5.0,
    }
}

/// Step for a way in metres.
pub fn way_step_m(way_m: f64) -> f64 {
    match way_m {
        brief if brief < 1.0 => 0.1,
        short if short < 30.0 => 1.0,
        middle if middle < 100.0 => 5.0,
        _ => 10.0,
    }
}

/// Whether a stated number is a multiple of the step, and no nearer multiple to the fact exists.
pub fn is_step(found: f64, fact: f64, step: f64) -> bool {
    let steps = found / step;
    (steps - steps.round()).abs() < 1e-6 && (found - fact).abs() <= 0.5 * step + 1e-6
}

/// Length, time and pace as read agree within this share.
const AGREE: f64 = 0.1;

/// How a text may state the pace, so that it agrees with the length and the time beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pace {
    /// The pace is the length over the time.
    Whole,
    /// The pace is that of walking, without the stops.
    WhileWalking,
    /// The text agrees with neither, as the numbers are rounded.
    Unsaid,
}

pub(crate) fn pace(facts: &Facts) -> Pace {
    let stated = |value: f64, step: f64| (value / step).round() * step;
    let way_m = stated(facts.way_m, way_step_m(facts.way_m));
    let time_s = stated(facts.duration_s, duration_step_s(facts.duration_s));
    let speed_mps = stated(facts.walking_speed_mps, SPEED_STEP_MPS);
    let agrees = |time_s: f64| (way_m - speed_mps * time_s).abs() <= AGREE * speed_mps * time_s;
    match () {
        () if agrees(time_s) => Pace::Whole,
        () if !facts.stops.is_empty() && agrees(time_s - stated(facts.standing_s(), STOP_STEP_S)) => Pace::WhileWalking,
        () => Pace::Unsaid,
    }
}
