//! What a time step of the file says of each body, and states between two steps.

use cosfly_domain::BodyKind;
use cosfly_frames::{DVec2, TargetState, real};

use super::Place;
use cosfly_frames::DVec3;

/// A body in a time step.
#[derive(Clone, Debug)]
pub(super) struct Sample {
    pub id: String,
    pub kind: BodyKind,
    pub size_m: DVec3,
    /// Middle of the body, world frame.
    pub middle: DVec2,
    pub heading_rad: f64,
    pub speed_mps: f64,
}

impl Sample {
    /// A body whose position in the file is `point` and whose angle, degrees clockwise from north, is `angle_deg`. `None` where the
    /// projections know no such point.
    pub fn place(&mut self, place: &Place, point: DVec2, angle_deg: f64, is_person: bool) -> Option<()> {
        let (sin, cos) = real::sin_cos(angle_deg.to_radians());
        let front = place.plan(point)?;
        // One metre ahead in the file, in degrees by the length of a degree there.
        let metre = match place.is_geo() {
            true => DVec2::new(1.0 / (111_320.0 * real::cos(point.y.to_radians()).max(0.01)), 1.0 / 110_574.0),
            false => DVec2::ONE,
        };
        let ahead = place.plan(point + DVec2::new(sin, cos) * metre)? - front;
        let along = ahead.normalize_or_zero();
        self.heading_rad = real::atan2(along.y, along.x);
        // A vehicle's position is that of its front bumper.
        self.middle = if is_person { front } else { front - 0.5 * self.size_m.x * along };
        Some(())
    }

    /// The state a share of the way from this sample to the next one.
    pub fn towards(&self, next: &Self, share: f64, place: &Place) -> TargetState {
        let turn_rad = real::wrap_angle_rad(next.heading_rad - self.heading_rad);
        TargetState {
            feet_in_world: place.on_ground(self.middle.lerp(next.middle, share)),
            heading_rad: real::wrap_angle_rad(self.heading_rad + share * turn_rad),
            speed_mps: self.speed_mps + share * (next.speed_mps - self.speed_mps),
        }
    }
}
