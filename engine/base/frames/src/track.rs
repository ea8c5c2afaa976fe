//! Track of the target: one state per frame at a fixed time step.

use crate::real;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// State of the target in one frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TargetState {
    /// Ground point between the feet, world frame, metres.
    pub feet_in_world: DVec3,
    /// Walking direction (kept while standing), radians, signed like a yaw.
    pub heading_rad: f64,
    /// Speed along the ground, m/s; 0 while standing.
    pub speed_mps: f64,
}

impl TargetState {
    /// The state a share of the way to another one; the heading turns the shorter way.
    pub fn toward(&self, to: &Self, share: f64) -> Self {
        let turn = real::wrap_angle_rad(to.heading_rad - self.heading_rad);
        Self {
            feet_in_world: self.feet_in_world.lerp(to.feet_in_world, share),
            heading_rad: real::wrap_angle_rad(self.heading_rad + share * turn),
            speed_mps: self.speed_mps + share * (to.speed_mps - self.speed_mps),
        }
    }
}

/// A target's states at a fixed time step; frame `i` is at `i * dt_s`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TargetTrack {
    /// Time between frames, seconds.
    pub dt_s: f64,
    /// Body height, metres.
    pub height_m: f64,
    /// Body radius seen from above, metres.
    pub radius_m: f64,
    /// One state per frame.
    pub states: Vec<TargetState>,
}

impl TargetTrack {
    /// Number of frames.
    pub fn len(&self) -> usize {
        self.states.len()
    }

    /// Whether the track has no frame.
    pub fn is_empty(&self) -> bool {
        self.states.is_empty()
    }

    /// Time of the last frame, seconds.
    pub fn duration_s(&self) -> f64 {
        self.dt_s * self.states.len().saturating_sub(1) as f64
    }

    /// Distance walked along the ground, metres.
    pub fn length_m(&self) -> f64 {
        way_m(&self.states)
    }
}

/// Distance covered from the first state to the last, metres.
pub fn way_m(states: &[TargetState]) -> f64 {
    states.windows(2).map(|pair| (pair[1].feet_in_world - pair[0].feet_in_world).length()).sum()
}
