//! Ports that built-in stages share, declared once.

use cosfly_experts::artifacts::{self, REJECTION};
use cosfly_stage::{Fan, InputPort, PortSource, Sees, Takes};

/// Artifact of a town.
pub const TOWN: &str = artifacts::TOWN.artifact;
/// Artifact of a pedestrian's walk.
pub const WALK: &str = artifacts::WALK.artifact;
/// Artifact of the companions of a flight.
pub const COMPANIONS: &str = artifacts::COMPANIONS.artifact;
/// Artifact of all people and vehicles that move through a town.
pub const TRAFFIC: &str = artifacts::TRAFFIC.artifact;
/// Artifact of what came of ordering a loss of the target.
pub const LOSSES: &str = artifacts::LOSSES.artifact;
/// Artifact of the orders to lose the target, by item.
pub const ORDERS: &str = "orders/1";
/// Artifact of the flights of all drones behind a walk.
pub const FORMATION: &str = artifacts::FORMATION.artifact;
/// Artifact of a planned or perturbed trajectory.
pub const TRAJECTORY: &str = artifacts::FLIGHT.artifact;
/// Artifact of the people who are near a flight.
pub const NEARBY: &str = artifacts::NEARBY.artifact;
/// Artifact of a rendered trajectory.
pub const FRAMES: &str = artifacts::FRAMES;
/// Blob of a rendered trajectory: its packed pictures, which its log holds as well.
pub const PACK: &str = artifacts::FILM;
/// Artifact of a trajectory's captions.
pub const CAPTIONS: &str = "captions/3";
/// Artifact of a trajectory's MCAP log.
pub const LOG: &str = "log/1";
/// Artifact of extras that a plugin made of a trajectory.
pub const EXTRAS: &str = "extras/1";
/// Artifact of the comparison of planners in a dataset's report.
pub const PLANNERS: &str = "planners/1";
/// Artifact of the notes about the flights of a group of walks.
pub const NOTES: &str = "notes/1";
/// Artifact of the splits of all flights, by group.
pub const SPLITS: &str = "splits/1";
/// Artifact of the tables and logs of a group of walks.
pub const SHARD: &str = "shard/2";
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
        sees: Sees::All,
        doc: "The town that everything happens in.",
    }
}

/// A port that meets the stage item by item.
pub fn each(name: &'static str, artifact: &'static str, many: bool, doc: &'static str) -> InputPort {
    InputPort { name, artifact, fan: Fan::Each, takes: takes(many), doc, ..town() }
}

/// A port that brings all items of an input at once.
pub fn gather(name: &'static str, artifact: &'static str, many: bool, doc: &'static str) -> InputPort {
    InputPort { fan: Fan::Gather, ..each(name, artifact, many, doc) }
}

/// A port of rendered trajectories whose stage does not see the pictures.
pub fn without_pictures(port: InputPort) -> InputPort {
    InputPort { sees: Sees::Only(&["index", REJECTION.blob, artifacts::TOWN.blob]), ..port }
}

/// A port that brings the items of a group at once.
pub fn group(port: InputPort) -> InputPort {
    InputPort { fan: Fan::Group, ..port }
}

/// The port through which a stage reads one of its own parts.
pub fn sibling(part: &'static str, artifact: &'static str, fan: Fan, doc: &'static str) -> InputPort {
    InputPort { fan, source: PortSource::Sibling(part), ..each(part, artifact, false, doc) }
}

/// One stage, or several with items named after them.
fn takes(many: bool) -> Takes {
    if many { Takes::Named } else { Takes::One }
}
