//! The cameras of an episode: films of one flight that have the same moments are one episode, with a feature for each camera.

use crate::films::Films;
use crate::source::Source;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_read::PublishedFlight;

/// Name of the pictures' feature.
const PICTURE: &str = "observation.images.rgb";
/// Name of the feature of depth.
const DEPTH: &str = "observation.images.depth";

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

impl Eye {
    /// The cameras of all episodes, in the order of their films, and the time between frames, seconds.
    ///
    /// # Errors
    /// `export-lerobot`: episodes that differ in their cameras, picture sizes, times or lengths; two features of one name.
    pub fn of_all(source: &Source<'_>, films: &Films<'_>, has_depth: bool) -> Result<(Vec<Self>, f64)> {
        let Some(first) = source.flights().next() else { return Ok((vec![], 0.0)) };
        let all = cameras(films.of_flight(first));
        for films in films.each() {
            let lead = films[0];
            let moments = |film: &PublishedFlight| (film.dt_s, film.begins_ns, film.frames);
            let other = films.iter().find(|film| film.dt_s != first.dt_s || moments(film) != moments(lead));
            if let Some(other) = other.or_else(|| films.iter().find(|_| cameras(films) != all)) {
                let message = format!(
                    "`{}` differs from the first flight in its cameras, its picture size or the times of its frames",
                    other.trajectory_id
                );
                let hint = "LeRobot has one of each; choose flights with `--trajectory`, such as `--trajectory '*-front'` for the \
                            films of a camera, or with `--split`";
                return Err(Diagnostic::new("export-lerobot", Fault::Recipe, message).hint(hint));
            }
        }
        let eye = |(name, size_px): &(Option<&str>, [u32; 2])| match name {
            Some(name) if all.len() > 1 => {
                Self { colours: feature(name), depths: feature(&format!("{name}_depth")), size_px: *size_px }
            }
            _ => Self { colours: PICTURE, depths: DEPTH, size_px: *size_px },
        };
        let eyes: Vec<Self> = all.iter().map(eye).collect();
        let is_twice = |one: &&Self| has_depth && eyes.iter().any(|other| other.depths == one.colours);
        if let Some(twice) = eyes.iter().find(is_twice) {
            let message = format!("`{}` is the colours of one camera and the depth of another", twice.colours);
            let hint = "LeRobot has one feature of a name: choose one of the two cameras with `--trajectory`";
            return Err(Diagnostic::new("export-lerobot", Fault::Recipe, message).hint(hint));
        }
        Ok((eyes, first.dt_s))
    }
}

/// Name and picture size of each camera.
fn cameras<'a>(films: &[&'a PublishedFlight]) -> Vec<(Option<&'a str>, [u32; 2])> {
    films.iter().map(|it| (it.camera_name.as_deref(), [it.camera.width, it.camera.height])).collect()
}

/// Name of a feature. Names of columns live as long as the program; cameras are few.
fn feature(name: &str) -> &'static str {
    Box::leak(format!("observation.images.{name}").into_boxed_str())
}
