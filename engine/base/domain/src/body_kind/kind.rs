//! [`BodyKind`]: the kinds of bodies.

use super::row::BodyKindRow;
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
    /// A person who runs.
    Runner,
    /// An electric scooter with a board, and its rider who stands.
    EScooter,
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
        Self::Runner,
        Self::EScooter,
    ];

    /// Row of the kind.
    pub const fn row(self) -> &'static BodyKindRow {
        match self {
            Self::Pedestrian => &super::pedestrian::ROW,
            Self::Bicycle => &super::bicycle::ROW,
            Self::Motorcycle => &super::motorcycle::ROW,
            Self::Car => &super::car::ROW,
            Self::Van => &super::van::ROW,
            Self::Truck => &super::truck::ROW,
            Self::Bus => &super::bus::ROW,
            Self::Drone => &super::drone::ROW,
            Self::Child => &super::child::ROW,
            Self::Elder => &super::elder::ROW,
            Self::Wheelchair => &super::wheelchair::ROW,
            Self::PushChair => &super::push_chair::ROW,
            Self::DogWalker => &super::dog_walker::ROW,
            Self::Sitter => &super::sitter::ROW,
            Self::Runner => &super::runner::ROW,
            Self::EScooter => &super::e_scooter::ROW,
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
