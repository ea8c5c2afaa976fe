//! `point-mass`: a point that follows velocities.

use super::model::DroneModel;

pub(super) const MODEL: DroneModel = DroneModel {
    name: "point-mass",
    doc: "a point mass that follows velocities within the planner's limits",
    parameters: None,
};
