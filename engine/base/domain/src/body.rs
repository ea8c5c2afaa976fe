//! [`Body`]: one person or vehicle and its track.

use crate::{BodyKind, OrientedBox};
use cosfly_frames::track::way_m;
use cosfly_frames::{DVec3, Seed, TargetState};
use serde::{Deserialize, Serialize};

/// The properties of a body that do not change.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyPlan {
    /// Name in the source: of a recorded track, of a vehicle in a SUMO file; empty for simulated bodies.
    pub source: String,
    /// Kind of the body.
    pub kind: BodyKind,
    /// Length along the heading, width and height, metres. A person is a cylinder: length and width are twice its radius, unless the
    /// person takes something along.
    pub size_m: DVec3,
    /// Seed of clothes or paint.
    pub looks: Seed,
    /// Number of the group that the body moves with.
    pub group: Option<u32>,
}

/// One person, vehicle or drone and its track.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Body {
    /// Properties that do not change.
    pub plan: BodyPlan,
    /// Frame of the first state; before it and after the last state the body is absent.
    pub first_frame: u32,
    /// One state per frame: middle of the body on the ground, heading, speed.
    pub states: Vec<TargetState>,
}

impl BodyPlan {
    /// Radius of a person seen from above; of a vehicle, of the circle around its outline, metres.
    pub fn radius_m(&self) -> f64 {
        if self.kind.is_person() { 0.5 * self.size_m.x } else { 0.5 * self.size_m.truncate().length() }
    }

    /// Upright box around the body in a state, world frame.
    pub fn box_at(&self, state: &TargetState) -> OrientedBox {
        OrientedBox {
            center_in_world: state.feet_in_world + DVec3::Z * (0.5 * self.size_m.z),
            half_extents_m: 0.5 * self.size_m,
            yaw_rad: state.heading_rad,
        }
    }
}

impl Body {
    /// State in a frame; `None` where the body is absent.
    pub fn state(&self, frame: u32) -> Option<&TargetState> {
        self.states.get(frame.checked_sub(self.first_frame)? as usize)
    }

    /// Frame after the last state.
    pub fn end_frame(&self) -> u32 {
        self.first_frame.saturating_add(u32::try_from(self.states.len()).unwrap_or(u32::MAX))
    }

    /// Distance covered, metres.
    pub fn length_m(&self) -> f64 {
        way_m(&self.states)
    }
}
