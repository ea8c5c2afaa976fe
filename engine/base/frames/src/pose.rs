//! A 6-DoF pose in the world frame, in CARLA's convention.

use crate::real::{asin, atan2, sin_cos};
use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

/// Position and attitude of a body. Angles in radians; the body's x axis points forward, y right, z up.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Position of the body's origin, metres.
    pub position_in_world: DVec3,
    /// Pitch, radians; positive: nose up.
    pub pitch_rad: f64,
    /// Yaw, radians; positive: x towards y (clockwise seen from above).
    pub yaw_rad: f64,
    /// Roll, radians; positive: right side down.
    pub roll_rad: f64,
}

impl Pose {
    /// Pose at `position_in_world` whose x axis points at `target_in_world`, without roll. Where the two points
    /// coincide, the x axis points along the world's.
    pub fn looking_at(position_in_world: DVec3, target_in_world: DVec3) -> Self {
        let ray = target_in_world - position_in_world;
        let length = ray.length();
        let (yaw_rad, pitch_rad) =
            if length > 0.0 { (atan2(ray.y, ray.x), asin((ray.z / length).clamp(-1.0, 1.0))) } else { (0.0, 0.0) };
        Self { position_in_world, pitch_rad, yaw_rad, roll_rad: 0.0 }
    }

    /// Pose with the body's axes as columns of a rotation matrix; a body that points straight up or down has no roll.
    pub fn of_axes(position_in_world: DVec3, world_from_body: DMat3) -> Self {
        let [ahead, right, up] = [world_from_body.x_axis, world_from_body.y_axis, world_from_body.z_axis];
        let pitch_rad = asin(ahead.z.clamp(-1.0, 1.0));
        if ahead.x.abs() + ahead.y.abs() < 1e-9 {
            return Self { position_in_world, pitch_rad, yaw_rad: atan2(-right.x, right.y), roll_rad: 0.0 };
        }
        Self { position_in_world, pitch_rad, yaw_rad: atan2(ahead.y, ahead.x), roll_rad: atan2(-right.z, up.z) }
    }

    /// Rotation matrix whose columns are the body's x, y and z axes in the world frame (the rotation part of
    /// `carla.Transform.get_matrix`).
    pub fn world_from_body(&self) -> DMat3 {
        let (sp, cp) = sin_cos(self.pitch_rad);
        let (sy, cy) = sin_cos(self.yaw_rad);
        let (sr, cr) = sin_cos(self.roll_rad);
        DMat3::from_cols(
            DVec3::new(cp * cy, cp * sy, sp),
            DVec3::new(cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, -cp * sr),
            DVec3::new(-cy * sp * cr - sy * sr, -sy * sp * cr + cy * sr, cp * cr),
        )
    }

    /// `point_in_world` in the body frame: x ahead, y right, z up, metres.
    pub fn body_from_world_point(&self, point_in_world: DVec3) -> DVec3 {
        self.world_from_body().transpose() * (point_in_world - self.position_in_world)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_give_their_pose_back_straight_down_as_well() {
        for (pitch_rad, roll_rad) in [(-0.6, 0.3), (-0.5 * crate::real::PI, 0.0), (0.5 * crate::real::PI, 0.7)] {
            let axes = Pose { position_in_world: DVec3::ONE, pitch_rad, yaw_rad: 2.9, roll_rad }.world_from_body();
            let pose = Pose::of_axes(DVec3::ONE, axes);
            assert!(pose.world_from_body().abs_diff_eq(axes, 1e-9), "{pose:?}");
        }
    }

    #[test]
    fn a_looking_pose_sees_its_target_straight_ahead() {
        let target = DVec3::new(3.0, -8.0, 1.0);
        let pose = Pose::looking_at(DVec3::new(-20.0, 4.0, 25.0), target);
        let seen = pose.body_from_world_point(target);
        assert!(seen.y.abs() < 1e-12 && seen.z.abs() < 1e-12 && seen.x > 0.0, "{seen}");
    }

    #[test]
    fn the_rotation_is_orthonormal_and_left_handed_yaw_turns_x_towards_y() {
        let pose = Pose { position_in_world: DVec3::ZERO, pitch_rad: 0.3, yaw_rad: -2.0, roll_rad: 0.7 };
        let r = pose.world_from_body();
        assert!((r * r.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-12));
        let quarter = Pose { yaw_rad: core::f64::consts::FRAC_PI_2, ..Pose::looking_at(DVec3::ZERO, DVec3::X) };
        assert!((quarter.world_from_body() * DVec3::X - DVec3::Y).length() < 1e-12);
    }
}
