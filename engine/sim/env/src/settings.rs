//! [`EnvironmentSettings`]: settings of an environment, apart from its episodes.

use cosfly_drone::models::{DroneModel, MODELS};
use cosfly_drone::{GimbalLimits, MotionLimits};
use cosfly_frames::{DVec3, Pose, Seed, real};
use cosfly_sensors::SensorSet;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Field of view of the camera.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FieldOfView {
    /// Horizontal field of view, degrees.
    pub horizontal_deg: f64,
    /// Height of the picture divided by its width.
    pub aspect: f64,
}

/// Stretches of an episode in which the camera sees nothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Blackouts {
    /// Number in an episode, one in each of so many equal parts of it.
    pub count: u32,
    /// Shortest and longest length, seconds.
    pub length_s: [f64; 2],
}

impl Blackouts {
    /// Beginnings and ends in an episode of a length, drawn from a seed.
    pub fn drawn(&self, seed: &Seed, duration_s: f64) -> Arc<[[f64; 2]]> {
        let mut stream = seed.stream("blackouts");
        let part_s = duration_s / f64::from(self.count.max(1));
        let drawn = (0..self.count).map(|number| {
            let length_s = stream.uniform(self.length_s[0], self.length_s[1]).min(0.5 * part_s);
            // Never at the ends of a part: the first sight and the end of the walk stay.
            let begins_s = f64::from(number) * part_s + stream.uniform(0.2, 0.9) * (part_s - length_s);
            [begins_s, begins_s + length_s]
        });
        drawn.collect()
    }
}

impl FieldOfView {
    /// Whether a point is inside the picture's borders.
    pub fn shows(&self, camera: &Pose, point_in_world: DVec3) -> bool {
        self.holds(camera.body_from_world_point(point_in_world))
    }

    /// Whether a point in the camera's frame is inside the picture's borders.
    pub fn holds(&self, seen: DVec3) -> bool {
        let right = real::tan(0.5 * self.horizontal_deg.to_radians());
        seen.x > 0.0 && seen.y.abs() <= right * seen.x && seen.z.abs() <= self.aspect * right * seen.x
    }
}

/// Weights of the terms of the reward.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RewardWeights {
    /// Weight of the share of the target that is seen in the picture.
    pub visibility: f64,
    /// Weight of the distance of the target from the picture's middle.
    pub framing: f64,
    /// Weight of the distance from the target, outside the wanted band.
    pub distance: f64,
    /// Weight of the acceleration.
    pub effort: f64,
    /// Weight of a collision.
    pub collision: f64,
    /// Weight of steps in which the target is not tracked.
    pub loss: f64,
}

/// Settings of an environment, apart from its episodes. Lengths in metres, times in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvironmentSettings {
    /// Time from one action to the next.
    pub step_s: f64,
    /// Time from an observation to the effect of the action that answers it. Meanwhile the world moves on, and no further
    /// action is asked for.
    pub latency_s: f64,
    /// Radius of the sphere around the drone that must touch nothing.
    pub radius_m: f64,
    /// The drone, and the air around it.
    pub drone: DroneSettings,
    /// Limits of motion; a quadrotor follows velocities as a point mass within them would.
    pub motion: MotionLimits,
    /// Limits of the camera's turns.
    pub gimbal: GimbalLimits,
    /// The camera.
    pub lens: FieldOfView,
    /// Stretches in which the camera sees nothing.
    pub blackouts: Blackouts,
    /// Sensors that are no cameras.
    pub sensors: SensorSet,
    /// A target is tracked only where at least this share of it is seen, 0..=1.
    pub least_visible: f64,
    /// A target is tracked only within this distance.
    pub farthest_m: f64,
    /// Wanted distance from the target: the reward's band.
    pub band_m: (f64, f64),
    /// An episode ends when the target was not tracked for this time.
    pub give_up_s: f64,
    /// Weights of the reward.
    pub weights: RewardWeights,
}

impl Default for EnvironmentSettings {
    fn default() -> Self {
        Self {
            step_s: 0.1,
            latency_s: 0.0,
            radius_m: 0.3,
            drone: DroneSettings::default(),
            motion: MotionLimits::default(),
            gimbal: GimbalLimits::default(),
            lens: FieldOfView { horizontal_deg: 90.0, aspect: 0.75 },
            blackouts: Blackouts { count: 0, length_s: [2.0, 4.0] },
            sensors: SensorSet::default(),
            least_visible: 0.5,
            farthest_m: 60.0,
            band_m: (10.0, 40.0),
            give_up_s: 10.0,
            weights: RewardWeights {
                visibility: 1.0,
                framing: 0.2,
                distance: 0.2,
                effort: 0.05,
                collision: 20.0,
                loss: 0.5,
            },
        }
    }
}

/// The drone of an environment and the air around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DroneSettings {
    /// Model.
    pub model: DroneModel,
    /// Speed of the mean wind, m/s; it blows along the level in a direction that each episode draws.
    pub wind_mps: f64,
    /// Whether the wind carries gusts (Dryden, near the ground).
    pub gusts: bool,
    /// Whether inertial unit, barometer and satellite receiver are sampled.
    pub sensors: bool,
}

impl Default for DroneSettings {
    fn default() -> Self {
        Self { model: MODELS[0], wind_mps: 0.0, gusts: false, sensors: false }
    }
}
