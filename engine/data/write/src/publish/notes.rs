//! Notes about flights, from which splits are drawn: a few hundred bytes per flight, made once.

use cosfly_schema::{RenderedTrajectory, TownLayout};
use cosfly_splits::FlightFacts;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Note about one flight of a group.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FlightNote {
    /// Trajectory id.
    pub trajectory_id: String,
    /// Expert of a perturbed flight.
    pub expert_id: Option<String>,
    /// Pedestrian who is followed.
    pub pedestrian_id: String,
    /// Name of the town.
    pub town: String,
    /// Digest of the artifact of the town, hex digits.
    pub town_digest: String,
    /// Time between frames, seconds.
    pub dt_s: f64,
    /// Name of the camera, where several film each flight.
    pub camera_name: Option<String>,
    /// Route of the target.
    pub route: cosfly_splits::route::Route,
    /// Hash of the training window that starts at each frame.
    pub windows: Vec<u64>,
}

impl FlightNote {
    /// Note about a flight; `window` is the size of training windows, frames.
    pub fn of(record: &RenderedTrajectory, window: usize, town_digest: String) -> Self {
        let layout = Arc::new(TownLayout { digest: String::new(), sketch: vec![] });
        let facts = FlightFacts::of_record(record, &layout, window);
        Self {
            trajectory_id: facts.trajectory_id,
            expert_id: facts.expert_id,
            pedestrian_id: facts.pedestrian_id,
            town: facts.town,
            town_digest,
            dt_s: record.dt_s(),
            camera_name: record.camera_name.clone(),
            route: facts.route,
            windows: facts.windows,
        }
    }

    /// Facts of the flight in a town with the ground plan `layout`.
    pub(crate) fn into_facts(self, layout: Arc<TownLayout>) -> FlightFacts {
        FlightFacts {
            dataset: 0,
            trajectory_id: self.trajectory_id,
            expert_id: self.expert_id,
            pedestrian_id: self.pedestrian_id,
            group: String::new(),
            split: String::new(),
            town: self.town,
            layout,
            route: self.route,
            windows: self.windows,
        }
    }
}
