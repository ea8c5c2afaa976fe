//! [`Airframe`]: the body of a quadrotor at one moment; its attitude follows from its acceleration.

use crate::place::SensorPlace;
use cosfly_frames::{DMat3, DVec3, Pose, action, real};

/// Acceleration of free fall, m/s^2.
pub const GRAVITY_MPS2: f64 = 9.81;

/// Least upward share of the weight that thrust carries, which keeps the attitude defined in a dive.
const LEAST_SHARE: f64 = 0.2;

/// Position and its derivatives by time, world frame, metres and seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Derivatives {
    /// Metres.
    pub position_in_world: DVec3,
    /// m/s.
    pub velocity_in_world: DVec3,
    /// m/s^2.
    pub acceleration_in_world: DVec3,
    /// m/s^3.
    pub jerk_in_world: DVec3,
}

/// The body of a drone, or a point that is fixed to it. Axes: x ahead, y right, z up.
///
/// Angular velocities `w` are those of `R' = R [w]x` in these left-handed axes: positive around z turns x towards y (the nose to the
/// right), around x turns y towards z (the right side up), around y turns z towards x (the nose down).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Airframe {
    /// Metres.
    pub position_in_world: DVec3,
    /// m/s.
    pub velocity_in_world: DVec3,
    /// m/s^2.
    pub acceleration_in_world: DVec3,
    /// Columns are the axes.
    pub world_from_body: DMat3,
    /// Angular velocity along the axes, rad/s.
    pub rates_in_body: DVec3,
    /// Angular acceleration along the axes, rad/s^2.
    pub turn_acceleration_in_body: DVec3,
}

impl Airframe {
    /// A quadrotor that flies a motion with its nose along a yaw: thrust, along its z axis, is its acceleration and its weight.
    pub fn flying(motion: &Derivatives, yaw_rad: f64, yaw_rate_rad_s: f64) -> Self {
        let (mut thrust, mut change) = (motion.acceleration_in_world + GRAVITY_MPS2 * DVec3::Z, motion.jerk_in_world);
        if thrust.z < LEAST_SHARE * GRAVITY_MPS2 {
            (thrust.z, change.z) = (LEAST_SHARE * GRAVITY_MPS2, 0.0);
        }
        let (sin, cos) = real::sin_cos(yaw_rad);
        let (nose, side) = (DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0));
        let up = thrust.normalize();
        let right = up.cross(nose).normalize();
        let ahead = right.cross(up);
        let up_change = (change - up * up.dot(change)) / thrust.length();
        let roll = -right.dot(up_change);
        // The right axis stays square to the nose's direction.
        let yaw = (yaw_rate_rad_s * right.dot(side) + roll * up.dot(nose)) / ahead.dot(nose);
        Self {
            position_in_world: motion.position_in_world,
            velocity_in_world: motion.velocity_in_world,
            acceleration_in_world: motion.acceleration_in_world,
            world_from_body: DMat3::from_cols(ahead, right, up),
            rates_in_body: DVec3::new(roll, ahead.dot(up_change), yaw),
            turn_acceleration_in_body: DVec3::ZERO,
        }
    }

    /// Motion of a thing that is fixed to the airframe at a place: the lever arm adds its turning.
    #[must_use]
    pub fn at(&self, place: &SensorPlace) -> Self {
        let (arm, rates) = (place.position_in_body, self.rates_in_body);
        let (body_from_sensor, turning) = (place.mount.body_from_camera(), self.turn_acceleration_in_body);
        let acceleration = turning.cross(arm) + rates.cross(rates.cross(arm));
        Self {
            position_in_world: self.position_in_world + self.world_from_body * arm,
            velocity_in_world: self.velocity_in_world + self.world_from_body * rates.cross(arm),
            acceleration_in_world: self.acceleration_in_world + self.world_from_body * acceleration,
            world_from_body: self.world_from_body * body_from_sensor,
            rates_in_body: body_from_sensor.transpose() * rates,
            turn_acceleration_in_body: body_from_sensor.transpose() * turning,
        }
    }

    /// Specific force along the axes, m/s^2: what an accelerometer reads; 9.81 up at rest.
    pub fn force_in_body(&self) -> DVec3 {
        self.world_from_body.transpose() * (self.acceleration_in_world + GRAVITY_MPS2 * DVec3::Z)
    }

    /// The pose.
    pub fn pose(&self) -> Pose {
        let [pitch_rad, yaw_rad, roll_rad] = action::angles_rad(&self.world_from_body);
        Pose { position_in_world: self.position_in_world, pitch_rad, yaw_rad, roll_rad }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thrust_lies_along_the_z_axis_and_gravity_is_up_at_rest() {
        let rest = Airframe::flying(&Derivatives::default(), 0.7, 0.2);
        assert!(rest.force_in_body().abs_diff_eq(GRAVITY_MPS2 * DVec3::Z, 1e-12));
        assert!(rest.rates_in_body.abs_diff_eq(0.2 * DVec3::Z, 1e-12), "the nose turns to the right");
        // Ahead along x: the nose goes down.
        let acceleration_in_world = DVec3::new(3.0, 0.0, 0.0);
        let ahead = Airframe::flying(&Derivatives { acceleration_in_world, ..Derivatives::default() }, 0.0, 0.0);
        let force = ahead.force_in_body();
        assert!(
            force.truncate().length() < 1e-12 && (force.z - (9.0 + GRAVITY_MPS2 * GRAVITY_MPS2).sqrt()).abs() < 1e-12
        );
        assert!((real::tan(-ahead.pose().pitch_rad) - 3.0 / GRAVITY_MPS2).abs() < 1e-12);
        // To the right, along y: the right side goes down.
        let acceleration_in_world = DVec3::new(0.0, 3.0, 0.0);
        let right = Airframe::flying(&Derivatives { acceleration_in_world, ..Derivatives::default() }, 0.0, 0.0);
        assert!(right.pose().roll_rad > 0.1);
        // In a fall nothing breaks.
        let acceleration_in_world = DVec3::new(0.0, 0.0, -GRAVITY_MPS2);
        let fall = Airframe::flying(&Derivatives { acceleration_in_world, ..Derivatives::default() }, 0.0, 0.0);
        assert!(fall.force_in_body().length() < 1e-12 && fall.world_from_body.is_finite());
    }
}
