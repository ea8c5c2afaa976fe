//! Precision of numbers in texts: the step to which each quantity is rounded. Templates and checker both keep to it.

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
    if duration_s < 30.0 { 1.0 } else { 5.0 }
}

/// Step for a way in metres.
pub fn way_step_m(way_m: f64) -> f64 {
    match way_m {
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
