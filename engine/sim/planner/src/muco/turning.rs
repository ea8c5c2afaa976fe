//! Rates of view: the camera looks at the target, so a flight turns its camera by moving about the target.
//!
//! Two positions whose directions from the target lie in one wedge turn the camera by no more than the wedge's angle. So a
//! wedge round the mean direction of each fast pair of frames bounds its turn, and each of its sides is a half-space.

use super::corridor::{CorridorInput, FrameCorridor};
use cosfly_frames::{DVec3, real};
use cosfly_surroundings::solid::HalfSpace;
use cosfly_surroundings::visibility::aim_point;

/// The wedges are this share of the limit, so that what the programme leaves open stays within it.
const AIM_SHARE: f64 = 0.9;
/// Pairs that turn by less than this share of the limit need no wedge.
const SLOW_SHARE: f64 = 0.6;
/// Horizontal distances are kept from the smallest searched one on where a waypoint is less than this beyond it, metres.
const NEAR_AXIS_M: f64 = 4.0;
/// A waypoint that is nearer moves out by this much at a time, metres.
const WAY_OUT_M: f64 = 1.0;

/// Direction from the target in a plane that may turn from frame to frame: angle against `across` towards `up`.
struct StaticSight {
    target: DVec3,
    across: DVec3,
    angle_rad: f64,
}

/// Adds the half-spaces that keep the rates of yaw and pitch, and the distance from the axis above the target, near which a
/// camera turns fastest.
pub fn add_turning(input: &CorridorInput<'_>, waypoints: &[DVec3], corridor: &mut [FrameCorridor]) {
    let given = input.head.len();
    for frame in given..waypoints.len() {
        let (feet, across) = (input.track.states[frame].feet_in_world, across(input, waypoints, frame));
        let radius_m = (waypoints[frame] - feet).dot(across);
        if radius_m < input.min_radius_m + NEAR_AXIS_M {
            let least_m = input.min_radius_m.min(radius_m + WAY_OUT_M);
            corridor[frame].hard.push(HalfSpace { normal: across, offset_m: across.dot(feet) + least_m });
        }
    }
    let [yaw, pitch] = input.turn_rad;
    for frame in given.saturating_sub(1)..waypoints.len().saturating_sub(1) {
        bound(input, waypoints, frame, yaw, DVec3::Y, &|_| DVec3::X, corridor);
        bound(input, waypoints, frame, pitch, DVec3::Z, &|frame| self::across(input, waypoints, frame), corridor);
    }
}

/// Horizontal direction from the target to a waypoint.
fn across(input: &CorridorInput<'_>, waypoints: &[DVec3], frame: usize) -> DVec3 {
    let sight = waypoints[frame] - input.track.states[frame].feet_in_world;
    sight.with_z(0.0).try_normalize().unwrap_or(DVec3::X)
}

/// Keeps the directions of a frame and the next one in a wedge of at most `limit_rad`, if they are not far within it.
fn bound(
    input: &CorridorInput<'_>,
    waypoints: &[DVec3],
    frame: usize,
    limit_rad: f64,
    up: DVec3,
    across: &dyn Fn(usize) -> DVec3,
    corridor: &mut [FrameCorridor],
) {
    if limit_rad >= real::PI {
        return;
    }
    let sight = |frame: usize| {
        let (target, across) = (aim_point(&input.track.states[frame], input.track.height_m), across(frame));
        let ray = waypoints[frame] - target;
        StaticSight { target, across, angle_rad: real::atan2(ray.dot(up), ray.dot(across)) }
    };
    let sights = [sight(frame), sight(frame + 1)];
    let turn = real::wrap_angle_rad(sights[1].angle_rad - sights[0].angle_rad);
    if turn.abs() < SLOW_SHARE * limit_rad {
        return;
    }
    let (middle, half) = (sights[0].angle_rad + 0.5 * turn, 0.5 * AIM_SHARE * limit_rad);
    for (frame, sight) in (frame..).zip(&sights) {
        for inward in [half - 0.5 * real::PI, 0.5 * real::PI - half] {
            let (sin, cos) = real::sin_cos(middle + inward);
            let normal = cos * sight.across + sin * up;
            corridor[frame].hard.push(HalfSpace { normal, offset_m: normal.dot(sight.target) });
        }
    }
}
