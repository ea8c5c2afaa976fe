//! Numbers of things, which rise.

use cosfly_domain::Obstacle;

/// Number for the next thing.
pub fn next_id(obstacles: &[Obstacle]) -> u32 {
    obstacles.last().map_or(0, |last| last.object_id) + 1
}
