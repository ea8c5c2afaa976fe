//! [`BodyShape`]: a person, or a vehicle of a kind and size.

use crate::region::Region;
use crate::umbrella;
use cosfly_domain::{BodyKind, SemanticLabel, Walking};
use cosfly_frames::{DVec3, Seed, real};

/// Largest vehicle that is drawn, metres along each axis.
const LARGEST_M: f64 = 60.0;

/// Shape of a body: a person, or a vehicle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BodyShape {
    /// A person on foot who takes nothing along but bags.
    Person {
        /// Whether the person holds an open umbrella, which is a part of the figure: see [`BodyShape::in_rain`].
        umbrella: bool,
        /// How the person bears the body.
        posture: Posture,
    },
    /// A vehicle, with its rider where it has one, a person with what the person takes along, or a drone.
    Vehicle {
        /// Kind of the vehicle; a pedestrian is drawn as a car.
        kind: BodyKind,
        /// Length, width and height, metres: the model fills the box of [`cosfly_domain::BodyPlan::box_at`].
        size_m: DVec3,
    },
}

/// How a person on foot bears the body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Posture {
    /// Upright, arms free.
    #[default]
    Upright,
    /// Stooped, with short steps and a stick.
    Stooped,
    /// Leaning ahead, with long steps and bent arms.
    Running,
    /// Both hands ahead on a handle.
    Pushing,
    /// The right hand on a leash.
    Leading,
}

impl Default for BodyShape {
    /// A person without an umbrella.
    fn default() -> Self {
        Self::Person { umbrella: false, posture: Posture::Upright }
    }
}

impl BodyShape {
    /// The shape of a body of a kind and size.
    pub fn of(kind: BodyKind, size_m: DVec3) -> Self {
        match kind.row().walking {
            Some(Walking { outline_m: None, .. }) => {
                let posture = match kind {
                    BodyKind::Elder => Posture::Stooped,
                    BodyKind::Runner => Posture::Running,
                    _ => Posture::Upright,
                };
                Self::Person { umbrella: false, posture }
            }
            _ => Self::Vehicle { kind, size_m },
        }
    }

    /// The shape of somebody with these looks in the rain, followed or not: people on foot may open umbrellas.
    pub fn in_rain(self, precipitation: f64, looks: &Seed) -> Self {
        match self {
            Self::Person { posture, .. } => {
                let umbrella = posture != Posture::Running && umbrella::opens(precipitation, looks);
                Self::Person { umbrella, posture }
            }
            vehicle @ Self::Vehicle { .. } => vehicle,
        }
    }

    /// Whether a person on foot moves.
    pub fn is_person(&self) -> bool {
        matches!(self, Self::Person { .. })
    }

    /// Whether somebody holds an open umbrella.
    pub fn has_umbrella(&self) -> bool {
        matches!(self, Self::Person { umbrella: true, .. })
    }

    /// How a person bears the body.
    pub(crate) fn posture(&self) -> Posture {
        if let Self::Person { posture, .. } = self { *posture } else { Posture::Upright }
    }

    /// CARLA's label of a region of the body. Vans are cars; riders have a label of their own; drones, and what
    /// people on foot take along, are dynamic things.
    pub fn label(&self, region: Region) -> SemanticLabel {
        let Self::Vehicle { kind, .. } = self else { return SemanticLabel::Pedestrian };
        let row = kind.row();
        match (&row.walking, region.is_of_people()) {
            (Some(_), false) => SemanticLabel::Dynamic,
            (None, true) => SemanticLabel::Rider,
            (Some(_), true) | (None, false) => row.label,
        }
    }

    /// Half the diagonal of a vehicle's box, metres; 0 for people, whose extent every bound counts in.
    pub fn reach_m(&self) -> f64 {
        match self {
            Self::Person { .. } => 0.0,
            Self::Vehicle { size_m, .. } => 0.5 * size_m.length(),
        }
    }

    /// Height of the body, metres; `of_person` for a person.
    pub fn height_m(&self, of_person: f64) -> f64 {
        match self {
            Self::Person { .. } => of_person,
            Self::Vehicle { size_m, .. } => size_m.z,
        }
    }

    /// Half the size of the upright box around a turned vehicle, metres.
    pub(crate) fn half_bounds_m(size_m: DVec3, heading_rad: f64) -> DVec3 {
        let (sin, cos) = real::sin_cos(heading_rad);
        let (sin, cos) = (sin.abs(), cos.abs());
        0.5 * DVec3::new(cos * size_m.x + sin * size_m.y, sin * size_m.x + cos * size_m.y, size_m.z)
    }

    /// Whether a vehicle's size is one.
    pub(crate) fn is_drawable(&self) -> bool {
        match self {
            Self::Person { .. } => true,
            Self::Vehicle { size_m, .. } => {
                size_m.is_finite() && size_m.min_element() > 0.05 && size_m.max_element() <= LARGEST_M
            }
        }
    }
}
