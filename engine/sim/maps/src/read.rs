//! [`read_town`]: bytes of any known format into a finished, checked [`Town`].

use crate::fill::fill;
use crate::simplify::simplify;
use crate::{FORMATS, Format};
use crate::{MapConfig, MapError, Town};
use cosfly_frames::Seed;

/// Reads a map of any known format; fills and simplifies as `config` asks. `seed` feeds the fill only. The second value
/// holds warnings.
///
/// # Errors
/// A file of no known format, or one that its reader refuses.
pub fn read_town(bytes: &[u8], config: &MapConfig, seed: Seed) -> Result<(Town, Vec<String>), MapError> {
    let (mut town, mut warnings) = recognise(bytes)?.read(bytes, &config.options)?;
    if let Some(name) = &config.name {
        town.name.clone_from(name);
    }
    if config.fill.is_on() {
        warnings.extend(fill(&mut town, &config.fill, seed));
    }
    (town.planning_boxes, town.simplification) = simplify(&town.obstacles, &town.walkable, &config.simplify);
    town.update_bounds();
    town.assert_well_formed().map_err(|rule| MapError::new(format!("the town is not well formed: {rule}")))?;
    Ok((town, warnings))
}

/// The format of a file that begins with `head`; [`Format::HEAD_BYTES`] are enough.
///
/// # Errors
/// The file is empty or of no known format.
pub fn recognise(head: &[u8]) -> Result<&'static Format, MapError> {
    FORMATS.iter().find(|format| format.recognises(head)).ok_or_else(|| {
        let names: Vec<_> = FORMATS.iter().map(Format::name).collect();
        let message = if head.is_empty() { "the file is empty" } else { "the file is of no known map format" };
        MapError::new(message).hint(format!("known formats: {}", names.join(", ")))
    })
}
