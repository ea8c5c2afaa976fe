//! [`Body`]: one person or vehicle and its track.

use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec2, DVec3, Seed, TargetState, real};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Kinds of bodies that move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BodyKind {
    /// A person on foot.
    Pedestrian,
    /// A bicycle with its rider.
    Bicycle,
    /// A motorcycle with its rider.
    Motorcycle,
    /// A passenger car.
    Car,
    /// A van.
    Van,
    /// A lorry.
    Truck,
    /// A bus.
    Bus,
    /// A drone: another one behind the same target. No traffic has drones, so recipes cannot name the kind.
    #[schemars(skip)]
    Drone,
}

impl BodyKind {
    /// Kinds that walk and drive, in the order of their declaration: those of traffic.
    pub const ON_THE_GROUND: [Self; 7] =
        [Self::Pedestrian, Self::Bicycle, Self::Motorcycle, Self::Car, Self::Van, Self::Truck, Self::Bus];

    /// Name in recipes and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pedestrian => "pedestrian",
            Self::Bicycle => "bicycle",
            Self::Motorcycle => "motorcycle",
            Self::Car => "car",
            Self::Van => "van",
            Self::Truck => "truck",
            Self::Bus => "bus",
            Self::Drone => "drone",
        }
    }

    /// Whether the body is a person on foot.
    pub fn is_person(self) -> bool {
        self == Self::Pedestrian
    }
}

/// The properties of a body that do not change.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyPlan {
    /// Name in the source: of a recorded track, of a vehicle in a SUMO file; empty for simulated bodies.
    pub source: String,
    /// Kind of the body.
    pub kind: BodyKind,
    /// Length along the heading, width and height, metres. A person is a cylinder: length and width are twice its radius.
    pub size_m: DVec3,
    /// Seed of clothes or paint.
    pub looks: Seed,
    /// Number of the group that the body moves with.
    pub group: Option<u32>,
}

/// One person, vehicle or drone and its track.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Body {
    /// What does not change.
    pub plan: BodyPlan,
    /// Frame of the first state; before it and after the last state the body is absent.
    pub first_frame: u32,
    /// One state per frame: middle of the body on the ground, heading, speed.
    pub states: Vec<TargetState>,
}

impl BodyPlan {
    /// Radius of a person seen from above; of a vehicle, of the circle around its outline, metres.
    pub fn radius_m(&self) -> f64 {
        match self.kind {
            BodyKind::Pedestrian => 0.5 * self.size_m.x,
            _ => 0.5 * self.size_m.truncate().length(),
        }
    }

    /// Upright box around the body in a state, world frame.
    pub fn box_at(&self, state: &TargetState) -> OrientedBox {
        OrientedBox {
            center_in_world: state.feet_in_world + DVec3::Z * (0.5 * self.size_m.z),
            half_extents_m: 0.5 * self.size_m,
            yaw_rad: state.heading_rad,
        }
    }

    /// Distance between two bodies seen from above, metres; negative where they overlap. Exact for two cylinders and for a
    /// cylinder beside a box; for two boxes the largest gap along one of their axes, which is negative exactly where they overlap.
    pub fn gap_m(&self, state: &TargetState, other: &Self, other_state: &TargetState) -> f64 {
        let between = (other_state.feet_in_world - state.feet_in_world).truncate();
        match (self.kind.is_person(), other.kind.is_person()) {
            (true, true) => between.length() - self.radius_m() - other.radius_m(),
            (false, true) => self.plan_distance_m(state, between) - other.radius_m(),
            (true, false) => other.plan_distance_m(other_state, -between) - self.radius_m(),
            (false, false) => {
                let axes = [self.axes(state), other.axes(other_state)];
                let gap = |axis: DVec2| {
                    let reach = |plan: &Self, [along, across]: [DVec2; 2]| {
                        0.5 * (plan.size_m.x * axis.dot(along).abs() + plan.size_m.y * axis.dot(across).abs())
                    };
                    axis.dot(between).abs() - reach(self, axes[0]) - reach(other, axes[1])
                };
                axes.into_iter().flatten().map(gap).fold(f64::NEG_INFINITY, f64::max)
            }
        }
    }

    /// Unit vectors along and across the body seen from above.
    fn axes(&self, state: &TargetState) -> [DVec2; 2] {
        let (sin, cos) = real::sin_cos(state.heading_rad);
        [DVec2::new(cos, sin), DVec2::new(-sin, cos)]
    }

    /// Signed distance from the outline of a box to a point that lies `offset` from its middle.
    fn plan_distance_m(&self, state: &TargetState, offset: DVec2) -> f64 {
        let [along, across] = self.axes(state);
        let excess = DVec2::new(offset.dot(along), offset.dot(across)).abs() - 0.5 * self.size_m.truncate();
        excess.max(DVec2::ZERO).length() + excess.max_element().min(0.0)
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
        self.states.windows(2).map(|pair| (pair[1].feet_in_world - pair[0].feet_in_world).length()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(kind: BodyKind, length_m: f64, width_m: f64) -> BodyPlan {
        let size_m = DVec3::new(length_m, width_m, 1.5);
        BodyPlan { source: String::new(), kind, size_m, looks: Seed([0; 32]), group: None }
    }

    fn at(x: f64, y: f64, heading_rad: f64) -> TargetState {
        TargetState { feet_in_world: DVec3::new(x, y, 0.0), heading_rad, speed_mps: 0.0 }
    }

    #[test]
    fn gaps_are_those_of_circles_and_boxes() {
        let (person, car) = (plan(BodyKind::Pedestrian, 0.5, 0.5), plan(BodyKind::Car, 4.0, 2.0));
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
        close(person.gap_m(&at(0.0, 0.0, 0.0), &person, &at(0.3, 0.4, 1.0)), 0.0);
        close(car.gap_m(&at(0.0, 0.0, 0.0), &person, &at(5.0, 5.0, 0.0)), 5.0 - 0.25);
        close(person.gap_m(&at(0.0, 2.0, 0.0), &car, &at(0.0, 0.0, real::FRAC_PI_2)), 2.0 - 2.0 - 0.25);
        close(car.gap_m(&at(0.0, 0.0, 0.0), &person, &at(0.5, 0.0, 0.0)), -1.0 - 0.25);
        close(car.gap_m(&at(0.0, 0.0, 0.0), &car, &at(5.0, 0.0, 0.0)), 1.0);
        close(car.gap_m(&at(0.0, 0.0, 0.0), &car, &at(0.0, 3.5, real::FRAC_PI_2)), 0.5);
        assert!(car.gap_m(&at(0.0, 0.0, 0.0), &car, &at(3.0, 1.5, 0.7)) < 0.0);
    }
}
