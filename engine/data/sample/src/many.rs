//! Many tiny flights for measurements: the sample's flights under new names, each walk at a place of its own.

use super::{SampleFlight, flights};
use cosfly_frames::DVec3;
use cosfly_schema::{EncodingConfig, RenderedTrajectory};

/// Distance of neighbouring walks, metres: none repeats another.
const APART_M: f64 = 24.0;
/// Walks side by side.
const COLUMNS: usize = 400;

/// Flights of a sample, made one at a time: an expert and a perturbed one for each walk.
pub struct ManyFlights {
    samples: Vec<SampleFlight>,
    packs: Vec<Vec<u8>>,
}

impl Default for ManyFlights {
    fn default() -> Self {
        let samples = flights();
        let packs = samples.iter().map(|flight| flight.pack(EncodingConfig::default())).collect();
        Self { samples, packs }
    }
}

impl ManyFlights {
    /// The record of a flight.
    pub fn record(&self, index: usize) -> RenderedTrajectory {
        let walk = index / 2;
        let mut record = self.samples[index % self.samples.len()].record.clone();
        let shift = DVec3::new(APART_M * (walk % COLUMNS) as f64, APART_M * (walk / COLUMNS) as f64, 0.0);
        record.trajectory_id = format!("{}-p{walk:06}", record.role.name());
        record.flight_id.clone_from(&record.trajectory_id);
        record.pedestrian_id = format!("p{walk:06}");
        if let Some(pair) = &mut record.pair {
            pair.expert_id = format!("expert-p{walk:06}");
        }
        if let Some(perturbation) = &mut record.trajectory.perturbation {
            perturbation.expert_item = format!("p{walk:06}");
        }
        record.trajectory.poses_in_world.iter_mut().for_each(|pose| pose.position_in_world += shift);
        record.trajectory.track.states.iter_mut().for_each(|state| state.feet_in_world += shift);
        record.sightings.iter_mut().for_each(|sighting| sighting.state.feet_in_world += shift);
        record
    }

    /// The packed pictures of a flight.
    pub fn pack(&self, index: usize) -> &[u8] {
        &self.packs[index % self.packs.len()]
    }
}
