//! [`BodyKind`]: the kinds of bodies, a row each.
//!
//! A new kind is a variant, a row and its line in [`BodyKind::row`] here; its shape in pictures is a file of `sim/figures`.

use crate::SemanticLabel;
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

/// What is the same of all bodies of a kind.
#[derive(Debug)]
pub struct BodyKindRow {
    /// Name in recipes and tables.
    pub name: &'static str,
    /// Noun in logs.
    pub noun: &'static str,
    /// CARLA's label of all but a rider.
    pub label: SemanticLabel,
    /// Whether a person is seen, whose clothes tell the body from others.
    pub is_dressed: bool,
    /// Length, width and height where a source states a class alone, metres: SUMO's. People are cylinders as wide as their shoulders.
    pub class_size_m: [f64; 3],
    /// Driving in traffic; none of what does not drive.
    pub driving: Option<Driving>,
    /// Strength of the lamps at night, and their reach as a share of that of a car; none without lamps.
    pub lamps: Option<[f32; 2]>,
    /// Words in texts.
    pub words: BodyWords,
}

/// Sizes and limits of a kind of vehicle in traffic: passenger cars after Treiber's parameters for towns, the others slower in the order of
/// their mass.
#[derive(Debug)]
pub struct Driving {
    /// Ranges of length, width and height, metres.
    pub sizes_m: [[f64; 2]; 3],
    /// Largest speed, m/s.
    pub top_mps: f64,
    /// Largest acceleration of a calm driver, m/s^2.
    pub accelerate_mps2: f64,
    /// Comfortable braking, m/s^2.
    pub brake_mps2: f64,
    /// Sideways acceleration in bends, m/s^2.
    pub sideways_mps2: f64,
}

/// Words for a kind of body.
#[derive(Debug)]
pub struct BodyWords {
    /// Noun in English.
    pub english: &'static str,
    /// Some body of the kind that is not the target, in English.
    pub one_in_english: &'static str,
    /// Noun in Chinese.
    pub chinese: &'static str,
    /// Some body of the kind that is not the target, in Chinese.
    pub one_in_chinese: &'static str,
}

impl BodyKind {
    /// Kinds that walk and drive, in the order of their declaration: those of traffic.
    pub const ON_THE_GROUND: [Self; 7] =
        [Self::Pedestrian, Self::Bicycle, Self::Motorcycle, Self::Car, Self::Van, Self::Truck, Self::Bus];

    /// Row of the kind.
    pub const fn row(self) -> &'static BodyKindRow {
        match self {
            Self::Pedestrian => &PEDESTRIAN,
            Self::Bicycle => &BICYCLE,
            Self::Motorcycle => &MOTORCYCLE,
            Self::Car => &CAR,
            Self::Van => &VAN,
            Self::Truck => &TRUCK,
            Self::Bus => &BUS,
            Self::Drone => &DRONE,
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

static PEDESTRIAN: BodyKindRow = BodyKindRow {
    name: "pedestrian",
    noun: "person",
    label: SemanticLabel::Pedestrian,
    is_dressed: true,
    class_size_m: [0.478, 0.478, 1.719],
    driving: None,
    lamps: None,
    words: BodyWords {
        english: "person", one_in_english: "another person", chinese: "人", one_in_chinese: "另一个人"
    },
};

static BICYCLE: BodyKindRow = BodyKindRow {
    name: "bicycle",
    noun: "bicycle",
    label: SemanticLabel::Bicycle,
    is_dressed: true,
    class_size_m: [1.6, 0.65, 1.7],
    driving: Some(Driving {
        sizes_m: [[1.7, 1.85], [0.58, 0.68], [1.65, 1.85]],
        top_mps: 5.5,
        accelerate_mps2: 0.9,
        brake_mps2: 1.8,
        sideways_mps2: 1.6,
    }),
    lamps: Some([0.35, 0.4]),
    words: BodyWords {
        english: "cyclist",
        one_in_english: "a cyclist",
        chinese: "骑自行车的人",
        one_in_chinese: "一个骑自行车的人",
    },
};

static MOTORCYCLE: BodyKindRow = BodyKindRow {
    name: "motorcycle",
    noun: "motorcycle",
    label: SemanticLabel::Motorcycle,
    is_dressed: true,
    class_size_m: [2.2, 0.9, 1.5],
    driving: Some(Driving {
        sizes_m: [[2.0, 2.25], [0.75, 0.9], [1.55, 1.7]],
        top_mps: 40.0,
        accelerate_mps2: 2.2,
        brake_mps2: 2.5,
        sideways_mps2: 2.5,
    }),
    lamps: Some([1.0, 1.0]),
    words: BodyWords {
        english: "motorcyclist",
        one_in_english: "a motorcyclist",
        chinese: "骑摩托车的人",
        one_in_chinese: "一个骑摩托车的人",
    },
};

static CAR: BodyKindRow = BodyKindRow {
    name: "car",
    noun: "car",
    label: SemanticLabel::Car,
    is_dressed: false,
    class_size_m: [5.0, 1.8, 1.5],
    driving: Some(Driving {
        sizes_m: [[3.6, 4.85], [1.66, 1.9], [1.42, 1.68]],
        top_mps: 45.0,
        accelerate_mps2: 1.5,
        brake_mps2: 2.0,
        sideways_mps2: 2.2,
    }),
    lamps: Some([1.0, 1.0]),
    words: BodyWords { english: "car", one_in_english: "a car", chinese: "汽车", one_in_chinese: "一辆汽车" },
};

static VAN: BodyKindRow = BodyKindRow {
    name: "van",
    noun: "van",
    label: SemanticLabel::Car,
    is_dressed: false,
    class_size_m: [6.5, 2.16, 2.86],
    driving: Some(Driving {
        sizes_m: [[4.8, 5.9], [1.9, 2.05], [1.95, 2.55]],
        top_mps: 36.0,
        accelerate_mps2: 1.3,
        brake_mps2: 2.0,
        sideways_mps2: 2.0,
    }),
    lamps: Some([1.0, 1.0]),
    words: BodyWords {
        english: "van", one_in_english: "a van", chinese: "面包车", one_in_chinese: "一辆面包车"
    },
};

static TRUCK: BodyKindRow = BodyKindRow {
    name: "truck",
    noun: "truck",
    label: SemanticLabel::Truck,
    is_dressed: false,
    class_size_m: [7.1, 2.4, 2.4],
    driving: Some(Driving {
        sizes_m: [[6.5, 8.5], [2.3, 2.5], [2.9, 3.5]],
        top_mps: 25.0,
        accelerate_mps2: 0.9,
        brake_mps2: 1.8,
        sideways_mps2: 1.5,
    }),
    lamps: Some([1.0, 1.0]),
    words: BodyWords { english: "lorry", one_in_english: "a lorry", chinese: "卡车", one_in_chinese: "一辆卡车" },
};

static BUS: BodyKindRow = BodyKindRow {
    name: "bus",
    noun: "bus",
    label: SemanticLabel::Bus,
    is_dressed: false,
    class_size_m: [12.0, 2.5, 3.4],
    driving: Some(Driving {
        sizes_m: [[10.5, 12.0], [2.5, 2.55], [3.0, 3.2]],
        top_mps: 24.0,
        accelerate_mps2: 1.0,
        brake_mps2: 1.6,
        sideways_mps2: 1.2,
    }),
    lamps: Some([1.0, 1.0]),
    words: BodyWords {
        english: "bus", one_in_english: "a bus", chinese: "公交车", one_in_chinese: "一辆公交车"
    },
};

static DRONE: BodyKindRow = BodyKindRow {
    name: "drone",
    noun: "drone",
    label: SemanticLabel::Dynamic,
    is_dressed: false,
    class_size_m: [0.6, 0.6, 0.2],
    driving: None,
    lamps: None,
    words: BodyWords {
        english: "drone",
        one_in_english: "another drone",
        chinese: "无人机",
        one_in_chinese: "另一架无人机",
    },
};
