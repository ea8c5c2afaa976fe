//! Objects of a generated town: a list of things in map coordinates, each with its footprint and height.

use crate::lot::Lot;
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
    /// A fence.
    Fence,
    /// A hedge.
    Hedge,
    /// A parked car.
    Car,
    /// A market stall.
    Stall,
    /// A swing, a slide or a climbing frame.
    PlayEquipment,
    /// A goal of a sports field.
    Goal,
    /// A container of freight, or several on top of each other.
    Container,
    /// A boat that lies at a pier.
    Boat,
    /// A marked place for a car, flat.
    Bay,
    /// A fountain or a well.
    Fountain,
    /// A piece of ground; its height is that of the ground, and nothing stands up.
    Ground,
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
            Self::Fence => ("barrier", "fence"),
            Self::Hedge => ("vegetation", "hedge"),
            Self::Car => ("car", "car"),
            Self::Stall => ("obstacle", "stall"),
            Self::PlayEquipment => ("obstacle", "playEquipment"),
            Self::Goal => ("obstacle", "goal"),
            Self::Container => ("obstacle", "container"),
            Self::Boat => ("obstacle", "boat"),
            Self::Bay => ("parkingSpace", "bay"),
            Self::Fountain => ("obstacle", "fountain"),
            Self::Ground => ("patch", "ground"),
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

/// One thing.
#[derive(Clone, Debug, PartialEq)]
pub struct GeneratedThing {
    /// Kind of the thing.
    pub kind: ThingKind,
    /// Place of the foot.
    pub footprint: Footprint,
    /// From the ground to its top, metres.
    pub height_m: f64,
    /// Our own additions to the format, as codes and values of `userData`.
    pub data: Vec<(&'static str, String)>,
}

impl GeneratedThing {
    /// Something upright on a rectangle.
    pub fn on_lot(kind: ThingKind, lot: Lot, height_m: f64) -> Self {
        Self::new(kind, Footprint::Rectangle(lot), height_m)
    }

    /// Something upright on any footprint.
    pub fn new(kind: ThingKind, footprint: Footprint, height_m: f64) -> Self {
        Self { kind, footprint, height_m, data: Vec::new() }
    }

    /// A tree, its trunk's radius and its crown: radius and height of its lower edge, metres.
    pub fn tree(center: DVec2, radius_m: f64, height_m: f64, crown_radius_m: f64, crown_base_m: f64) -> Self {
        let data = vec![("crown_radius", format!("{crown_radius_m:.2}")), ("crown_base", format!("{crown_base_m:.2}"))];
        Self { data, ..Self::new(ThingKind::Tree, Footprint::Disc { center, radius_m }, height_m) }
    }
}
