//! Actions: the motion from one pose to the next, along the world's axes or in the body frame, and its inverse.

use crate::{Pose, real};
use glam::{DMat3, DVec3};

/// Difference of two poses along the world's axes: dx, dy, dz in metres, dpitch, dyaw, droll in degrees, angles wrapped
/// to (-180, 180].
pub fn in_world(from: &Pose, to: &Pose) -> [f64; 6] {
    let step = to.position_in_world - from.position_in_world;
    let turn = |from_rad: f64, to_rad: f64| real::wrap_angle_rad(to_rad - from_rad).to_degrees();
    let angles = [turn(from.pitch_rad, to.pitch_rad), turn(from.yaw_rad, to.yaw_rad), turn(from.roll_rad, to.roll_rad)];
    [step.x, step.y, step.z, angles[0], angles[1], angles[2]]
}

/// Pose `to` in the body frame of `from` (x ahead, y right, z up): dx, dy, dz in metres, and pitch, yaw, roll of the
/// relative rotation in degrees.
pub fn in_body(from: &Pose, to: &Pose) -> [f64; 6] {
    let body_from_world = from.world_from_body().transpose();
    let step = body_from_world * (to.position_in_world - from.position_in_world);
    let [pitch, yaw, roll] = angles_rad(&(body_from_world * to.world_from_body())).map(f64::to_degrees);
    [step.x, step.y, step.z, pitch, yaw, roll]
}

/// Applies an action of [`in_world`] to a pose.
pub fn moved_in_world(from: &Pose, [dx, dy, dz, pitch, yaw, roll]: &[f64; 6]) -> Pose {
    Pose {
        position_in_world: from.position_in_world + DVec3::new(*dx, *dy, *dz),
        pitch_rad: from.pitch_rad + pitch.to_radians(),
        yaw_rad: from.yaw_rad + yaw.to_radians(),
        roll_rad: from.roll_rad + roll.to_radians(),
    }
}

/// Applies an action of [`in_body`] to a pose.
pub fn moved_in_body(from: &Pose, [ahead, right, up, pitch, yaw, roll]: &[f64; 6]) -> Pose {
    let world_from_body = from.world_from_body();
    let turn = Pose {
        position_in_world: DVec3::ZERO,
        pitch_rad: pitch.to_radians(),
        yaw_rad: yaw.to_radians(),
        roll_rad: roll.to_radians(),
    };
    let [pitch_rad, yaw_rad, roll_rad] = angles_rad(&(world_from_body * turn.world_from_body()));
    let position_in_world = from.position_in_world + world_from_body * DVec3::new(*ahead, *right, *up);
    Pose { position_in_world, pitch_rad, yaw_rad, roll_rad }
}

/// Pitch, yaw and roll of a rotation matrix, radians.
pub fn angles_rad(rotation: &DMat3) -> [f64; 3] {
    let (ahead, right, up): (DVec3, DVec3, DVec3) = (rotation.x_axis, rotation.y_axis, rotation.z_axis);
    [real::asin(ahead.z.clamp(-1.0, 1.0)), real::atan2(ahead.y, ahead.x), real::atan2(-right.z, up.z)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_action_leads_from_one_pose_to_the_next() {
        let from = Pose { position_in_world: DVec3::new(1.0, 2.0, 30.0), pitch_rad: -0.5, yaw_rad: 3.1, roll_rad: 0.1 };
        let to = Pose { position_in_world: DVec3::new(2.0, 1.5, 29.0), pitch_rad: -0.4, yaw_rad: -3.1, roll_rad: 0.0 };
        for reached in [moved_in_body(&from, &in_body(&from, &to)), moved_in_world(&from, &in_world(&from, &to))] {
            assert!((reached.position_in_world - to.position_in_world).length() < 1e-12);
            assert!(reached.world_from_body().abs_diff_eq(to.world_from_body(), 1e-12));
        }
        let yaw_step = in_world(&from, &to)[4];
        assert!((yaw_step - (core::f64::consts::TAU - 6.2).to_degrees()).abs() < 1e-9, "{yaw_step}");
    }
}
