//! A target below drawn ground: the ground that is seen around its feet lies above them.

use super::median::median;
use cosfly_episodes::{ExaminedEpisode, Flag};
use cosfly_metrics::drawn_ground::{BELOW_GROUND_M, is_below};

/// Compares stated feet with the ground in depth images.
pub fn check(episode: &ExaminedEpisode) -> Vec<Flag> {
    let rises_m: Vec<f64> = episode.looks.iter().filter_map(|look| look.rise_m).collect();
    let below = rises_m.iter().filter(|rise| **rise > BELOW_GROUND_M).count();
    let Some(middle_m) = median(rises_m.iter().copied()).filter(|_| is_below(below, rises_m.len())) else {
        return vec![];
    };
    let message = format!(
        "the target stands below drawn ground in {below} of {} frames that show the ground at its feet, {middle_m:.2} m in the \
         middle one",
        rises_m.len()
    );
    vec![Flag::damage("below-ground", &episode.id, message)]
}
