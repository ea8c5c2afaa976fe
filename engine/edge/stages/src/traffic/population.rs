//! The populations of a stage `traffic`: one line per kind.

use super::config::TrafficConfig;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_frames::Seed;
use cosfly_maps::Town;
use cosfly_pedestrians::{Crowd, PedestrianError};
use cosfly_world::{Clock, Population};
use std::sync::Arc;

/// All populations, in the order of their numbers: further kinds come last.
pub fn all(config: &TrafficConfig, town: &Town, clock: Clock, seed: Seed) -> Result<Vec<Box<dyn Population>>> {
    let mut all: Vec<Box<dyn Population>> = vec![];
    if config.people.count > 0 {
        all.push(Box::new(crowd(config, town, clock, seed).map_err(|error| refusal(error, &town.name))?));
    }
    Ok(all)
}

fn crowd(config: &TrafficConfig, town: &Town, clock: Clock, seed: Seed) -> Result<Crowd, PedestrianError> {
    let grid = Crowd::grid(town, &config.people)?;
    Crowd::new(Arc::new(grid), &config.people, clock, seed.child("people", 0))
}

fn refusal(error: PedestrianError, town: &str) -> Box<Diagnostic> {
    Diagnostic::new("pedestrians-refused", Fault::Input, format!("{error}"))
        .because(format!("in town `{town}`"))
        .hint(error.hint())
}
