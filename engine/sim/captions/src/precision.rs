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
