//! `track`: the walker is the point to be watched.

use super::Mission;
use crate::config::muco::MucoConfig;
use cosfly_frames::TargetTrack;

/// Following a walker, with wishes as they are.
pub fn mission(track: TargetTrack, config: &MucoConfig) -> Mission {
    Mission { track, config: config.clone(), meetings: Vec::new() }
}
