//! CARLA 0.9.14+ semantic labels: id, name, colour.

use serde::{Deserialize, Serialize};

/// One row per label: name, CARLA's id, CARLA's palette colour (sRGB).
macro_rules! labels {
    ($($name:ident = $id:literal, $colour:expr;)*) => {
        /// A semantic label; its number is CARLA's id (0.9.14 and later).
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
        #[repr(u8)]
        #[expect(missing_docs, reason = "the names are CARLA's own and say what they are")]
        pub enum SemanticLabel {
            $($name = $id,)*
        }

        impl SemanticLabel {
            /// All labels, in the order of their ids.
            pub const ALL: [Self; 29] = [$(Self::$name),*];

            /// The name in tables and legends.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$name => stringify!($name),)*
                }
            }

            /// CARLA's palette colour, sRGB.
            pub fn colour(self) -> [u8; 3] {
                match self {
                    $(Self::$name => $colour,)*
                }
            }
        }
    };
}

labels! {
    Unlabeled = 0, [0, 0, 0];
    Roads = 1, [128, 64, 128];
    SideWalks = 2, [244, 35, 232];
    Building = 3, [70, 70, 70];
    Wall = 4, [102, 102, 156];
    Fence = 5, [190, 153, 153];
    Pole = 6, [153, 153, 153];
    TrafficLight = 7, [250, 170, 30];
    TrafficSign = 8, [220, 220, 0];
    Vegetation = 9, [107, 142, 35];
    Terrain = 10, [152, 251, 152];
    Sky = 11, [70, 130, 180];
    Pedestrian = 12, [220, 20, 60];
    Rider = 13, [255, 0, 0];
    Car = 14, [0, 0, 142];
    Truck = 15, [0, 0, 70];
    Bus = 16, [0, 60, 100];
    Train = 17, [0, 80, 100];
    Motorcycle = 18, [0, 0, 230];
    Bicycle = 19, [119, 11, 32];
    Static = 20, [110, 190, 160];
    Dynamic = 21, [170, 120, 50];
    Other = 22, [55, 90, 80];
    Water = 23, [45, 60, 150];
    RoadLine = 24, [157, 234, 50];
    Ground = 25, [81, 0, 81];
    Bridge = 26, [150, 100, 100];
    RailTrack = 27, [230, 150, 140];
    GuardRail = 28, [180, 165, 180];
}

impl SemanticLabel {
    /// CARLA's id.
    pub const fn id(self) -> u8 {
        self as u8
    }
}
