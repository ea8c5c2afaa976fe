//! Conversion from the world frame (left-handed, y right) to the right-handed `map` frame, and back.
//!
//! A point (x, y, z) becomes (x, -y, z). A rotation is conjugated by the reflection of y: Rz(-yaw) * Ry(-pitch) *
//! Rx(roll). The body frame becomes x ahead, y left, z up.

use cosfly_domain::Mount;
use cosfly_frames::{DQuat, DVec3, Pose, real};
use foxglove::messages;

/// Rotation from the optical axes (x right, y down, z ahead) to the right-handed body axes (x ahead, y left, z up).
pub const BODY_FROM_OPTICAL: DQuat = DQuat::from_xyzw(-0.5, 0.5, -0.5, 0.5);

/// Rotation from the optical axes of a camera in this mount to the right-handed body axes of a drone.
pub fn body_from_optical(mount: &Mount, drone: &Pose) -> DQuat {
    let camera = mount.camera_pose(drone);
    if (Pose { position_in_world: drone.position_in_world, ..camera }) == *drone {
        return BODY_FROM_OPTICAL;
    }
    if mount.levelled {
        return map_from_body(drone).inverse() * map_from_body(&camera) * BODY_FROM_OPTICAL;
    }
    map_from_body(&mount.turn()) * BODY_FROM_OPTICAL
}

/// Place of a camera in this mount along the right-handed axes of a drone, metres.
pub fn camera_in_body(mount: &Mount, drone: &Pose) -> DVec3 {
    if mount.is_in_origin() {
        return DVec3::ZERO;
    }
    let aside = body_from_optical(mount, drone) * DVec3::new(mount.right_m, 0.0, 0.0);
    map_from_world_point(mount.position_in_body_m) + aside
}

/// Point of the world frame in the `map` frame; the function is its own inverse.
pub fn map_from_world_point(point_in_world: DVec3) -> DVec3 {
    DVec3::new(point_in_world.x, -point_in_world.y, point_in_world.z)
}

/// Attitude of a world-frame pose, in the `map` frame.
pub fn map_from_body(pose_in_world: &Pose) -> DQuat {
    let half_turn = |axis: DVec3, angle_rad: f64| {
        let (sin, cos) = real::sin_cos(0.5 * angle_rad);
        DQuat::from_xyzw(axis.x * sin, axis.y * sin, axis.z * sin, cos)
    };
    half_turn(DVec3::Z, -pose_in_world.yaw_rad)
        * half_turn(DVec3::Y, -pose_in_world.pitch_rad)
        * half_turn(DVec3::X, pose_in_world.roll_rad)
}

/// World-frame pose with this position and attitude in the `map` frame.
pub fn world_pose_from_map(position_in_map: DVec3, map_from_body: DQuat) -> Pose {
    let ahead = map_from_world_point(map_from_body * DVec3::X);
    let right = map_from_world_point(map_from_body * DVec3::NEG_Y);
    let up = map_from_world_point(map_from_body * DVec3::Z);
    Pose {
        position_in_world: map_from_world_point(position_in_map),
        pitch_rad: real::asin(ahead.z.clamp(-1.0, 1.0)),
        yaw_rad: real::atan2(ahead.y, ahead.x),
        roll_rad: real::atan2(-right.z, up.z),
    }
}

/// Vector as a message.
pub fn vector(vector: DVec3) -> messages::Vector3 {
    messages::Vector3 { x: vector.x, y: vector.y, z: vector.z }
}

/// Rotation as a message.
pub fn quaternion(rotation: DQuat) -> messages::Quaternion {
    messages::Quaternion { x: rotation.x, y: rotation.y, z: rotation.z, w: rotation.w }
}

/// World-frame pose as a message in the `map` frame.
pub fn pose(pose_in_world: &Pose) -> messages::Pose {
    messages::Pose {
        position: Some(vector(map_from_world_point(pose_in_world.position_in_world))),
        orientation: Some(quaternion(map_from_body(pose_in_world))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned() -> Pose {
        Pose { position_in_world: DVec3::new(3.0, -7.0, 20.0), pitch_rad: -0.6, yaw_rad: 2.2, roll_rad: 0.3 }
    }

    #[test]
    fn body_axes_point_the_same_way_in_both_frames() {
        let pose = turned();
        let world_from_body = pose.world_from_body();
        let rotation = map_from_body(&pose);
        for (axis, same_axis) in [(DVec3::X, DVec3::X), (DVec3::Y, DVec3::NEG_Y), (DVec3::Z, DVec3::Z)] {
            let expected = map_from_world_point(world_from_body * axis);
            assert!((rotation * same_axis - expected).length() < 1e-12, "{axis}");
        }
    }

    #[test]
    fn the_optical_axis_looks_ahead_and_its_x_axis_to_the_right() {
        assert!((BODY_FROM_OPTICAL * DVec3::Z - DVec3::X).length() < 1e-15);
        assert!((BODY_FROM_OPTICAL * DVec3::X - DVec3::NEG_Y).length() < 1e-15);
    }

    #[test]
    fn a_turned_camera_looks_the_same_way_in_both_frames() {
        for levelled in [false, true] {
            let (pose, mount) = (
                turned(),
                Mount {
                    position_in_body_m: DVec3::new(0.3, -0.2, 0.1),
                    right_m: 0.12,
                    roll_rad: 0.4,
                    pitch_rad: 0.2,
                    yaw_rad: -0.7,
                    levelled,
                },
            );
            let camera = mount.camera_pose(&pose).position_in_world;
            let along_m = map_from_body(&pose) * camera_in_body(&mount, &pose);
            let expected = map_from_world_point(pose.position_in_world) + along_m;
            assert!((map_from_world_point(camera) - expected).length() < 1e-12);
            let world_from_camera = mount.camera_pose(&pose).world_from_body();
            let map_from_optical = map_from_body(&pose) * body_from_optical(&mount, &pose);
            for (axis, in_optical) in [(DVec3::X, DVec3::Z), (DVec3::Y, DVec3::X), (DVec3::Z, DVec3::NEG_Y)] {
                let expected = map_from_world_point(world_from_camera * axis);
                assert!((map_from_optical * in_optical - expected).length() < 1e-12, "{levelled} {axis}");
            }
        }
    }

    #[test]
    fn a_pose_survives_the_way_to_the_map_frame_and_back() {
        let pose = turned();
        let back = world_pose_from_map(map_from_world_point(pose.position_in_world), map_from_body(&pose));
        assert!((back.position_in_world - pose.position_in_world).length() < 1e-12);
        let angles = |p: &Pose| DVec3::new(p.pitch_rad, p.yaw_rad, p.roll_rad);
        assert!((angles(&back) - angles(&pose)).length() < 1e-12);
    }
}
