//! CARLA 0.9.14+ semantic labels: id, name, colour.

use serde::{Deserialize, Serialize};

/// A semantic label; its number is CARLA's id (0.9.14 and later).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[repr(u8)]
#[expect(missing_docs, reason = "the names are CARLA's own and say what they are")]
pub enum SemanticLabel {
    Unlabeled = 0,
    Roads = 1,
    SideWalks = 2,
    Building = 3,
    Wall = 4,
    Fence = 5,
    Pole = 6,
    TrafficLight = 7,
    TrafficSign = 8,
    Vegetation = 9,
    Terrain = 10,
    Sky = 11,
    Pedestrian = 12,
    Rider = 13,
    Car = 14,
    Truck = 15,
    Bus = 16,
    Train = 17,
    Motorcycle = 18,
    Bicycle = 19,
    Static = 20,
    Dynamic = 21,
    Other = 22,
    Water = 23,
    RoadLine = 24,
    Ground = 25,
    Bridge = 26,
    RailTrack = 27,
    GuardRail = 28,
}

impl SemanticLabel {
    /// All labels, in the order of their ids.
    pub const ALL: [Self; 29] = [
        Self::Unlabeled,
        Self::Roads,
        Self::SideWalks,
        Self::Building,
        Self::Wall,
        Self::Fence,
        Self::Pole,
        Self::TrafficLight,
        Self::TrafficSign,
        Self::Vegetation,
        Self::Terrain,
        Self::Sky,
        Self::Pedestrian,
        Self::Rider,
        Self::Car,
        Self::Truck,
        Self::Bus,
        Self::Train,
        Self::Motorcycle,
        Self::Bicycle,
        Self::Static,
        Self::Dynamic,
        Self::Other,
        Self::Water,
        Self::RoadLine,
        Self::Ground,
        Self::Bridge,
        Self::RailTrack,
        Self::GuardRail,
    ];

    /// CARLA's id.
    pub const fn id(self) -> u8 {
        self as u8
    }

    /// The name in tables and legends.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unlabeled => "Unlabeled",
            Self::Roads => "Roads",
            Self::SideWalks => "SideWalks",
            Self::Building => "Building",
            Self::Wall => "Wall",
            Self::Fence => "Fence",
            Self::Pole => "Pole",
            Self::TrafficLight => "TrafficLight",
            Self::TrafficSign => "TrafficSign",
            Self::Vegetation => "Vegetation",
            Self::Terrain => "Terrain",
            Self::Sky => "Sky",
            Self::Pedestrian => "Pedestrian",
            Self::Rider => "Rider",
            Self::Car => "Car",
            Self::Truck => "Truck",
            Self::Bus => "Bus",
            Self::Train => "Train",
            Self::Motorcycle => "Motorcycle",
            Self::Bicycle => "Bicycle",
            Self::Static => "Static",
            Self::Dynamic => "Dynamic",
            Self::Other => "Other",
            Self::Water => "Water",
            Self::RoadLine => "RoadLine",
            Self::Ground => "Ground",
            Self::Bridge => "Bridge",
            Self::RailTrack => "RailTrack",
            Self::GuardRail => "GuardRail",
        }
    }

    /// CARLA's palette colour, sRGB.
    pub fn colour(self) -> [u8; 3] {
        match self {
            Self::Unlabeled => [0, 0, 0],
            Self::Roads => [128, 64, 128],
            Self::SideWalks => [244, 35, 232],
            Self::Building => [70, 70, 70],
            Self::Wall => [102, 102, 156],
            Self::Fence => [190, 153, 153],
            Self::Pole => [153, 153, 153],
            Self::TrafficLight => [250, 170, 30],
            Self::TrafficSign => [220, 220, 0],
            Self::Vegetation => [107, 142, 35],
            Self::Terrain => [152, 251, 152],
            Self::Sky => [70, 130, 180],
            Self::Pedestrian => [220, 20, 60],
            Self::Rider => [255, 0, 0],
            Self::Car => [0, 0, 142],
            Self::Truck => [0, 0, 70],
            Self::Bus => [0, 60, 100],
            Self::Train => [0, 80, 100],
            Self::Motorcycle => [0, 0, 230],
            Self::Bicycle => [119, 11, 32],
            Self::Static => [110, 190, 160],
            Self::Dynamic => [170, 120, 50],
            Self::Other => [55, 90, 80],
            Self::Water => [45, 60, 150],
            Self::RoadLine => [157, 234, 50],
            Self::Ground => [81, 0, 81],
            Self::Bridge => [150, 100, 100],
            Self::RailTrack => [230, 150, 140],
            Self::GuardRail => [180, 165, 180],
        }
    }
}
