//! Obstacles that are too near, targets inside of vehicles, targets that are seldom visible.

use cosfly_diagnose::counted;
use cosfly_episodes::{ExaminedEpisode, Flag};
use cosfly_frames::real;

/// Name of the flag of a film that hardly shows its target. Where cameras film a flight together, one of them may look elsewhere: the flag
/// counts where all have it.
pub const LOST: &str = "mostly-lost";
/// Share of frames with less than half of the target visible from which a flight is imperfect.
const MOSTLY_LOST: f64 = 0.5;

/// Checks clearance, overlap and visibility.
pub fn check(episode: &ExaminedEpisode) -> Vec<Flag> {
    [clearance(episode), overlap(episode), lost(episode)].into_iter().flatten().collect()
}

fn clearance(episode: &ExaminedEpisode) -> Option<Flag> {
    let nearest = episode.moments.iter().enumerate().filter_map(|(frame, it)| Some((frame, it.clearance_m?)));
    let (frame, metres) = nearest.min_by(|a, b| a.1.total_cmp(&b.1))?;
    if metres <= 0.0 {
        let message = format!("the drone is inside of an obstacle in frame {frame}");
        return Some(Flag::damage("collision", &episode.id, message));
    }
    let limit = episode.limits[0].filter(|limit| metres < *limit && !episode.is_perturbed)?;
    let message = format!("{metres:.2} m to the nearest obstacle in frame {frame}; the limit is {limit} m");
    Some(Flag::imperfect("clearance", &episode.id, message))
}

fn overlap(episode: &ExaminedEpisode) -> Option<Flag> {
    let inside = |frame: &usize| {
        let Some(target) = episode.moments[*frame].target_in_world else { return false };
        episode.vehicles.iter().any(|(center, half, yaw_rad)| {
            let (sin, cos) = real::sin_cos(*yaw_rad);
            let away = target - *center;
            let (along, across) = (cos * away.x + sin * away.y, cos * away.y - sin * away.x);
            along.abs() < half.x && across.abs() < half.y && away.z.abs() < half.z + 0.5 * episode.target_height_m
        })
    };
    let frames: Vec<usize> = (0..episode.moments.len()).filter(inside).collect();
    let first = frames.first()?;
    let message =
        format!("the target is inside of a vehicle in {}; the first is {first}", counted(frames.len(), "frame"));
    Some(Flag::imperfect("target-overlap", &episode.id, message))
}

fn lost(episode: &ExaminedEpisode) -> Option<Flag> {
    let stated: Vec<f64> = episode.moments.iter().filter_map(|it| it.visible).collect();
    let lost = stated.iter().filter(|share| **share < 0.5).count();
    let is_lost = !stated.is_empty() && lost as f64 > MOSTLY_LOST * stated.len() as f64;
    let message = || format!("less than half of the target is visible in {lost} of {} frames", stated.len());
    is_lost.then(|| Flag::imperfect(LOST, &episode.id, message()))
}
