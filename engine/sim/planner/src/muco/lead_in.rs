//! The way from a given start into a path: what is between them at first dies away along a cubic.

use crate::config::limits::LimitsConfig;
use cosfly_frames::DVec3;

/// Share of the limits that leading in from a given start may take.
const SHARE: f64 = 0.6;

/// Between the last given waypoint and a path at its frame: gap in metres, drift in metres per frame.
fn departure(head: &[DVec3], waypoints: &[DVec3]) -> Option<(DVec3, DVec3)> {
    let [.., before, start] = head else { return None };
    let first = head.len() - 1;
    let next = waypoints.get(first + 1)?;
    Some((start - waypoints[first], (start - before) - (next - waypoints[first])))
}

/// Frames over which [`lead_in`] keeps the limits of speed and acceleration; a whole number of 1 at least.
pub fn frames(head: &[DVec3], limits: &LimitsConfig, dt_s: f64, waypoints: &[DVec3]) -> f64 {
    let Some((gap, drift)) = departure(head, waypoints) else { return 1.0 };
    let (fastest, steepest) = (SHARE * limits.speed_mps * dt_s, SHARE * limits.acceleration_mps2 * dt_s * dt_s);
    // The cubic's steepest step is 1.5 gap / frames, its strongest bend 6 gap / frames^2 + 4 drift / frames.
    let by_speed = 1.5 * gap.length() / fastest;
    let half = 2.0 * drift.length() / steepest;
    let by_bend = half + (half * half + 6.0 * gap.length() / steepest).sqrt();
    by_speed.max(by_bend).ceil().clamp(1.0, waypoints.len() as f64)
}

/// Leads from the given waypoints into a path within `frames` frames: what is between them at first, in place and in
/// velocity, dies away.
pub fn lead_in(head: &[DVec3], frames: f64, waypoints: &mut [DVec3]) {
    if let Some((gap, drift)) = departure(head, waypoints) {
        for (i, waypoint) in waypoints.iter_mut().skip(head.len() - 1).enumerate() {
            let t = (i as f64 / frames).min(1.0);
            let left = 1.0 - t;
            *waypoint += gap * (left * left * (1.0 + 2.0 * t)) + drift * (frames * t * left * left);
        }
    }
    waypoints[..head.len()].copy_from_slice(head);
}
