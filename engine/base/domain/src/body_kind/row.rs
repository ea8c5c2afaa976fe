//! [`BodyKindRow`]: what is the same of all bodies of a kind.

use crate::SemanticLabel;

/// Properties that all bodies of a kind have in common.
#[derive(Debug)]
pub struct BodyKindRow {
    /// Name in recipes and tables.
    pub name: &'static str,
    /// Noun in logs.
    pub noun: &'static str,
    /// CARLA's label of all but a rider; of those who walk, that of the person: what they take along is `Dynamic`.
    pub label: SemanticLabel,
    /// Whether a person is seen, whose clothes tell the body from others.
    pub is_dressed: bool,
    /// Length, width and height where a source states a class alone, metres: SUMO's. People are cylinders as wide as their shoulders.
    pub class_size_m: [f64; 3],
    /// Driving in traffic; none of what does not drive.
    pub driving: Option<Driving>,
    /// Walking in a crowd; none of what does not walk.
    pub walking: Option<Walking>,
    /// Strength of the lamps at night, and their reach as a share of that of a car; none without lamps.
    pub lamps: Option<[f32; 2]>,
}

/// A grown person on foot: what other kinds of people have, too, stands here alone.
pub(super) const PERSON: BodyKindRow = BodyKindRow {
    name: "pedestrian",
    noun: "person",
    label: SemanticLabel::Pedestrian,
    is_dressed: true,
    class_size_m: [0.478, 0.478, 1.719],
    driving: None,
    walking: Some(Walking { heights_m: None, pace: [1.0, 1.0], outline_m: None }),
    lamps: None,
};

/// People of another kind: name and noun, length, width and height, size and pace in a crowd.
pub(super) const fn people([name, noun]: [&'static str; 2], class_size_m: [f64; 3], walking: Walking) -> BodyKindRow {
    BodyKindRow { name, noun, class_size_m, walking: Some(walking), ..PERSON }
}

/// A vehicle of a name with lamps, without a person whose clothes are seen.
pub(super) const fn vehicle(
    name: &'static str,
    label: SemanticLabel,
    class_size_m: [f64; 3],
    driving: Driving,
) -> BodyKindRow {
    let (driving, lamps) = (Some(driving), Some([1.0, 1.0]));
    BodyKindRow { name, noun: name, label, is_dressed: false, class_size_m, driving, walking: None, lamps }
}

/// Size and pace of a kind of people in a crowd.
#[derive(Clone, Copy, Debug)]
pub struct Walking {
    /// Range of heights, metres; none: that of the crowd.
    pub heights_m: Option<[f64; 2]>,
    /// Range of the free speed, as a share of that of the crowd.
    pub pace: [f64; 2],
    /// Length and width with what they take along, metres; none: people are cylinders.
    pub outline_m: Option<[f64; 2]>,
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
