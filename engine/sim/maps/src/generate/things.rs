//! Objects of a generated town: a list of things in map coordinates, each with its footprint and height.

use super::street_space::Lot;
use cosfly_frames::DVec2;

/// Kinds of things, by their OpenDRIVE type and name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThingKind {
    /// A building.
    Building,
    /// A tree.
    Tree,
    /// A street lamp.
    Lamp,
    /// A bench.
    Bench,
    /// A bus shelter.
    BusStop,
    /// A free-standing wall.
    Wall,
}

impl ThingKind {
    /// OpenDRIVE `type` and `name`.
    pub fn type_and_name(self) -> (&'static str, &'static str) {
        match self {
            Self::Building => ("building", "building"),
            Self::Tree => ("tree", "tree"),
            Self::Lamp => ("pole", "streetLamp"),
            Self::Bench => ("obstacle", "bench"),
            Self::BusStop => ("obstacle", "busStop"),
            Self::Wall => ("barrier", "wall"),
        }
    }
}

/// Shape on the ground.
#[derive(Clone, Debug, PartialEq)]
pub enum Footprint {
    /// A rectangle.
    Rectangle(Lot),
    /// A polygon, counter-clockwise.
    Polygon(Vec<DVec2>),
    /// A disc.
    Disc {
        /// Middle, metres.
        center: DVec2,
        /// Radius, metres.
        radius_m: f64,
    },
}

impl Footprint {
    /// A point to attach it by.
    pub fn center(&self) -> DVec2 {
        match self {
            Self::Rectangle(lot) => lot.center,
            Self::Polygon(corners) => corners.iter().sum::<DVec2>() / corners.len().max(1) as f64,
            Self::Disc { center, .. } => *center,
        }
    }
}

/// A tree's crown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crown {
    /// Radius, metres.
    pub radius_m: f64,
    /// Height of the lower edge above the ground, metres.
    pub base_m: f64,
}

/// One thing.
#[derive(Clone, Debug, PartialEq)]
pub struct GeneratedThing {
    /// Kind of the thing.
    pub kind: ThingKind,
    /// Place of the foot.
    pub footprint: Footprint,
    /// From the ground to its top, metres.
    pub height_m: f64,
    /// Crown of a tree; none for other things.
    pub crown: Option<Crown>,
}

impl GeneratedThing {
    /// Something upright on a rectangle.
    pub fn on_lot(kind: ThingKind, lot: Lot, height_m: f64) -> Self {
        Self { kind, footprint: Footprint::Rectangle(lot), height_m, crown: None }
    }
}
