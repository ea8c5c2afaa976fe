//! [`Gimbal`]: yaw and pitch of the camera, within limits of rate and angle.

use cosfly_frames::{DVec3, Pose, real};
use serde::{Deserialize, Serialize};

/// Limits of a gimbal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GimbalLimits {
    /// Yaw rate, radians/s.
    pub yaw_rate_rad_s: f64,
    /// Pitch rate, radians/s.
    pub pitch_rate_rad_s: f64,
    /// Lowest pitch, radians; negative values look down.
    pub lowest_pitch_rad: f64,
    /// Highest pitch, radians.
    pub highest_pitch_rad: f64,
}

impl Default for GimbalLimits {
    /// The planner's rates, from steeply down (89.9 degrees, as the pilot's aim) to 30 degrees up.
    fn default() -> Self {
        let rate = 60.0_f64.to_radians();
        let (lowest, highest) = ((-89.9_f64).to_radians(), 30.0_f64.to_radians());
        Self { yaw_rate_rad_s: rate, pitch_rate_rad_s: rate, lowest_pitch_rad: lowest, highest_pitch_rad: highest }
    }
}

impl GimbalLimits {
    /// Rates within the limits.
    pub fn clamped(&self, rates: &ViewRates) -> ViewRates {
        ViewRates {
            yaw_rad_s: rates.yaw_rad_s.clamp(-self.yaw_rate_rad_s, self.yaw_rate_rad_s),
            pitch_rad_s: rates.pitch_rad_s.clamp(-self.pitch_rate_rad_s, self.pitch_rate_rad_s),
        }
    }
}

/// Wanted rates of the view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewRates {
    /// Radians/s; positive: x towards y.
    pub yaw_rad_s: f64,
    /// Radians/s; positive: nose up.
    pub pitch_rad_s: f64,
}

/// Yaw and pitch of the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gimbal {
    /// Yaw, radians in (-pi, pi].
    pub yaw_rad: f64,
    /// Pitch, radians.
    pub pitch_rad: f64,
    /// Limits.
    pub limits: GimbalLimits,
}

impl Gimbal {
    /// Turns for `step_s` seconds. Rates that are not finite count as zero.
    pub fn step(&mut self, rates: &ViewRates, step_s: f64) {
        let finite = |rate: f64, limit: f64| if rate.is_finite() { rate.clamp(-limit, limit) } else { 0.0 };
        let yaw = finite(rates.yaw_rad_s, self.limits.yaw_rate_rad_s);
        let pitch = finite(rates.pitch_rad_s, self.limits.pitch_rate_rad_s);
        self.yaw_rad = real::wrap_angle_rad(self.yaw_rad + step_s * yaw);
        self.pitch_rad =
            (self.pitch_rad + step_s * pitch).clamp(self.limits.lowest_pitch_rad, self.limits.highest_pitch_rad);
    }

    /// Rates with which a step of `step_s` seconds ends at an aim at `point_in_world`, seen from `from_in_world`; before limits.
    pub fn rates_to(&self, from_in_world: DVec3, point_in_world: DVec3, step_s: f64) -> ViewRates {
        let wanted = Pose::looking_at(from_in_world, point_in_world);
        ViewRates {
            yaw_rad_s: real::wrap_angle_rad(wanted.yaw_rad - self.yaw_rad) / step_s,
            pitch_rad_s: (wanted.pitch_rad - self.pitch_rad) / step_s,
        }
    }

    /// Pose of a camera with this view.
    pub fn pose(&self, position_in_world: DVec3) -> Pose {
        Pose { position_in_world, pitch_rad: self.pitch_rad, yaw_rad: self.yaw_rad, roll_rad: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gimbal_turns_the_short_way_and_no_faster_than_it_can() {
        let mut gimbal = Gimbal { yaw_rad: 3.0, pitch_rad: 0.0, limits: GimbalLimits::default() };
        let behind = DVec3::new(-10.0, -2.0, -10.0);
        for _ in 0..4 {
            let before = gimbal;
            let rates = gimbal.rates_to(DVec3::ZERO, behind, 0.1);
            assert!(rates.yaw_rad_s > 0.0, "over the back, not through the front");
            gimbal.step(&rates, 0.1);
            let turn = real::wrap_angle_rad(gimbal.yaw_rad - before.yaw_rad).abs();
            assert!(turn <= 0.1 * gimbal.limits.yaw_rate_rad_s + 1e-12);
        }
        (0..20).for_each(|_| gimbal.step(&gimbal.rates_to(DVec3::ZERO, behind, 0.1), 0.1));
        let exact = Pose::looking_at(DVec3::ZERO, behind);
        assert!((gimbal.yaw_rad - exact.yaw_rad).abs() + (gimbal.pitch_rad - exact.pitch_rad).abs() < 1e-12);
        gimbal.step(&ViewRates { yaw_rad_s: f64::NAN, pitch_rad_s: 1e9 }, 100.0);
        assert_eq!(gimbal.pitch_rad, gimbal.limits.highest_pitch_rad);
    }
}
