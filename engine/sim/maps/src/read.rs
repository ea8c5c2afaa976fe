//! [`read_town`]: bytes of any known format into a finished, checked [`Town`].

use crate::fill::fill;
use crate::formats::{FORMATS, MapFormat};
use crate::simplify::simplify;
use crate::{MapConfig, MapError, Town};
use cosfly_frames::Seed;

/// Reads a map of any known format; fills and simplifies as `options` ask. `seed` feeds the fill only.
pub fn read_town(bytes: &[u8], options: &MapConfig, seed: Seed) -> Result<(Town, Vec<String>), MapError> {
    let format = recognised(bytes)?;
    let (mut town, mut warnings) = format.read(bytes, options)?;
    if let Some(name) = &options.name {
        town.name.clone_from(name);
    }
    if options.fill.is_on() {
        warnings.extend(fill(&mut town, &options.fill, seed));
    }
    (town.planning_boxes, town.simplification) = simplify(&town.obstacles, &town.walkable, &options.simplify);
    town.update_bounds();
    town.assert_well_formed().map_err(|rule| MapError::new(format!("the town is not well formed: {rule}")))?;
    Ok((town, warnings))
}

fn recognised(bytes: &[u8]) -> Result<&'static dyn MapFormat, MapError> {
    FORMATS.iter().copied().find(|format| format.recognises(bytes)).ok_or_else(|| {
        let names: Vec<_> = FORMATS.iter().map(|format| format.name()).collect();
        let what = if bytes.is_empty() { "the file is empty" } else { "the file is of no known map format" };
        MapError::new(what).hint(format!("known formats: {}", names.join(", ")))
    })
}
