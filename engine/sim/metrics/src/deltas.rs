//! Waypoints from predicted increments.

use cosfly_frames::{Pose, action};
use serde::Serialize;

/// Axes of increments (dx, dy, dz in metres, dpitch, dyaw, droll in degrees). The paper does not specify them; the
/// `frames` and `waypoints` tables hold actions in both.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum DeltaFrame {
    /// The world's axes; angles are differences of pitch, yaw and roll.
    World,
    /// The body axes of the pose where the increment starts: x ahead, y right, z up.
    Body,
}

/// Pose where an increment starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum DeltaOrigin {
    /// The preceding waypoint: increments add up, as actions do.
    Previous,
    /// The current pose, for all increments.
    Current,
}

/// Writes the waypoints reached from `current` by `deltas` into `waypoints`.
pub fn waypoints(
    current: &Pose,
    deltas: &[[f64; 6]],
    frame: DeltaFrame,
    origin: DeltaOrigin,
    waypoints: &mut Vec<Pose>,
) {
    waypoints.clear();
    let mut from = *current;
    for delta in deltas {
        let reached = match frame {
            DeltaFrame::World => action::moved_in_world(&from, delta),
            DeltaFrame::Body => action::moved_in_body(&from, delta),
        };
        waypoints.push(reached);
        if origin == DeltaOrigin::Previous {
            from = reached;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::DVec3;
    use cosfly_random::Seed;

    #[test]
    fn true_increments_lead_to_the_true_waypoints_in_every_frame() {
        let mut stream = Seed::of_item(1, "deltas", "").stream("poses");
        let mut pose = || Pose {
            position_in_world: DVec3::from_array([0; 3].map(|_| stream.uniform(-50.0, 50.0))),
            pitch_rad: stream.uniform(-1.4, 1.4),
            yaw_rad: stream.uniform(-3.1, 3.1),
            roll_rad: stream.uniform(-1.0, 1.0),
        };
        let poses: Vec<Pose> = (0..6).map(|_| pose()).collect();
        for (frame, step) in
            [(DeltaFrame::World, action::in_world as fn(&_, &_) -> _), (DeltaFrame::Body, action::in_body)]
        {
            for origin in [DeltaOrigin::Previous, DeltaOrigin::Current] {
                let deltas: Vec<[f64; 6]> = (1..6)
                    .map(|k| step(&poses[if origin == DeltaOrigin::Current { 0 } else { k - 1 }], &poses[k]))
                    .collect();
                let mut reached = vec![];
                waypoints(&poses[0], &deltas, frame, origin, &mut reached);
                let errors = crate::errors(&reached, &poses[1..]);
                assert!(errors.ade_m < 1e-9 && errors.rotation_mae_deg < 1e-9, "{frame:?} {origin:?} {errors:?}");
            }
        }
    }
}
