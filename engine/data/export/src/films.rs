//! The films of a flight: what several cameras of a rig took of it.

use crate::source::Source;
use cosfly_read::PublishedFlight;
use std::collections::BTreeMap;

/// Flight, weather and split, which the films of one flight share.
type Key<'a> = (&'a str, &'a str, &'a str);

fn key(flight: &PublishedFlight) -> Key<'_> {
    (&flight.flight_id, &flight.weather, &flight.split)
}

/// The chosen films, by flight.
pub struct Films<'a> {
    by_key: BTreeMap<Key<'a>, Vec<&'a PublishedFlight>>,
}

impl<'a> Films<'a> {
    /// The films of the chosen flights. The first of a flight is that with the shortest time between frames, then the earliest, then the
    /// first of the dataset; others are in the dataset's order.
    pub fn of(source: &Source<'a>) -> Self {
        let mut by_key: BTreeMap<Key<'_>, Vec<&PublishedFlight>> = BTreeMap::new();
        source.flights().for_each(|flight| by_key.entry(key(flight)).or_default().push(flight));
        for films in by_key.values_mut() {
            let order = |(_, film): &(usize, &&PublishedFlight)| ((film.dt_s * 1e9).round() as u64, film.begins_ns);
            if let Some((lead, _)) = films.iter().enumerate().min_by_key(order) {
                films[..=lead].rotate_right(1);
            }
        }
        Self { by_key }
    }

    /// All films of the flight of one of them.
    pub fn of_flight<'b>(&'b self, film: &'b PublishedFlight) -> &'b [&'a PublishedFlight] {
        self.by_key.get(&key(film)).map_or(&[], Vec::as_slice)
    }

    /// Whether a film is the first of its flight.
    pub fn is_first(&self, film: &PublishedFlight) -> bool {
        self.of_flight(film).first().is_some_and(|first| first.trajectory_id == film.trajectory_id)
    }

    /// The films of each flight.
    pub fn each(&self) -> impl Iterator<Item = &[&'a PublishedFlight]> {
        self.by_key.values().map(Vec::as_slice)
    }
}
