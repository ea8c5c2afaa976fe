//! The pilot: aims at the target a little late or early, frames it off the middle, and turns the camera no faster than it can.

use super::config::AimConfig;
use super::wander::{Wander, smooth};
use cosfly_frames::{DVec3, Pose, TargetState, TargetTrack, real};
use cosfly_random::Seed;
use cosfly_surroundings::visibility::aim_point;

/// Time constant of the quick error of the aim, seconds.
const TREMOR_S: f64 = 1.0;
/// Time constant of the lag, seconds.
const LAG_WANDERS_S: f64 = 4.0;
/// Steepest pitch, radians (89.9 degrees): at 90 a pose has no unique yaw.
const STEEPEST_PITCH_RAD: f64 = 89.9 * (real::PI / 180.0);
/// A turn in yaw moves a point of the picture by the cosine of the pitch; steeper views than of this cosine are turned no
/// further.
const LEAST_COSINE: f64 = 0.35;

/// Poses of a camera at `positions`, one per frame from frame `first_frame` of `track` on. Positions stay; the error of the
/// aim in a frame depends on the seed and on the number of the frame alone, so that a flight that is planned again from the
/// middle is aimed as the whole one. `before` is the pose one frame earlier, from which the rates are bounded, too.
pub fn aimed(
    positions: &[DVec3],
    track: &TargetTrack,
    first_frame: usize,
    before: Option<Pose>,
    config: &AimConfig,
    seed: Seed,
) -> Vec<Pose> {
    let dt_s = track.dt_s;
    let wander = |purpose, deviation, time_s| Wander::new(seed.stream(purpose), deviation, time_s, dt_s);
    let axis = |framing, tremor| {
        let slow = smooth(seed.stream(framing), config.framing_deg.to_radians(), config.framing_s, dt_s);
        slow.zip(wander(tremor, config.tremor_deg.to_radians(), TREMOR_S)).map(|(slow, quick)| slow + quick)
    };
    let (across, upwards) = (axis("framing across", "tremor across"), axis("framing upwards", "tremor upwards"));
    let lags = wander("lag", config.lag_deviation_s, LAG_WANDERS_S);
    let largest_step_rad = config.max_rate_deg_s.to_radians() * dt_s;
    let mut poses: Vec<Pose> = Vec::with_capacity(positions.len());
    let errors = across.zip(upwards).zip(lags).enumerate().skip(first_frame);
    for (&position, (frame, ((across, upwards), lag_s))) in positions.iter().zip(errors) {
        let seen_s = frame as f64 * dt_s - config.lag_s - lag_s;
        let Some(target) = target_at(track, seen_s) else { break };
        let exact = Pose::looking_at(position, aim_point(&target, track.height_m));
        let shrink = (config.max_deg.to_radians() / real::hypot(across, upwards).max(1e-12)).min(1.0);
        let wanted = Pose {
            pitch_rad: (exact.pitch_rad + shrink * upwards).clamp(-STEEPEST_PITCH_RAD, STEEPEST_PITCH_RAD),
            yaw_rad: exact.yaw_rad + shrink * across / real::cos(exact.pitch_rad).max(LEAST_COSINE),
            ..exact
        };
        poses.push(reached(poses.last().copied().or(before), &wanted, largest_step_rad));
    }
    poses
}

/// The wanted pose, or as far on the way to it as a step allows.
pub fn reached(before: Option<Pose>, wanted: &Pose, largest_step_rad: f64) -> Pose {
    let yaw_rad = real::wrap_angle_rad(wanted.yaw_rad);
    let Some(before) = before else { return Pose { yaw_rad, ..*wanted } };
    let step = |from: f64, to: f64| {
        let turn = real::wrap_angle_rad(to - from);
        if turn.abs() <= largest_step_rad { to } else { from + turn.clamp(-largest_step_rad, largest_step_rad) }
    };
    Pose {
        pitch_rad: step(before.pitch_rad, wanted.pitch_rad),
        yaw_rad: real::wrap_angle_rad(step(before.yaw_rad, yaw_rad)),
        ..*wanted
    }
}

/// The target at a time, seconds from its first frame; at its ends it stays. `None` without frames.
fn target_at(track: &TargetTrack, time_s: f64) -> Option<TargetState> {
    let last = track.states.len().checked_sub(1)?;
    let at = (time_s / track.dt_s).clamp(0.0, last as f64);
    let (first, share) = (at as usize, at.fract());
    let (from, to) = (track.states[first], track.states[(first + 1).min(last)]);
    Some(TargetState { feet_in_world: from.feet_in_world.lerp(to.feet_in_world, share), ..from })
}
