//! Teams: the drones of a vector environment fly the same episode at the same time, each from a start of its own, and can hit each other.

use super::member::{Shared, VectorMember};
use cosfly_env::{Environment, Episode, Start};
use cosfly_frames::{DVec3, real};
use std::sync::Arc;

/// Numbers that are told of each other drone.
pub const BESIDE: usize = 7;
/// Starts of a team are at least this far apart, metres.
const APART_M: f64 = 4.0;
/// Angles around the target that are tried for a start.
const ANGLES: u32 = 24;
/// Heights that are tried for a start, and the distance between them, metres.
const LEVELS: u32 = 8;
const LEVEL_M: f64 = 5.0;

/// The episode as each drone of a team flies it: the first from the episode's start, the others from places turned around the
/// target, higher where there is no room.
pub(super) fn episodes(episode: &Arc<Episode>, count: usize, radius_m: f64) -> Vec<Arc<Episode>> {
    let mut starts: Vec<Start> = vec![episode.start];
    while starts.len() < count {
        let start = start_beside(episode, &starts, starts.len() as f64 / count as f64, radius_m);
        starts.push(start);
    }
    let with_start = |start: &Start| Arc::new(Episode { start: *start, ..Episode::clone(episode) });
    starts.iter().take(count).map(with_start).collect()
}

/// The first free place from `share` of a turn around the target on.
fn start_beside(episode: &Episode, taken: &[Start], share: f64, radius_m: f64) -> Start {
    let (feet, first) = (episode.target_at(0.0).feet_in_world, episode.start);
    let turned = |vector: DVec3, angle_rad: f64| {
        let (sin, cos) = real::sin_cos(angle_rad);
        DVec3::new(cos * vector.x - sin * vector.y, sin * vector.x + cos * vector.y, vector.z)
    };
    let place = |try_number: u32| {
        let turn = share + f64::from(try_number % ANGLES) / f64::from(ANGLES);
        let up = DVec3::Z * (LEVEL_M * f64::from(try_number / ANGLES));
        feet + turned(first.position_in_world - feet, turn * real::TAU) + up
    };
    let is_free = |place: &DVec3| {
        let is_apart = taken.iter().all(|start| start.position_in_world.distance(*place) >= APART_M);
        let above_m = episode.place.above_ground_m(*place);
        is_apart && !episode.place.collides([*place; 2], above_m, radius_m + 1.0)
    };
    let free = (0..ANGLES * LEVELS).map(place).find(is_free);
    // Above all levels there is room.
    let above = || place(ANGLES * LEVELS) + DVec3::Z * (APART_M * taken.len() as f64);
    Start { position_in_world: free.unwrap_or_else(above), velocity_in_world: first.velocity_in_world }
}

/// Places before a step of the drones that fly on; none of those whose episode is over.
pub(super) fn places(members: &[VectorMember]) -> Vec<Option<DVec3>> {
    let place = |member: &VectorMember| {
        let is_flying = member.environment.score().end.is_none();
        is_flying.then(|| member.environment.observation().motion.position_in_world)
    };
    members.iter().map(place).collect()
}

/// Ends the episodes of drones that came as near as two radii to each other on their straight ways of a step.
pub(super) fn meet(members: &mut [VectorMember], before: &[Option<DVec3>], shared: &Shared) {
    let mut hit = vec![false; members.len()];
    for one in 0..members.len() {
        for other in 0..one {
            let (Some(from), Some(other_from)) = (before[one], before[other]) else { continue };
            let to = |number: usize| members[number].environment.observation().motion.position_in_world;
            if nearest_m(from - other_from, to(one) - to(other)) < 2.0 * shared.settings.radius_m {
                (hit[one], hit[other]) = (true, true);
            }
        }
    }
    for (member, _) in members.iter_mut().zip(hit).filter(|(_, hit)| *hit) {
        if member.environment.collide() {
            member.reward.collision = -1.0;
        }
        (member.end, member.is_due) = (member.environment.score().end, true);
    }
}

/// Smallest length of a vector that goes evenly from one value to another.
fn nearest_m(from: DVec3, to: DVec3) -> f64 {
    let way = to - from;
    let share = (-from.dot(way) / way.length_squared().max(1e-12)).clamp(0.0, 1.0);
    from.lerp(to, share).length()
}

/// Numbers on each other drone, in the order of their numbers: whether it flies (0 or 1), its place from the drone
/// (metres) and its velocity (m/s), both ahead, right and up; zeros of one that does not fly.
pub(super) fn beside(members: &[VectorMember], number: usize) -> Vec<f32> {
    let own = members[number].environment.observation();
    let told = |environment: &Environment| {
        if environment.score().end.is_some() {
            return [0.0; BESIDE];
        }
        let motion = &environment.observation().motion;
        let place = own.along_heading(motion.position_in_world - own.motion.position_in_world);
        let velocity = own.along_heading(motion.velocity_in_world);
        [1.0, place.x, place.y, place.z, velocity.x, velocity.y, velocity.z].map(|part| part as f32)
    };
    let others = members.iter().enumerate().filter(|(other, _)| *other != number);
    others.flat_map(|(_, member)| told(&member.environment)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_that_cross_come_near_between_their_ends() {
        assert!(nearest_m(DVec3::new(-1.0, 0.1, 0.0), DVec3::new(1.0, 0.1, 0.0)) < 0.11);
        assert_eq!(nearest_m(DVec3::X, DVec3::X), 1.0);
    }
}
