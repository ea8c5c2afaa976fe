//! Ports that built-in stages share, declared once.

use crate::rejections::REJECTION;
use crate::world::TOWN_BLOB;
use cosfly_stage::{Fan, InputPort, PortSource, Takes};

/// Artifact of a town.
pub const TOWN: &str = "town/1";
/// Artifact of a pedestrian's walk.
pub const WALK: &str = "walk/1";
/// Artifact of the companions of a flight.
pub const COMPANIONS: &str = "companions/1";
/// Artifact of a planned or perturbed trajectory.
pub const TRAJECTORY: &str = "trajectory/3";
/// Artifact of the people who are near a flight.
pub const NEARBY: &str = "nearby/1";
/// Artifact of a rendered trajectory.
pub const FRAMES: &str = "frames/1";
/// Blob of a rendered trajectory: its packed pictures, which its log holds as well.
pub const PACK: &str = "pack";
/// Artifact of a trajectory's captions.
pub const CAPTIONS: &str = "captions/1";
/// Artifact of a trajectory's MCAP log.
pub const LOG: &str = "log/1";
/// Artifact of extras that a plugin made of a trajectory.
pub const EXTRAS: &str = "extras/1";
/// Artifact of the comparison of planners in a dataset's report.
pub const PLANNERS: &str = "planners/1";
/// Artifact of the verdict over all inspected flights.
pub const VERDICT: &str = "verdict/1";
/// Artifact of a whole dataset.
pub const DATASET: &str = "dataset/1";

/// Port of the town.
pub fn town() -> InputPort {
    InputPort {
        name: "town",
        artifact: TOWN,
        fan: Fan::Broadcast,
        takes: Takes::One,
        optional: false,
        source: PortSource::Recipe,
        blobs: None,
        doc: "The town that everything happens in.",
    }
}

/// A port that meets the stage item by item.
pub fn each(name: &'static str, artifact: &'static str, many: bool, doc: &'static str) -> InputPort {
    InputPort {
        name,
        artifact,
        fan: Fan::Each,
        takes: takes(many),
        optional: false,
        source: PortSource::Recipe,
        blobs: None,
        doc,
    }
}

/// A port that brings all items of an input at once.
pub fn gather(name: &'static str, artifact: &'static str, many: bool, doc: &'static str) -> InputPort {
    InputPort {
        name,
        artifact,
        fan: Fan::Gather,
        takes: takes(many),
        optional: false,
        source: PortSource::Recipe,
        blobs: None,
        doc,
    }
}

/// A port of rendered trajectories whose stage does not see the pictures.
pub fn without_pictures(port: InputPort) -> InputPort {
    InputPort { blobs: Some(&["index", REJECTION, TOWN_BLOB]), ..port }
}

/// One stage, or several with items named after them.
fn takes(many: bool) -> Takes {
    if many { Takes::Named } else { Takes::One }
}
