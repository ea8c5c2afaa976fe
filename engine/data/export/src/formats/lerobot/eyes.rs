//! The cameras of an episode: films of one flight that have the same moments are one episode, with a feature for each camera.

use super::tables::{DEPTH, PICTURE};
use crate::source::Source;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_read::PublishedFlight;
use std::collections::BTreeMap;

/// A camera of all episodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Eye {
    /// Name of the feature of colours.
    pub colours: &'static str,
    /// Name of the feature of depth.
    pub depths: &'static str,
    /// Width and height of its pictures.
    pub size_px: [u32; 2],
}

/// Flight, weather and split: what films of one episode share.
type Key<'a> = (&'a str, &'a str, &'a str);

fn key(flight: &PublishedFlight) -> Key<'_> {
    (&flight.flight_id, &flight.weather, &flight.split)
}

/// The films of every episode.
pub struct Films<'a> {
    /// The cameras, in the order of the films of an episode.
    pub eyes: Vec<Eye>,
    /// Time between frames, the same of all, seconds.
    pub dt_s: f64,
    by_key: BTreeMap<Key<'a>, Vec<&'a PublishedFlight>>,
}

impl<'a> Films<'a> {
    /// The films of the chosen flights.
    ///
    /// # Errors
    /// `export-lerobot`: episodes that differ in their cameras, picture sizes, times or lengths.
    pub fn of(source: &Source<'a>) -> Result<Self> {
        let mut by_key: BTreeMap<Key<'_>, Vec<&PublishedFlight>> = BTreeMap::new();
        source.flights().for_each(|flight| by_key.entry(key(flight)).or_default().push(flight));
        let cameras = |films: &[&'a PublishedFlight]| -> Vec<(Option<&'a str>, [u32; 2])> {
            films.iter().map(|it| (it.camera_name.as_deref(), [it.camera.width, it.camera.height])).collect()
        };
        let Some(first) = source.flights().next() else { return Ok(Self { eyes: vec![], dt_s: 0.0, by_key }) };
        let all = cameras(&by_key[&key(first)]);
        for films in by_key.values() {
            let lead = films[0];
            let moments = |film: &&&PublishedFlight| {
                (film.dt_s, film.begins_ns, film.frames) == (lead.dt_s, lead.begins_ns, lead.frames)
            };
            let other = films.iter().find(|film| film.dt_s != first.dt_s || !moments(film));
            let other = other.or_else(|| films.iter().find(|_| cameras(films) != all));
            if let Some(other) = other {
                let message = format!(
                    "`{}` differs from the first flight in its cameras, its picture size or the times of its frames",
                    other.trajectory_id
                );
                let hint = "LeRobot has one of each; choose flights with `--trajectory`, such as `--trajectory '*-front'` for the \
                            films of a camera, or with `--split`";
                return Err(Diagnostic::new("export-lerobot", Fault::Recipe, message).hint(hint));
            }
        }
        let is_one = all.len() == 1;
        let eye = |(name, size_px): &(Option<&str>, [u32; 2])| match name {
            Some(name) if !is_one => {
                Eye { colours: feature(name), depths: feature(&format!("{name}_depth")), size_px: *size_px }
            }
            _ => Eye { colours: PICTURE, depths: DEPTH, size_px: *size_px },
        };
        Ok(Self { eyes: all.iter().map(eye).collect(), dt_s: first.dt_s, by_key })
    }

    /// Whether the episode is named after this film, whose rows it has.
    pub fn is_lead(&self, flight: &PublishedFlight) -> bool {
        self.of_episode(flight).first().is_some_and(|lead| lead.trajectory_id == flight.trajectory_id)
    }

    /// All films of the episode of one of them.
    pub fn of_episode<'b>(&'b self, flight: &'b PublishedFlight) -> &'b [&'a PublishedFlight] {
        self.by_key.get(&key(flight)).map_or(&[], Vec::as_slice)
    }
}

/// Name of a feature. Names of columns live as long as the program; cameras are few.
fn feature(name: &str) -> &'static str {
    Box::leak(format!("observation.images.{name}").into_boxed_str())
}
