//! [`PointMass`]: a drone that follows velocities within limits of speed, acceleration and jerk.

use cosfly_frames::DVec3;

/// Position and its derivatives, world frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Metres.
    pub position_in_world: DVec3,
    /// Metres per second.
    pub velocity_in_world: DVec3,
    /// Mean acceleration of the last step, m/s^2.
    pub acceleration_in_world: DVec3,
}

/// Limits of motion; the names and units are those of the planner's limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionLimits {
    /// Speed, m/s.
    pub speed_mps: f64,
    /// Acceleration, m/s^2.
    pub acceleration_mps2: f64,
    /// Jerk, m/s^3.
    pub jerk_mps3: f64,
}

impl Default for MotionLimits {
    /// The planner's defaults.
    fn default() -> Self {
        Self { speed_mps: 12.0, acceleration_mps2: 6.0, jerk_mps3: 12.0 }
    }
}

/// Wanted motion at the end of a step, world frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VelocityCommand {
    /// Metres per second.
    pub velocity_in_world: DVec3,
    /// Acceleration with which the wanted velocity changes, m/s^2; zero for a velocity that stays.
    pub acceleration_in_world: DVec3,
}

/// A drone that follows velocities within limits.
///
/// A step of `h` seconds changes the velocity by `h` times an acceleration `a`, and the position by `h` times the new velocity:
/// finite differences of the positions are the velocities and accelerations, as in the planner's certificates. Speed and
/// acceleration never exceed their limits. Jerk does only where a drone at full speed is turned by the limit of speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointMass {
    /// Present state.
    pub motion: Motion,
    /// Limits.
    pub limits: MotionLimits,
}

impl PointMass {
    /// Moves on by `step_s` seconds (above 0). Commands that are not finite count as zero.
    pub fn step(&mut self, command: &VelocityCommand, step_s: f64) {
        let Motion { position_in_world, velocity_in_world: before, acceleration_in_world: last } = self.motion;
        let limits = &self.limits;
        let finite = |vector: DVec3| if vector.is_finite() { vector } else { DVec3::ZERO };
        let (wanted, ahead) = (finite(command.velocity_in_world), finite(command.acceleration_in_world));
        let wanted = wanted.clamp_length_max(limits.speed_mps);
        let missing = wanted - (before + step_s * ahead);
        let acceleration = ahead + approach(missing, limits.jerk_mps3, step_s);
        let change = (acceleration - last).clamp_length_max(limits.jerk_mps3 * step_s);
        let acceleration = (last + change).clamp_length_max(limits.acceleration_mps2);
        // Projections onto balls that contain the present values: neither undoes the one before it.
        let velocity = (before + step_s * acceleration).clamp_length_max(limits.speed_mps);
        self.motion = Motion {
            position_in_world: position_in_world + step_s * velocity,
            velocity_in_world: velocity,
            acceleration_in_world: (velocity - before) / step_s,
        };
    }
}

/// Acceleration that removes a difference of velocity as fast as `jerk_mps3` allows without going beyond it: it can fall
/// to zero, step by step, while the difference does.
fn approach(missing_mps: DVec3, jerk_mps3: f64, step_s: f64) -> DVec3 {
    let size_mps = missing_mps.length();
    if size_mps <= 0.0 {
        return DVec3::ZERO;
    }
    // The largest a with a + (a - j) + (a - 2 j) + ... = difference / h over positive terms, where j falls in a step.
    let (falls, sum) = (jerk_mps3 * step_s, size_mps / step_s);
    let steps = (0.5 * ((1.0 + 8.0 * sum / falls).sqrt() - 1.0)).ceil().max(1.0);
    let acceleration = sum / steps + 0.5 * falls * (steps - 1.0);
    missing_mps * (acceleration / size_mps)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::Seed;

    #[test]
    fn limits_hold_under_random_commands() {
        let mut random = Seed([3; 32]).stream("commands");
        let limits = MotionLimits::default();
        let mut drone = PointMass { motion: Motion::default(), limits };
        let mut command = VelocityCommand::default();
        for step in 0..20_000 {
            if step % 7 == 0 {
                command.velocity_in_world = DVec3::from_array(core::array::from_fn(|_| random.uniform(-30.0, 30.0)));
            }
            let before = drone.motion;
            drone.step(&command, 0.1);
            let after = drone.motion;
            assert!(after.velocity_in_world.length() <= limits.speed_mps + 1e-9);
            assert!(after.acceleration_in_world.length() <= limits.acceleration_mps2 + 1e-9);
            let jerk = (after.acceleration_in_world - before.acceleration_in_world).length() / 0.1;
            let is_at_full_speed = after.velocity_in_world.length() > limits.speed_mps - 1e-6;
            assert!(jerk <= limits.jerk_mps3 + 1e-6 || is_at_full_speed, "{jerk} at step {step}");
        }
    }

    #[test]
    fn a_velocity_is_reached_without_going_beyond_it() {
        for step_s in [0.02, 0.1, 0.5] {
            let mut drone = PointMass { motion: Motion::default(), limits: MotionLimits::default() };
            let command =
                VelocityCommand { velocity_in_world: DVec3::new(8.0, 0.0, 0.0), ..VelocityCommand::default() };
            for _ in 0..(6.0 / step_s) as usize {
                drone.step(&command, step_s);
                assert!(drone.motion.velocity_in_world.x <= 8.0 + 1e-9, "{step_s}");
            }
            assert!((drone.motion.velocity_in_world.x - 8.0).abs() < 1e-6, "{step_s}");
        }
    }

    #[test]
    fn commands_that_are_not_finite_stop_the_drone() {
        let mut drone = PointMass { motion: Motion::default(), limits: MotionLimits::default() };
        drone.step(&VelocityCommand { velocity_in_world: DVec3::NAN, acceleration_in_world: DVec3::INFINITY }, 0.1);
        assert_eq!(drone.motion, Motion::default());
    }
}
