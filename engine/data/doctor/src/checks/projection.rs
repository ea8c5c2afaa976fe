//! Agreement of poses and boxes: the projected target is compared with its place in the image. Where they differ, the usual
//! mistakes are tried, and the one that explains the difference is named.

use super::median::median;
use super::motion::frames;
use cosfly_domain::Camera;
use cosfly_episodes::{ExaminedEpisode, Flag};
use cosfly_frames::Pose;

/// Largest distance of a box's middle from the projected middle: share of the box's height, and pixels.
const TOLERANCE: (f64, f64) = (0.35, 3.0);
/// A mistake explains a mismatch where undoing it makes the error this many times smaller.
const GAIN: f64 = 2.5;
/// Smallest number of frames for a verdict.
const ENOUGH: usize = 3;

/// Name, description, and the change of the pose that undoes the mistake.
type Mistake = (&'static str, &'static str, fn(Pose) -> Pose);

const MISTAKES: [Mistake; 4] = [
    ("yaw-sign", "the yaw has the wrong sign", |pose| Pose { yaw_rad: -pose.yaw_rad, ..pose }),
    ("pitch-sign", "the pitch has the wrong sign", |pose| Pose { pitch_rad: -pose.pitch_rad, ..pose }),
    ("angle-unit", "angles are radians where degrees belong", |pose| Pose {
        pitch_rad: pose.pitch_rad.to_degrees(),
        yaw_rad: pose.yaw_rad.to_degrees(),
        ..pose
    }),
    ("yaw-zero", "the yaw is measured from another axis (90° off)", |pose| Pose {
        yaw_rad: pose.yaw_rad + std::f64::consts::FRAC_PI_2,
        ..pose
    }),
];

/// Finds the mistake that explains the places of boxes.
pub fn check(episode: &ExaminedEpisode) -> Vec<Flag> {
    let Some(camera) = episode.camera else { return vec![] };
    let Some(own) = error(episode, &camera, 0, |pose| pose) else { return vec![] };
    let shifts = [-1, 1, -2, 2, -3, 3].map(|shift| (shift, error(episode, &camera, shift, |pose| pose)));
    let best = shifts.iter().filter_map(|(shift, error)| Some((*shift, (*error)?))).min_by(|a, b| a.1.total_cmp(&b.1));
    let flag = |name, message: String| vec![Flag::damage(name, &episode.id, message)];
    // A shift of smooth flights stays near the box: the gain tells, not the tolerance alone.
    if let Some((shift, error)) = best.filter(|it| it.1 * GAIN < own && own > 0.35 && it.1 <= 1.0) {
        let message = format!(
            "poses fit the boxes of {}: the target is {own:.1} boxes away, {error:.2} when frames are shifted",
            frames(shift)
        );
        return flag("frame-shift", message);
    }
    if own <= 1.0 {
        return vec![];
    }
    for (name, words, mended) in MISTAKES {
        if error(episode, &camera, 0, mended).is_some_and(|error| error <= 1.0) {
            return flag(name, format!("{words}: the target is {own:.1} boxes away from where the image shows it"));
        }
    }
    flag("pose-mismatch", format!("poses do not fit the boxes: the target is {own:.1} boxes away in the middle frame"))
}

/// Median distance between the projected and the shown middle, in units of the tolerance. `shift` takes the pose and the target
/// of another frame.
fn error(episode: &ExaminedEpisode, camera: &Camera, shift: i64, mended: fn(Pose) -> Pose) -> Option<f64> {
    let moments = &episode.moments;
    let mut errors = vec![];
    for (frame, moment) in moments.iter().enumerate() {
        let Some((u, v, height)) = moment.in_image else { continue };
        // Boxes at an edge are cut; their middles are not the body's.
        let half = 0.5 * height;
        let inside = u > half && v > half && u < f64::from(camera.width) - half && v < f64::from(camera.height) - half;
        let Some(from) = frame.checked_add_signed(-shift as isize).and_then(|at| moments.get(at)) else { continue };
        let Some(target) = from.target_in_world.filter(|_| inside) else { continue };
        let tolerated = TOLERANCE.0 * height + TOLERANCE.1;
        errors.push(match camera.project(&mended(from.camera), target) {
            Some((x, y, _)) => ((x - u) * (x - u) + (y - v) * (y - v)).sqrt() / tolerated,
            None => f64::from(camera.width),
        });
    }
    if errors.len() < ENOUGH {
        return None;
    }
    // Smooth flights keep their target in the middle: the worst tenth tells more of a shift than the median.
    if shift == 0 { Some(median(errors.iter().copied())?.max(tail(&errors))) } else { Some(tail(&errors)) }
}

/// The 0.9 quantile.
fn tail(errors: &[f64]) -> f64 {
    let mut sorted = errors.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() * 9 / 10).or(sorted.last()).copied().unwrap_or_default()
}
