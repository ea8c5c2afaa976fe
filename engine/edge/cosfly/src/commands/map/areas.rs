//! Areas of people over a plan, for `cosfly map inspect`.

use super::own_recipe::{Written, read_own};
use crate::command::Refusals;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::Town;
use cosfly_experts::area_pictures::with_pixels;
use cosfly_pedestrians::{AreaConfig, AreaMap, PedestrianConfig, WalkableGrid};
use cosfly_preview::PlanShade;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Colours of closed ground, of ground where no walk begins, and of the ground where most do.
const COLOURS: [[u8; 3]; 3] = [[200, 30, 30], [90, 90, 100], [255, 140, 0]];

/// The areas of tables such as those of a recipe, with the pixels of their pictures.
pub fn read(command: &str, map: &Path, tables: &[String]) -> Result<Vec<AreaConfig>, Refusals> {
    // TOML and JSON write strings alike.
    let map = Value::from(map.to_string_lossy().as_ref());
    let areas = tables.join(", ");
    let town = format!("name = \"areas\"\n\n[stages.town]\nuse = \"map\"\nsource = {map}\n");
    let people = format!("[stages.people]\nuse = \"pedestrians\"\ninputs.town = \"town\"\nareas = [{areas}]\n");
    let recipe = format!("{town}\n{people}");
    let written: Vec<Written<'_>> = tables.iter().map(|table| ("--area", table.as_str())).collect();
    let recipe = read_own(command, &recipe, &[], &written)?;
    let Some(stage) = recipe.stages.last() else { return Ok(vec![]) };
    let files: Vec<PathBuf> = stage.sources.iter().map(|source| source.path.clone()).collect();
    let config: PedestrianConfig = serde_json::from_value(stage.parameters.clone()).map_err(|error| {
        Diagnostic::new("map-areas", Fault::Bug, format!("areas that were checked cannot be read: {error}"))
    })?;
    Ok(with_pixels(&config.areas, &files)?)
}

/// Colours of areas on a plan: closed ground red, other ground from grey, where no walk begins, to orange, where most do.
pub fn shade(areas: &[AreaConfig]) -> Box<PlanShade> {
    let map = AreaMap::new(areas);
    Box::new(move |point| {
        let ([closed, none, most], (share, is_closed)) = (COLOURS, map.at(point)?);
        let mixed = |at: usize| (f64::from(none[at]) + share * (f64::from(most[at]) - f64::from(none[at]))) as u8;
        Some(if is_closed { (closed, 0.6) } else { ([0, 1, 2].map(mixed), 0.6) })
    })
}

/// Ground that the areas leave to people, in words.
pub fn text(town: &Town, areas: &[AreaConfig]) -> Result<String> {
    let ground = |areas: &[AreaConfig]| {
        let config = PedestrianConfig { areas: areas.to_vec(), ..PedestrianConfig::default() };
        let grid = WalkableGrid::build(town, &config);
        let refused = |error: cosfly_pedestrians::PedestrianError| {
            Diagnostic::new("map-areas", Fault::Input, format!("{error}")).hint(error.hint())
        };
        let cell_m2 = config.grid_m * config.grid_m;
        grid.map(|grid| [grid.len(), grid.start_cells()].map(|cells| cells as f64 * cell_m2)).map_err(refused)
    };
    let ([all_m2, _], [open_m2, start_m2]) = (ground(&[])?, ground(areas)?);
    Ok(format!(
        "areas: {open_m2:.0} of {all_m2:.0} m2 walkable ground are open to people (red: closed); walks begin on {start_m2:.0} m2 \
         (grey: nowhere; orange: most)"
    ))
}
