//! Plausibility of angles where the camera is unknown: a drone that shows its target looks towards it.

use cosfly_episodes::{ExaminedEpisode, Flag};
use cosfly_frames::real;
use std::f64::consts::{PI, TAU};

/// Largest angle between the optical axis and a visible target, radians.
const MOST_RAD: f64 = 60.0 * PI / 180.0;
/// Yaw fits from the first share of fitting frames on; below the second, a mistake is looked for.
const FITS: (f64, f64) = (0.7, 0.2);
/// A mistake explains the yaw where undoing it makes this share of the frames fit.
const EXPLAINED: f64 = 0.95;
/// Smallest number of frames with the target for a verdict.
const ENOUGH: usize = 8;

/// Name, description, and the change of an angle that undoes the mistake.
type Mistake = (&'static str, &'static str, fn(f64) -> f64);

/// Compares yaw with the direction to the target in all frames that show it.
pub fn check(episode: &ExaminedEpisode) -> Vec<Flag> {
    if episode.camera.is_some() {
        // Projection tells more.
        return vec![];
    }
    let shown = episode.moments.iter().filter(|it| it.visible_box.is_some());
    let pairs: Vec<(f64, f64)> = shown
        .filter_map(|it| {
            let away = it.target_in_world? - it.drone.position_in_world;
            (away.truncate().length() > 1.0).then(|| (it.drone.yaw_rad, real::atan2(away.y, away.x)))
        })
        .collect();
    if pairs.len() < ENOUGH {
        return vec![];
    }
    let fits = |mended: fn(f64) -> f64| {
        pairs.iter().filter(|(yaw, bearing)| wrapped(mended(*yaw) - bearing).abs() <= MOST_RAD).count() as f64
            / pairs.len() as f64
    };
    let own = fits(|yaw| yaw);
    let flag = |name, message: String| vec![Flag::damage(name, &episode.id, message)];
    if own > FITS.0 {
        return vec![];
    }
    let away = format!("it looks away from its target in {:.0} % of the frames that show it", 100.0 * (1.0 - own));
    let mistakes: [Mistake; 4] = [
        ("yaw-sign", "yaw has the wrong sign", |yaw| -yaw),
        ("angle-unit", "yaw is in degrees where radians are meant", f64::to_radians),
        ("angle-unit", "yaw is in radians where degrees are meant", f64::to_degrees),
        ("yaw-zero", "yaw counts from y instead of x", |yaw| 0.5 * PI - yaw),
    ];
    match mistakes.into_iter().find(|(_, _, mended)| fits(*mended) >= EXPLAINED) {
        Some((name, words, _)) => flag(name, format!("{words}: {away}")),
        None if own > FITS.1 => vec![],
        None => flag("pose-mismatch", format!("yaw does not fit: {away}")),
    }
}

/// An angle within half a turn.
fn wrapped(angle_rad: f64) -> f64 {
    angle_rad - TAU * (angle_rad / TAU).round()
}
