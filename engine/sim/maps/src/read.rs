//! [`read_town`]: bytes of any known format into a finished, checked [`Town`].

use crate::combine::add_source;
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
    read_town_of(&[bytes], config, seed).map_err(|(_, error)| error)
}

/// [`read_town`] of several files: the first is the town's own, the others are those of [`MapConfig::more`].
///
/// # Errors
/// As [`read_town`], with the number of the file; a number of files that is not that of the configuration.
pub fn read_town_of(files: &[&[u8]], config: &MapConfig, seed: Seed) -> Result<(Town, Vec<String>), (usize, MapError)> {
    let [first, more @ ..] = files else { return Err((0, MapError::new("no map file is given"))) };
    if more.len() != config.more.len() {
        return Err((
            0,
            MapError::new(format!("{} further files for {} further sources", more.len(), config.more.len())),
        ));
    }
    let read = |bytes: &[u8]| recognise(bytes)?.read(bytes, &config.options);
    let (mut town, mut warnings) = read(first).map_err(|error| (0, error))?;
    for (index, (further, bytes)) in config.more.iter().zip(more).enumerate() {
        let more_warnings = add_source(&mut town, further, bytes).map_err(|error| (index + 1, error))?;
        warnings.extend(more_warnings.into_iter().map(|warning| format!("{}: {warning}", further.source)));
    }
    finished(town, warnings, config, seed).map_err(|error| (0, error))
}

/// The town with what is invented, its planning boxes and bounds.
fn finished(
    mut town: Town,
    mut warnings: Vec<String>,
    config: &MapConfig,
    seed: Seed,
) -> Result<(Town, Vec<String>), MapError> {
    if let Some(name) = &config.name {
        town.name.clone_from(name);
    }
    if config.fill.is_on() {
        warnings.extend(fill(&mut town, &config.fill, seed));
    }
    (town.planning_boxes, town.simplification) = simplify(&town.obstacles, &town.walkable, &config.simplify);
    town.link_lanes();
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
