//! Twins that a drone could fly: smooth displacements that are made smaller until clearance, height, speed and acceleration
//! hold, and views that turn no faster than stated.

use super::config::PerturbConfig;
use super::kinds::kind::{Departed, Departing, Offsets, Views};
use super::motion;
use crate::aim::reached;
use cosfly_domain::{FramePerturbation, Trajectory};
use cosfly_frames::{DVec3, Pose, real};
use cosfly_random::Seed;
use cosfly_surroundings::exact::ExactMap;
use cosfly_surroundings::visibility::aim_point;

/// Kept beyond the asked clearance, so that rounding cannot take it away again, metres.
const ROUNDING_M: f64 = 1e-6;
/// Time on both sides of a place that is too near to an obstacle over which the displacement is reduced, seconds.
const REDUCED_S: f64 = 5.0;
/// Halvings of the displacement before it is left out altogether.
const HALVINGS: usize = 12;
/// Reductions of the displacement around a place that nothing could fly, each by [`REDUCTION`] and felt so long on both sides,
/// before it is left out there.
const REDUCTIONS: usize = 14;
const REDUCTION: f64 = 0.2;
const GENTLY_S: f64 = 20.0;
/// Displacements and turns smaller than this are none, metres and radians.
const NOTHING: f64 = 1e-6;

/// Poses and recorded departures of a twin of `expert`, with the displacements and views of its kind.
pub(super) fn twin(
    expert: &Trajectory,
    (offsets, views): (Offsets, Views),
    map: ExactMap<'_>,
    config: &PerturbConfig,
    seed: &Seed,
) -> Departed {
    let places: Vec<DVec3> = expert.poses_in_world.iter().map(|pose| pose.position_in_world).collect();
    let (flyable, dt_s) = (&config.flyable, expert.track.dt_s);
    let departing = Departing { places: &places, dt_s, config: flyable, seed };
    // Every twin drifts: where its own way were the expert's, poses alone would tell a model the answer.
    let mut wanted = motion::drift(places.len(), dt_s, flyable, seed);
    wanted.iter_mut().zip(offsets(&departing)).for_each(|(drift, more)| *drift += more);
    let way = Way { expert, places: &places, map, config };
    let mut offsets = way.flown(wanted);
    offsets.iter_mut().filter(|offset| offset.length() <= NOTHING).for_each(|offset| *offset = DVec3::ZERO);
    let straight = straight_views(expert, &offsets);
    let poses = views(&departing, &expert.track, &straight);
    let poses = turned_in_time(&poses, flyable.max_rate_deg_s.to_radians() * dt_s);
    let recorded = poses.iter().zip(&straight).zip(&offsets).enumerate();
    let frames = recorded.map(|(frame, ((pose, straight), offset))| recorded_frame(frame, pose, straight, *offset));
    let frames = frames.collect();
    (poses, frames)
}

fn recorded_frame(frame: usize, pose: &Pose, straight: &Pose, offset: DVec3) -> FramePerturbation {
    let pitch_offset_rad = pose.pitch_rad - straight.pitch_rad;
    let yaw_offset_rad = real::wrap_angle_rad(pose.yaw_rad - straight.yaw_rad);
    FramePerturbation {
        position: offset != DVec3::ZERO,
        rotation: real::hypot(pitch_offset_rad, yaw_offset_rad) > NOTHING,
        drone_offset_in_world: offset,
        aim_offset_in_world: DVec3::ZERO,
        pitch_offset_rad,
        yaw_offset_rad,
        expert_frame: frame as u32,
    }
}

/// Views from the displaced places to the points that the expert looks at abreast of the target.
fn straight_views(expert: &Trajectory, offsets: &[DVec3]) -> Vec<Pose> {
    let view = |((pose, state), offset): ((&Pose, &_), &DVec3)| {
        if *offset == DVec3::ZERO {
            return *pose;
        }
        let forward = pose.world_from_body() * DVec3::X;
        let ahead_m = (aim_point(state, expert.track.height_m) - pose.position_in_world).dot(forward).max(1.0);
        let aim = pose.position_in_world + ahead_m * forward;
        Pose { roll_rad: pose.roll_rad, ..Pose::looking_at(pose.position_in_world + *offset, aim) }
    };
    expert.poses_in_world.iter().zip(&expert.track.states).zip(offsets).map(view).collect()
}

/// Poses at the wanted places with views that turn by a step at most from frame to frame, world frame.
fn turned_in_time(wanted: &[Pose], largest_step_rad: f64) -> Vec<Pose> {
    let mut poses: Vec<Pose> = Vec::with_capacity(wanted.len());
    for pose in wanted {
        poses.push(reached(poses.last().copied(), pose, largest_step_rad));
    }
    poses
}

/// The expert's way, and what a displaced drone keeps.
struct Way<'a> {
    expert: &'a Trajectory,
    places: &'a [DVec3],
    map: ExactMap<'a>,
    config: &'a PerturbConfig,
}

impl Way<'_> {
    /// Displacements of the form of `wanted` that keep clearance, height, speed and acceleration: made smaller, smoothly in time, around
    /// each place where they would not, and there alone, so that a long flight is displaced as a short one is.
    fn flown(&self, mut wanted: Vec<DVec3>) -> Vec<DVec3> {
        // Beyond the reductions every round leaves at least one more frame without a displacement.
        for round in 0..REDUCTIONS + wanted.len() {
            let free = self.kept_free(wanted.clone());
            let failing = [self.too_fast(&free), self.blocked(&free)].concat();
            if failing.is_empty() {
                return free;
            }
            let removed = if round < REDUCTIONS { REDUCTION } else { 1.0 };
            reduce(&mut wanted, &failing, removed, self.frames(GENTLY_S));
        }
        vec![DVec3::ZERO; wanted.len()]
    }

    fn frames(&self, time_s: f64) -> usize {
        (time_s / self.expert.track.dt_s).ceil().max(1.0) as usize
    }

    /// Displacements that are reduced, smoothly in time, wherever they lead too near to an obstacle or too low.
    fn kept_free(&self, mut offsets: Vec<DVec3>) -> Vec<DVec3> {
        for halving in 0..=HALVINGS {
            let blocked = self.blocked(&offsets);
            if blocked.is_empty() {
                break;
            }
            reduce(&mut offsets, &blocked, if halving == HALVINGS { 1.0 } else { 0.5 }, self.frames(REDUCED_S));
        }
        offsets
    }

    /// Frames from which on the displaced way is too near to an obstacle, or too low, up to the next frame.
    fn blocked(&self, offsets: &[DVec3]) -> Vec<usize> {
        let kept_m = self.config.clearance_m + ROUNDING_M;
        let place = |frame: usize| self.places[frame] + offsets[frame];
        let is_blocked = |frame: &usize| {
            let (from, to) = (place(*frame), place((*frame + 1).min(offsets.len() - 1)));
            let lowest_z_m = self.expert.track.states[*frame].feet_in_world.z + self.config.min_height_m;
            let is_moved = |frame: usize| offsets.get(frame).is_some_and(|offset| *offset != DVec3::ZERO);
            (is_moved(*frame) || is_moved(*frame + 1))
                && (from.z < lowest_z_m || self.map.segment_clearance(*frame, from, to, kept_m) < kept_m)
        };
        (0..offsets.len()).filter(is_blocked).collect()
    }

    /// Frames of displaced places from which on the way is too fast, or bends too much, where the expert's own is not.
    fn too_fast(&self, offsets: &[DVec3]) -> Vec<usize> {
        let places: Vec<DVec3> = self.places.iter().zip(offsets).map(|(place, offset)| *place + *offset).collect();
        let (limits, dt_s) = (&self.config.flyable, self.expert.track.dt_s);
        let is_too_fast = |frame: &usize| {
            let near = *frame..(*frame + 3).min(places.len());
            if offsets[near.clone()].iter().all(|offset| offset.length() <= NOTHING) {
                return false;
            }
            match places[near] {
                [from, at, to] => {
                    let speed_mps = from.distance(at).max(at.distance(to)) / dt_s;
                    let acceleration_mps2 = (to - 2.0 * at + from).length() / (dt_s * dt_s);
                    speed_mps > limits.max_speed_mps || acceleration_mps2 > limits.max_acceleration_mps2
                }
                [from, to] => from.distance(to) / dt_s > limits.max_speed_mps,
                _ => false,
            }
        };
        (0..places.len()).filter(is_too_fast).collect()
    }
}

/// Takes a share off the displacements around frames and those after them, less and less up to `reach` frames away.
fn reduce(offsets: &mut [DVec3], frames: &[usize], removed: f64, reach: usize) {
    let mut kept = vec![1.0_f64; offsets.len()];
    for &frame in frames {
        let near = frame.saturating_sub(reach)..(frame + reach + 2).min(kept.len());
        for (at, kept) in near.clone().zip(&mut kept[near]) {
            let apart = at.abs_diff(frame).min(at.abs_diff(frame + 1)) as f64 / reach as f64;
            let bump = 0.5 * (1.0 + real::cos(real::PI * apart.min(1.0)));
            *kept = kept.min(1.0 - removed * bump);
        }
    }
    offsets.iter_mut().zip(kept).for_each(|(offset, kept)| *offset *= kept);
}
