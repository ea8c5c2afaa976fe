//! Assignment of depth images to frames, by walls: seen from the right pose, the points of a building in a depth image lie on
//! the building's boxes. Finds shifts of smooth flights, whose distance to the target hardly changes.

use super::median::median;
use super::motion::frames;
use cosfly_episodes::episode::OFFSETS;
use cosfly_episodes::{ExaminedEpisode, Flag};

/// Smallest number of frames with walls in view for a verdict.
const ENOUGH: usize = 4;
/// Largest distance of a point on a wall from the wall, metres; the step of stored depths is smaller.
const ON_M: f64 = 0.03;
/// Another frame's pose explains a gap where the gap is this many times smaller with that pose.
const GAIN: f64 = 4.0;

/// Whether walls are enough to say that depth images are those of their own frames.
pub fn are_in_place(episode: &ExaminedEpisode) -> bool {
    gap_m(episode, 0).is_some_and(|own| own <= ON_M)
}

/// Median distance of walls in depth images from the walls, seen from the poses at a place of [`OFFSETS`].
fn gap_m(episode: &ExaminedEpisode, place: usize) -> Option<f64> {
    let gaps: Vec<f64> = episode.looks.iter().filter_map(|look| look.walls_m.get(place).copied().flatten()).collect();
    (gaps.len() >= ENOUGH).then(|| median(gaps.iter().copied()))?
}

/// Compares each depth image with the poses of frames around it.
pub fn check(episode: &ExaminedEpisode) -> Vec<Flag> {
    let gap = |place| gap_m(episode, place);
    let Some(own) = gap(0).filter(|own| *own > ON_M) else { return vec![] };
    let others = (1..OFFSETS.len()).filter_map(|place| Some((OFFSETS[place], gap(place)?)));
    match others.min_by(|a, b| a.1.total_cmp(&b.1)) {
        Some((shift, best)) if best * GAIN < own && best < ON_M => vec![Flag::damage(
            "image-shift",
            &episode.id,
            format!(
                "images are those of {}: what they show of walls is {own:.2} m off these, {best:.2} m with that frame's pose",
                frames(shift)
            ),
        )],
        _ => vec![],
    }
}
