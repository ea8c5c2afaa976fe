//! `track`: the walker is the point to be watched.

use super::Mission;
use cosfly_frames::TargetTrack;
use cosfly_planner::MucoConfig;

/// Following a walker, with wishes as they are.
pub fn mission(track: TargetTrack, config: &MucoConfig) -> Mission {
    Mission { track, config: config.clone(), meetings: Vec::new() }
}
