//! Whether depth images are of their frames, by walls: what a depth image shows of a building lies on that building's boxes
//! when it is seen from the right pose. Tells shifts of smooth flights, which keep their target at one distance.

use super::median;
use super::motion::frames;
use crate::episode::OFFSETS;
use crate::{Episode, Flag};

/// Frames with walls in view that a verdict needs.
const ENOUGH: usize = 4;
/// Points are on their walls up to this, metres; depth is stored in less than that.
const ON_M: f64 = 0.03;
/// Another frame's pose explains the gap when it makes it so many times smaller.
const GAIN: f64 = 4.0;

/// Compares poses around each depth image.
pub fn check(episode: &Episode) -> Vec<Flag> {
    let gap = |place: usize| {
        let gaps: Vec<f64> =
            episode.looks.iter().filter_map(|look| look.walls_m.get(place).copied().flatten()).collect();
        (gaps.len() >= ENOUGH).then(|| median(gaps.iter().copied()))?
    };
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
