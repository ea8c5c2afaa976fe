//! Numbers of things.

use cosfly_domain::Obstacle;

/// Smallest number that is greater than those of all things.
pub fn next_id(obstacles: &[Obstacle]) -> u32 {
    obstacles.iter().map(|one| one.object_id).max().unwrap_or(0) + 1
}
