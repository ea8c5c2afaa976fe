//! The pinhole camera: intrinsics, and the way from the world to a pixel.

use cosfly_frames::{DMat3, DVec3, Pose, real};
use serde::{Deserialize, Serialize};

/// A pinhole camera with square pixels and the optical centre in the image centre (CARLA's camera).
/// Pixel (0, 0) is the top-left pixel; its centre is at (0.5, 0.5).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// Image width, pixels.
    pub width: u32,
    /// Image height, pixels.
    pub height: u32,
    /// Horizontal field of view, radians.
    pub horizontal_fov_rad: f64,
}

impl Camera {
    /// Field of view with which a focal length is pixels per radian of an equirectangular picture: 2 atan(pi).
    pub const ALL_AROUND_FOV_RAD: f64 = 2.525_254_511_357_823_5;

    /// Focal length in pixels, the same for both axes: width / (2 tan(fov / 2)).
    pub fn focal_px(&self) -> f64 {
        f64::from(self.width) / (2.0 * real::tan(0.5 * self.horizontal_fov_rad))
    }

    /// Middle of the image (u, v) and focal length, pixels.
    pub fn centre_and_focal_px(&self) -> (f64, f64, f64) {
        (0.5 * f64::from(self.width), 0.5 * f64::from(self.height), self.focal_px())
    }

    /// Pixel coordinates (u right, v down) and planar depth (metres along the optical axis) of a world point;
    /// `None` when it is not in front of the camera.
    pub fn project(&self, pose: &Pose, point_in_world: DVec3) -> Option<(f64, f64, f64)> {
        self.project_seen(pose.body_from_world_point(point_in_world))
    }

    /// Pixel coordinates and planar depth of a point before the camera (x ahead, y right, z up, metres).
    pub fn project_seen(&self, seen: DVec3) -> Option<(f64, f64, f64)> {
        if seen.x <= 1e-6 {
            return None;
        }
        let (cx, cy, focal) = self.centre_and_focal_px();
        Some((cx + focal * seen.y / seen.x, cy - focal * seen.z / seen.x, seen.x))
    }

    /// The world direction through pixel coordinates (u, v), scaled so that its length along the optical
    /// axis is 1: `pose.position_in_world + depth * ray` is the point at that planar depth.
    pub fn ray_in_world(&self, pose: &Pose, u: f64, v: f64) -> DVec3 {
        let focal = self.focal_px();
        let y = (u - 0.5 * f64::from(self.width)) / focal;
        let z = (0.5 * f64::from(self.height) - v) / focal;
        pose.world_from_body() * DVec3::new(1.0, y, z)
    }
}

/// Place and turn of the camera on the drone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Mount {
    /// Position along the drone's axes: ahead, right, up; metres.
    pub position_in_body_m: DVec3,
    /// Shift along the camera's own right axis, metres: the base line of the right camera of a stereo pair.
    pub right_m: f64,
    /// Turn around the optical axis, after yaw and pitch, radians; positive: right side down.
    pub roll_rad: f64,
    /// Turn upwards, after the yaw, radians.
    pub pitch_rad: f64,
    /// Turn to the right around the drone's up axis, radians; around the vertical where the mount is levelled.
    pub yaw_rad: f64,
    /// A gimbal holds the horizon level, whatever the drone's tilt: the turns add to the drone's yaw and pitch, not to its roll.
    pub levelled: bool,
}

/// One camera of a stereo pair.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StereoEye {
    /// Distance between the two cameras, along their right axis, metres.
    pub base_line_m: f64,
    /// Whether it is the right one.
    pub is_right: bool,
}

impl StereoEye {
    /// Shift of the camera along its right axis, metres.
    pub fn right_m(&self) -> f64 {
        if self.is_right { self.base_line_m } else { 0.0 }
    }
}

impl Mount {
    /// Columns are the camera's axes (x ahead, y right, z up) in the drone's body frame.
    pub fn body_from_camera(&self) -> DMat3 {
        self.turn().world_from_body()
    }

    /// Turn and place of the camera in the drone's body frame, without the shift to the right.
    pub fn turn(&self) -> Pose {
        let Self { position_in_body_m, pitch_rad, yaw_rad, roll_rad, .. } = *self;
        Pose { position_in_world: position_in_body_m, pitch_rad, yaw_rad, roll_rad }
    }

    /// Whether the camera sits in the drone's origin.
    pub fn is_in_origin(&self) -> bool {
        self.position_in_body_m == DVec3::ZERO && self.right_m == 0.0
    }

    /// The pose of the camera on a drone at `body`; the very pose of the drone when nothing is turned or moved.
    pub fn camera_pose(&self, body: &Pose) -> Pose {
        let turned = self.turned(body);
        if self.is_in_origin() {
            return turned;
        }
        let place = body.world_from_body() * self.position_in_body_m;
        let aside = turned.world_from_body() * DVec3::new(0.0, self.right_m, 0.0);
        Pose { position_in_world: body.position_in_world + place + aside, ..turned }
    }

    fn turned(&self, body: &Pose) -> Pose {
        let rolls = self.levelled && body.roll_rad != 0.0;
        if [self.pitch_rad, self.yaw_rad, self.roll_rad] == [0.0; 3] && !rolls {
            return *body;
        }
        if self.levelled {
            let pitch_rad = (body.pitch_rad + self.pitch_rad).clamp(-0.5 * real::PI, 0.5 * real::PI);
            let yaw_rad = real::wrap_angle_rad(body.yaw_rad + self.yaw_rad);
            return Pose { pitch_rad, yaw_rad, roll_rad: self.roll_rad, ..*body };
        }
        let world_from_camera = body.world_from_body() * self.body_from_camera();
        Pose::of_axes(body.position_in_world, world_from_camera)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_camera_looks_where_its_mount_says() {
        let body = Pose { position_in_world: DVec3::ONE, pitch_rad: -0.6, yaw_rad: 2.9, roll_rad: 0.2 };
        let mount = Mount { pitch_rad: 0.3, yaw_rad: -0.8, ..Mount::default() };
        let expected = body.world_from_body() * mount.body_from_camera();
        assert!(mount.camera_pose(&body).world_from_body().abs_diff_eq(expected, 1e-12));
        assert_eq!(Mount::default().camera_pose(&body), body);
        // Level drone: yaw and pitch just add.
        let level = Pose { pitch_rad: 0.0, roll_rad: 0.0, ..body };
        let turned = mount.camera_pose(&level);
        assert!((turned.pitch_rad - 0.3).abs() < 1e-12 && (turned.yaw_rad - 2.1).abs() < 1e-12);
        assert!(turned.roll_rad.abs() < 1e-12);
    }

    #[test]
    fn a_levelled_camera_holds_the_horizon_on_any_drone() {
        let body = Pose { position_in_world: DVec3::ONE, pitch_rad: -0.6, yaw_rad: 2.9, roll_rad: 0.2 };
        let mount = Mount { pitch_rad: 0.3, yaw_rad: 0.8, levelled: true, ..Mount::default() };
        let camera = mount.camera_pose(&body);
        assert_eq!((camera.roll_rad, camera.position_in_world), (0.0, body.position_in_world));
        let turned = real::wrap_angle_rad(camera.yaw_rad - 3.7);
        assert!((camera.pitch_rad + 0.3).abs() < 1e-12 && turned.abs() < 1e-12, "{camera:?}");
        assert_eq!(Mount { levelled: true, ..Mount::default() }.camera_pose(&body), Pose { roll_rad: 0.0, ..body });
        // Beyond straight down it stops.
        let down = Mount { pitch_rad: -1.4, ..mount }.camera_pose(&body);
        assert!((down.pitch_rad + 0.5 * real::PI).abs() < 1e-12);
    }

    #[test]
    fn the_right_camera_of_a_pair_sees_every_point_in_the_same_row_a_disparity_to_the_left() {
        let camera = Camera { width: 640, height: 360, horizontal_fov_rad: 1.4 };
        let body = Pose { position_in_world: DVec3::ONE, pitch_rad: -0.6, yaw_rad: 2.9, roll_rad: 0.2 };
        let place = DVec3::new(0.3, -0.1, 0.05);
        for levelled in [false, true] {
            let left = Mount {
                position_in_body_m: place,
                pitch_rad: 0.2,
                yaw_rad: 0.5,
                roll_rad: -0.3,
                levelled,
                right_m: 0.0,
            };
            let [left, right] = [left, Mount { right_m: 0.12, ..left }].map(|mount| mount.camera_pose(&body));
            let offset_m = left.position_in_world - body.position_in_world - body.world_from_body() * place;
            assert!(offset_m.length() < 1e-12);
            let point = left.position_in_world + left.world_from_body() * DVec3::new(9.0, -2.0, 1.0);
            let [a, b] = [left, right].map(|pose| camera.project(&pose, point).expect("it is ahead"));
            assert!((a.1 - b.1).abs() < 1e-9 && (a.2 - b.2).abs() < 1e-9, "{a:?} {b:?}");
            assert!((a.0 - b.0 - camera.focal_px() * 0.12 / 9.0).abs() < 1e-9);
        }
    }
}
