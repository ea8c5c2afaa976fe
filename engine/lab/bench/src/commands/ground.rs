//! Ground and weathers of measurements of pictures, by their arguments.

use super::outcome::Refusals;
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_domain::{Camera, Season, Weather};
use cosfly_lab::render::views::Ground;
use std::path::Path;

/// A map file with viewpoints, or the town printed by `cosfly town`.
pub fn of_town(town: Option<&Path>, camera: Camera, views: usize) -> Result<Ground, Refusals> {
    let read = match town {
        None => Ground::downtown(camera, views),
        Some(path) => {
            let map = std::fs::read(path)
                .map_err(|error| vec![Diagnostic::io(format!("read `{}`", path.display()), &error)])?;
            let name = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or("town");
            Ground::of_map(name, &map, camera, views)
        }
    };
    read.map_err(|error| vec![Diagnostic::new("bench-town", Fault::Input, format!("the town cannot be read: {error}"))])
}

/// The weather of a preset.
pub fn weather(name: &str) -> Result<Weather, Refusals> {
    cosfly_materials::presets::preset(name).ok_or_else(|| {
        let message = format!("there is no weather `{name}`");
        let hint = format!("the presets are {}", cosfly_materials::presets::PRESETS.join(", "));
        vec![Diagnostic::new("bench-weather", Fault::Recipe, message).hint(hint)]
    })
}

/// Weathers of the presets that were asked for, or of the usual ones, with the sun in the south-west.
pub fn weathers(names: &[String], usual: &[&str]) -> Result<Vec<Weather>, Refusals> {
    let names = if names.is_empty() { usual.to_vec() } else { names.iter().map(String::as_str).collect() };
    names.into_iter().map(|name| Ok(Weather { sun_azimuth_angle: 215.0, ..weather(name)? })).collect()
}

/// The season of a name.
pub fn season(name: &str) -> Result<Season, &'static str> {
    Season::named(name).ok_or("the seasons are summer, autumn, winter")
}
