//! The rows of table `trajectories`, by name and by number.

use super::report::VerifyReport;
use super::rows::PlacedFlight;

/// Flights in the order of their names; a flight's number is its place in the list.
#[derive(Default)]
pub struct FlightList(Vec<PlacedFlight>);

impl FlightList {
    /// The flights by name; of several with one name the first stays.
    pub fn of(mut flights: Vec<PlacedFlight>, report: &mut VerifyReport) -> Self {
        flights.sort_by(|a, b| a.trajectory_id.cmp(&b.trajectory_id));
        flights.dedup_by(|second, first| {
            let is_second = first.trajectory_id == second.trajectory_id;
            if is_second {
                let (file, row) = &second.place;
                let message = format!("a second flight `{}`", second.trajectory_id);
                report.find(file, format!("row {row}"), "verify-duplicate", message);
            }
            is_second
        });
        flights.shrink_to_fit();
        Self(flights)
    }

    /// Number of flights.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Number of a flight.
    pub fn number(&self, id: &str) -> Option<usize> {
        self.0.binary_search_by(|flight| flight.trajectory_id.as_str().cmp(id)).ok()
    }

    /// Flight called `id`.
    pub fn get(&self, id: &str) -> Option<&PlacedFlight> {
        self.number(id).map(|number| &self.0[number])
    }

    /// Flight with this number.
    pub fn at(&self, number: usize) -> &PlacedFlight {
        &self.0[number]
    }

    /// All flights.
    pub fn iter(&self) -> std::slice::Iter<'_, PlacedFlight> {
        self.0.iter()
    }
}
