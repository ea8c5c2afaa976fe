//! [`BodyKind`]: the kinds of bodies.

use super::row::BodyKindRow;
use super::{bicycle, bus, car, drone, motorcycle, pedestrian, truck, van};
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
    #[rustfmt::skip] // an entry per line
    pub const ON_THE_GROUND: &[Self] = &[
        Self::Pedestrian,
        Self::Bicycle,
        Self::Motorcycle,
        Self::Car,
        Self::Van,
        Self::Truck,
        Self::Bus,
    ];

    /// Row of the kind.
    pub const fn row(self) -> &'static BodyKindRow {
        match self {
            Self::Pedestrian => &pedestrian::ROW,
            Self::Bicycle => &bicycle::ROW,
            Self::Motorcycle => &motorcycle::ROW,
            Self::Car => &car::ROW,
            Self::Van => &van::ROW,
            Self::Truck => &truck::ROW,
            Self::Bus => &bus::ROW,
            Self::Drone => &drone::ROW,
        }
    }

    /// Name in recipes and tables.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// Whether the body is a person on foot.
    pub fn is_person(self) -> bool {
        self == Self::Pedestrian
    }
}
