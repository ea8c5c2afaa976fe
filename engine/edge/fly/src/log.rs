//! [`LogLine`]: the state after a step, as logs keep it.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_env::{Action, End, Environment, Reward, readings};
use cosfly_frames::{DVec3, Pose};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The state after a step. Vectors are in the world frame, metres and m/s.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LogLine {
    /// Steps since the beginning.
    pub step: u32,
    /// Time since the beginning, seconds.
    pub time_s: f64,
    /// Place of the drone.
    pub position_in_world: [f64; 3],
    /// Velocity of the drone.
    pub velocity_in_world: [f64; 3],
    /// Yaw of drone and camera.
    pub yaw_deg: f64,
    /// Pitch of the camera.
    pub pitch_deg: f64,
    /// Place of the target's feet.
    pub target_in_world: [f64; 3],
    /// Share of the target that is seen, in the picture or not.
    pub visible: f64,
    /// Whether the target is in the picture.
    pub in_picture: bool,
    /// Whether the target counts as tracked.
    pub tracked: bool,
    /// Attitude of a quadrotor in the right-handed frame (y of the world negated): x, y, z, w.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attitude_xyzw: Option<[f64; 4]>,
    /// Numbers of the action, in the form of its kind, where the policy gave one before the step: velocity ahead, right and up
    /// (m/s), pitch and yaw rate (degrees/s); or thrust and rates, or speeds of rotors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Vec<f64>>,
    /// The action as it was flown, in radians: with it the step can be flown again to the bit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flown: Option<Action>,
    /// Time that the policy took for it, where latencies are measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub latency_s: Option<f64>,
    /// Readings of the sensors that are asked for, by sensor.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub readings: BTreeMap<String, Vec<f64>>,
    /// Terms of the reward, unweighted, in the order of the card's list.
    pub reward: [f64; 6],
    /// Why the episode ended in this step.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end: Option<End>,
}

impl LogLine {
    /// The state of an environment after a step.
    pub fn of(environment: &Environment, action: Option<&Action>, reward: &Reward, end: Option<End>) -> Self {
        let seen = environment.observation();
        let target = environment.episode().target_at(seen.time_s);
        Self {
            step: seen.step,
            time_s: seen.time_s,
            position_in_world: seen.motion.position_in_world.to_array(),
            velocity_in_world: seen.motion.velocity_in_world.to_array(),
            yaw_deg: seen.yaw_rad.to_degrees(),
            pitch_deg: seen.pitch_rad.to_degrees(),
            target_in_world: target.feet_in_world.to_array(),
            visible: seen.visible,
            in_picture: seen.in_picture,
            tracked: seen.tracked,
            attitude_xyzw: environment.attitude_xyzw(),
            action: action.map(|action| action.row(seen.yaw_rad)),
            flown: action.copied(),
            latency_s: None,
            readings: readings(environment).into_iter().map(|(sensor, it)| (sensor.name.to_owned(), it)).collect(),
            reward: reward.terms(),
            end,
        }
    }

    /// Pose of the camera.
    pub fn pose(&self) -> Pose {
        Pose {
            position_in_world: DVec3::from_array(self.position_in_world),
            pitch_rad: self.pitch_deg.to_radians(),
            yaw_rad: self.yaw_deg.to_radians(),
            roll_rad: 0.0,
        }
    }
}

/// Steps as a text, one line of JSON each.
pub fn text(steps: &[LogLine]) -> String {
    let line = |line: &LogLine| serde_json::to_string(line).unwrap_or_default() + "\n";
    steps.iter().map(line).collect()
}

/// Reads what [`text`] wrote.
///
/// # Errors
/// `fly-result`, with the place.
pub fn read(text: &str) -> Result<Vec<LogLine>> {
    let line = |(at, line): (usize, &str)| {
        serde_json::from_str(line).map_err(|error| {
            let message = format!("line {} of a log is damaged", at + 1);
            Diagnostic::new("fly-result", Fault::Input, message).because(error.to_string())
        })
    };
    text.lines().enumerate().map(line).collect()
}
