//! [`Settings`]: what an environment is set to, apart from its episodes.

use cosfly_drone::{GimbalLimits, MotionLimits};
use serde::{Deserialize, Serialize};

/// Field of view of the camera.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lens {
    /// Horizontal field of view, degrees.
    pub horizontal_deg: f64,
    /// Height of the picture divided by its width.
    pub aspect: f64,
}

/// Weights of the terms of the reward.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RewardWeights {
    /// Of the share of the target that is seen in the picture.
    pub visibility: f64,
    /// Of the distance of the target from the picture's middle.
    pub framing: f64,
    /// Of the distance from the target, outside the wanted band.
    pub distance: f64,
    /// Of the acceleration.
    pub effort: f64,
    /// Of a collision.
    pub collision: f64,
    /// Of steps in which the target is not tracked.
    pub loss: f64,
}

/// What an environment is set to, apart from its episodes. Lengths in metres, times in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Time from one action to the next.
    pub step_s: f64,
    /// Time from an observation to the effect of the action that answers it. Meanwhile the world moves on, and no further
    /// action is asked for.
    pub latency_s: f64,
    /// Radius of the sphere around the drone that must touch nothing.
    pub radius_m: f64,
    /// Limits of motion.
    pub motion: MotionLimits,
    /// Limits of the camera's turns.
    pub gimbal: GimbalLimits,
    /// The camera.
    pub lens: Lens,
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

impl Default for Settings {
    fn default() -> Self {
        Self {
            step_s: 0.1,
            latency_s: 0.0,
            radius_m: 0.3,
            motion: MotionLimits::default(),
            gimbal: GimbalLimits::default(),
            lens: Lens { horizontal_deg: 90.0, aspect: 0.75 },
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
