//! Pictures and tables of one version: where a log says that the camera was, and what of the target it shows, is in the tables.

use super::median::median;
use cosfly_episodes::{ExaminedEpisode, Flag};

/// Flags an episode most of whose pictures are of another flight than its rows.
pub fn check(episode: &ExaminedEpisode) -> Vec<Flag> {
    let elsewhere_m: Vec<f64> = episode.looks.iter().filter_map(|look| look.elsewhere_m).collect();
    if 2 * elsewhere_m.len() <= episode.looks.len() {
        return vec![];
    }
    let place = match median(elsewhere_m.iter().copied()) {
        Some(distance_m) if distance_m > 0.0 => {
            format!("the log's camera is {distance_m:.1} m from every pose that the tables have")
        }
        _ => "the log shows other pixels of the target than the tables say".to_owned(),
    };
    let message = format!(
        "pictures and tables are of two versions: {place}, in {} of {} frames that were looked at; take both from one run",
        elsewhere_m.len(),
        episode.looks.len()
    );
    vec![Flag::damage("mixed-versions", &episode.id, message)]
}
