//! Options of a check: its parts and its manner.

use super::flight_list::FlightList;
use cosfly_diagnose::Stop;
use cosfly_metrics::scanned_mesh::ScannedMesh;
use std::path::PathBuf;
use std::sync::Arc;

/// Options of a check.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Number of threads; all cores without it.
    pub jobs: Option<usize>,
    /// Number of flights that are checked in full; all without it. The sample is drawn from the flights' names.
    pub sample: Option<usize>,
    /// File that notes the flights found sound, so that an interrupted check goes on where it ended.
    pub resume: Option<PathBuf>,
    /// Scan that the flights keep their clearance from.
    pub mesh: Option<Arc<ScannedMesh>>,
    /// Ends the check, within a second.
    pub stop: Stop,
}

/// The flights that are checked in full.
pub struct Wanted(Option<Vec<bool>>);

impl Wanted {
    /// All flights, or a sample: those with the smallest hashes of their names.
    pub fn of(flights: &FlightList, sample: Option<usize>) -> Self {
        let Some(count) = sample.filter(|count| *count < flights.len()) else { return Self(None) };
        let hash = |id: &str| *blake3::hash(id.as_bytes()).as_bytes();
        let mut order: Vec<([u8; 32], usize)> =
            flights.iter().enumerate().map(|(number, flight)| (hash(&flight.trajectory_id), number)).collect();
        order.sort_unstable();
        let mut wanted = vec![false; flights.len()];
        order.into_iter().take(count).for_each(|(_, number)| wanted[number] = true);
        Self(Some(wanted))
    }

    /// Whether a flight is checked in full.
    pub fn has(&self, number: usize) -> bool {
        self.0.as_ref().is_none_or(|wanted| wanted[number])
    }

    /// Number of flights that are checked in full, where not all are.
    pub fn sample(&self) -> Option<u64> {
        self.0.as_ref().map(|wanted| wanted.iter().filter(|it| **it).count() as u64)
    }
}
