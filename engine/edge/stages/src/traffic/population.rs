//! The populations of a stage `traffic`: one line per kind.

use super::config::TrafficConfig;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_frames::{DVec2, Seed};
use cosfly_maps::Town;
use cosfly_pedestrians::{Crowd, PedestrianError, Prescribed, RecordedConfig, RecordedError, Recording, scripted};
use cosfly_world::{Clock, Population};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// All populations, in the order of their numbers: further kinds come last. `files` are those of the recorded people.
pub fn all(
    config: &TrafficConfig,
    files: &[PathBuf],
    town: &Town,
    clock: Clock,
    seed: Seed,
) -> Result<Vec<Box<dyn Population>>> {
    let mut others: Vec<Box<dyn Population>> = vec![];
    for (number, (recorded, path)) in config.recorded.iter().zip(files).enumerate() {
        let seed = seed.child("recorded", number as u64);
        others.push(Box::new(recording(&recorded.read, path, town, clock, seed)?));
    }
    let refused = |error| refusal(error, &town.name);
    let grid = match config.people.count > 0 || !config.scripted.is_empty() {
        true => Some(Arc::new(Crowd::grid(town, &config.people).map_err(refused)?)),
        false => None,
    };
    if let (Some(grid), false) = (&grid, config.scripted.is_empty()) {
        let seed = seed.child("scripted", 0);
        let fastest_mps = config.people.speed.max_mps;
        others.push(Box::new(scripted(&config.scripted, grid, fastest_mps, clock, seed).map_err(refused)?));
    }
    let mut all: Vec<Box<dyn Population>> = vec![];
    if let (Some(grid), true) = (grid, config.people.count > 0) {
        let (seed, taken) = (seed.child("people", 0), first_places(&others));
        all.push(Box::new(Crowd::beside(grid, &config.people, clock, seed, &taken).map_err(refused)?));
    }
    all.append(&mut others);
    Ok(all)
}

/// Places and radii of all bodies that are present at the beginning.
fn first_places(populations: &[Box<dyn Population>]) -> Vec<(DVec2, f64)> {
    let mut places = vec![];
    for population in populations {
        let plans = population.plans().into_iter().enumerate();
        places.extend(
            plans.filter_map(|(body, plan)| Some((population.state(body)?.feet_in_world.truncate(), plan.radius_m()))),
        );
    }
    places
}

fn recording(config: &RecordedConfig, path: &Path, town: &Town, clock: Clock, seed: Seed) -> Result<Prescribed> {
    let bytes = std::fs::read(path)
        .map_err(|error| Diagnostic::io(format!("read the recorded people `{}`", path.display()), &error))?;
    let refused = |error: RecordedError| {
        Diagnostic::new("tracks-refused", Fault::Input, error.to_string())
            .because(format!("in `{}`", path.display()))
            .hint(error.hint)
    };
    let recording = Recording::read(&bytes, config).map_err(refused)?;
    recording.placed(town, config, clock, seed).map_err(refused)
}

fn refusal(error: PedestrianError, town: &str) -> Box<Diagnostic> {
    Diagnostic::new("pedestrians-refused", Fault::Input, format!("{error}"))
        .because(format!("in town `{town}`"))
        .hint(error.hint())
}
