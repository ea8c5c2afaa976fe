//! The checks, one kind of fault per file.
//!
//! To add one, write its file and add two lines here: its `mod` and its entry in [`OF_EPISODES`].

mod bearing;
mod depth;
mod extent;
mod ground;
mod leaks;
mod median;
mod motion;
mod pictures;
mod projection;
pub(crate) mod scan;
mod surface;
mod surroundings;
mod time;
mod versions;
pub(crate) mod words;

pub use extent::of_towns as extent;
pub use leaks::{Trace, of_all as leaks};
pub use surroundings::LOST;

use cosfly_episodes::{ExaminedEpisode, Flag};

/// All checks of single episodes.
const OF_EPISODES: &[fn(&ExaminedEpisode) -> Vec<Flag>] = &[
    time::check,
    motion::check,
    projection::check,
    bearing::check,
    depth::check,
    surface::check,
    ground::check,
    pictures::check,
    surroundings::check,
    versions::check,
    words::check,
];

/// Findings of all checks of one episode.
pub fn of_episode(episode: &ExaminedEpisode) -> Vec<Flag> {
    OF_EPISODES.iter().flat_map(|check| check(episode)).collect()
}
