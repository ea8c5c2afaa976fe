//! Classes of MOTChallenge, for its export and the scores of its trackers.

use cosfly_domain::{BodyKind, SemanticLabel};

/// Class of people on foot.
pub const PEDESTRIAN: u8 = 1;

/// Class of what is not counted, for or against a tracker.
pub const DISTRACTOR: u8 = 8;

/// Numbers and names of the classes that count.
pub const COUNTED: [(u8, &str); 4] = [(PEDESTRIAN, "pedestrian"), (3, "car"), (4, "bicycle"), (5, "motorcycle")];

/// The class of a kind of body.
pub fn mot_class(kind: &str) -> u8 {
    let known = BodyKind::ON_THE_GROUND.iter().find(|known| known.name() == kind);
    match known.map(|kind| kind.row().label) {
        Some(SemanticLabel::Pedestrian) => PEDESTRIAN,
        Some(SemanticLabel::Car | SemanticLabel::Truck | SemanticLabel::Bus) => 3,
        Some(SemanticLabel::Bicycle) => 4,
        Some(SemanticLabel::Motorcycle) => 5,
        _ => DISTRACTOR,
    }
}
