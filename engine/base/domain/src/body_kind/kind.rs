//! [`BodyKind`]: the kinds of bodies.

use super::row::BodyKindRow;
use super::{
    bicycle, bus, car, child, dog_walker, drone, elder, motorcycle, pedestrian, push_chair, sitter, truck, van,
    wheelchair,
};
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
    /// A child on foot.
    Child,
    /// An old person on foot, stooped, with a stick.
    Elder,
    /// A wheelchair with its user.
    Wheelchair,
    /// A person with a push-chair.
    PushChair,
    /// A person with a dog on a leash.
    DogWalker,
    /// A person who sits on a chair and stays there.
    Sitter,
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
        Self::Child,
        Self::Elder,
        Self::Wheelchair,
        Self::PushChair,
        Self::DogWalker,
        Self::Sitter,
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
            Self::Child => &child::ROW,
            Self::Elder => &elder::ROW,
            Self::Wheelchair => &wheelchair::ROW,
            Self::PushChair => &push_chair::ROW,
            Self::DogWalker => &dog_walker::ROW,
            Self::Sitter => &sitter::ROW,
        }
    }

    /// Name in recipes and tables.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// Whether the body is a person who keeps to the pavements, on foot or seated: seen from above, a circle.
    pub fn is_person(self) -> bool {
        self.row().walking.is_some()
    }

    /// Whether the body is a person on foot, whatever the person takes along.
    pub fn is_on_foot(self) -> bool {
        self.is_person() && !matches!(self, Self::Wheelchair | Self::Sitter)
    }
}
