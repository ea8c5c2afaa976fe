//! `jumps`: the paper's two independent events per frame, with safe displacements (section "Dual-Trajectory Augmentation").

use super::displacement::{Corridor, free_offset, horizontal_offset};
use super::kind::{Departed, Departure, Kind};
use crate::perturb::sizes::JumpSizes;
use cosfly_domain::{FramePerturbation, Trajectory};
use cosfly_frames::{DVec3, Pose, real};
use cosfly_random::{RandomStream, Seed};
use cosfly_surroundings::exact::ExactMap;
use cosfly_surroundings::visibility::aim_point;

pub(super) const KIND: Kind = Kind {
    name: "jumps",
    doc: "The paper's: two independent events per frame displace the drone and turn its view. No drone could fly it: 2 to 3 m between frames are some 40 m/s^2.",
    departure: Departure::FrameByFrame(jumps),
};

/// Steepest pitch of a turned view, radians (89.9 degrees): at 90 a pose has no unique yaw.
const STEEPEST_PITCH_RAD: f64 = 89.9 * (real::PI / 180.0);

/// Poses and events of kind `jumps`.
fn jumps(expert: &Trajectory, map: ExactMap<'_>, sizes: &JumpSizes<'_>, seed: &Seed) -> Departed {
    let count = expert.track.len();
    let mut frames = Vec::with_capacity(count);
    let mut poses: Vec<Pose> = Vec::with_capacity(count);
    let (mut position_events, mut rotation_events) = (seed.stream("position event"), seed.stream("rotation event"));
    for frame in 0..count {
        let mut applied = FramePerturbation {
            position: position_events.chance(sizes.position_probability),
            rotation: rotation_events.chance(sizes.rotation_probability),
            drone_offset_in_world: DVec3::ZERO,
            aim_offset_in_world: DVec3::ZERO,
            pitch_offset_rad: 0.0,
            yaw_offset_rad: 0.0,
            expert_frame: frame as u32,
        };
        let before = poses.last().map(|pose| pose.position_in_world);
        let own = seed.child("frame", frame as u64);
        let pose = perturbed(expert, frame, before, map, sizes, &own, &mut applied);
        poses.push(pose);
        frames.push(applied);
    }
    (poses, frames)
}

/// The pose of a frame after the events that `applied` names, whose displacements and turns are written there.
fn perturbed(
    expert: &Trajectory,
    frame: usize,
    before: Option<DVec3>,
    map: ExactMap<'_>,
    sizes: &JumpSizes<'_>,
    own: &Seed,
    applied: &mut FramePerturbation,
) -> Pose {
    let mut pose = expert.poses_in_world[frame];
    if applied.position {
        let corridor = Corridor {
            map,
            frame,
            clearance_m: sizes.clearance_m,
            lowest_z_m: expert.track.states[frame].feet_in_world.z + sizes.min_height_m,
            before,
            after: expert.poses_in_world.get(frame + 1).map(|pose| pose.position_in_world),
        };
        applied.drone_offset_in_world =
            free_offset(&corridor, pose.position_in_world, sizes.drone_offset, own.stream("drone"));
        applied.aim_offset_in_world = horizontal_offset(sizes.aim_offset, own.stream("aim"));
        pose = displaced(pose, expert, frame, applied);
    }
    if applied.rotation {
        turn(&mut pose, applied, sizes, own.stream("rotation"));
    }
    pose
}

/// The pose from the displaced position towards the displaced aim. The undisplaced aim is the point of the expert's
/// own line of sight abreast of the target, so that zero displacements give the expert's view.
fn displaced(expert_pose: Pose, expert: &Trajectory, frame: usize, applied: &FramePerturbation) -> Pose {
    let position = expert_pose.position_in_world;
    let forward = expert_pose.world_from_body() * DVec3::X;
    let ahead_m = (aim_point(&expert.track.states[frame], expert.track.height_m) - position).dot(forward).max(1.0);
    let aim = position + ahead_m * forward + applied.aim_offset_in_world;
    Pose { roll_rad: expert_pose.roll_rad, ..Pose::looking_at(position + applied.drone_offset_in_world, aim) }
}

/// Turns the view by an angle uniform in 0..=max, split into pitch and yaw by a uniform direction. The pitch stops at
/// [`STEEPEST_PITCH_RAD`]; what was turned is recorded, not what was drawn.
fn turn(pose: &mut Pose, applied: &mut FramePerturbation, sizes: &JumpSizes<'_>, mut stream: RandomStream) {
    let angle = stream.uniform(0.0, sizes.max_rotation_deg.to_radians());
    let (sin, cos) = real::sin_cos(stream.uniform(-real::PI, real::PI));
    let pitch_rad = (pose.pitch_rad + sin * angle).clamp(-STEEPEST_PITCH_RAD, STEEPEST_PITCH_RAD);
    applied.pitch_offset_rad = pitch_rad - pose.pitch_rad;
    applied.yaw_offset_rad = cos * angle;
    pose.pitch_rad = pitch_rad;
    pose.yaw_rad = real::wrap_angle_rad(pose.yaw_rad + applied.yaw_offset_rad);
}
