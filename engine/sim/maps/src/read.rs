//! [`read_town`]: bytes of any known format into a finished, checked [`Town`].

use crate::combine::add_source;
use crate::fill::fill;
use crate::paving::pave_quarters;
use crate::simplify::simplify;
use crate::{FORMATS, Format};
use crate::{MapConfig, MapError, ObstacleKind, Town};
use cosfly_frames::Seed;
use std::collections::BTreeMap;

/// Fewer houses may have any height.
const LEAST_HOUSES: usize = 5;
/// Heights that half of a town's houses may have, metres.
const USUAL_HEIGHT_M: core::ops::RangeInclusive<f64> = 1.5..=150.0;

/// Whether a file of this beginning is of some format.
type IsIt = fn(&[u8]) -> bool;

/// Formats that are not read, by the beginnings of their files, and the way to one that is.
const RELATIVES: &[(IsIt, &str)] = &[
    (|head| head.starts_with(b"BZh"), "the file is packed by bzip2: unpack it with `bunzip2`"),
    (|head| head.starts_with(b"PK\x03\x04"), "the file is a ZIP archive: unpack it"),
    (|head| head.starts_with(&[0x1f, 0x8b]), "the file is packed by gzip: unpack it with `gunzip`"),
    (|head| holds(head, "CityModel"), "the file is CityGML: `citygml-tools to-cityjson FILE` makes CityJSON of it"),
    (
        |head| holds(head, "<osmChange"),
        "the file has changes of OpenStreetMap: `osmium apply-changes` puts them into an extract",
    ),
    (|head| holds(head, "Overpass"), "ask Overpass for `[out:xml]`, with all nodes: `(._;>;); out;`"),
    (
        |head| holds(head, "\"FeatureCollection\""),
        "the file is GeoJSON: take an extract of OpenStreetMap, or CityJSON, of the same place",
    ),
    (
        |head| head.starts_with(b"b3dm") || holds(head, "\"geometricError\""),
        "the file is of 3D Tiles: export the tiles as GLB",
    ),
    (|head| head.starts_with(b"ISO-10303-21"), "the file is IFC: export it as GLB, OBJ or CityJSON"),
    (
        |head| head.starts_with(b"Kaydara FBX") || holds(head, "<COLLADA"),
        "open the file in Blender and export it as GLB",
    ),
    (|head| head.starts_with(b"ASTM-E57"), "the file is E57: `pdal translate FILE cloud.laz` makes LAZ of it"),
];

fn holds(head: &[u8], word: &str) -> bool {
    head.windows(word.len()).any(|window| window == word.as_bytes())
}

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
    pave_quarters(&mut town);
    (town.planning_boxes, town.simplification) = simplify(&town.obstacles, &town.walkable, &config.simplify);
    town.link_lanes();
    town.update_bounds();
    warnings.extend(odd_heights(&town));
    town.assert_well_formed().map_err(|rule| MapError::new(format!("the town is not well formed: {rule}")))?;
    Ok((town, warnings))
}

/// Says so when half of the houses are lower than a person or higher than a tower: their unit is likely another.
fn odd_heights(town: &Town) -> Option<String> {
    let mut ends_m: BTreeMap<u32, [f64; 2]> = BTreeMap::new();
    for one in town.obstacles.iter().filter(|one| one.kind == ObstacleKind::Building && !one.synthetic) {
        let (low, high) = one.shape.bounds_in_world();
        let ends_m = ends_m.entry(one.object_id).or_insert([low.z, high.z]);
        *ends_m = [ends_m[0].min(low.z), ends_m[1].max(high.z)];
    }
    let mut heights_m: Vec<f64> = ends_m.values().map(|[low, high]| high - low).collect();
    heights_m.sort_by(f64::total_cmp);
    let median_m = *heights_m.get(heights_m.len() / 2)?;
    let is_odd = heights_m.len() >= LEAST_HOUSES && !USUAL_HEIGHT_M.contains(&median_m);
    is_odd.then(|| {
        format!("half of the buildings are {median_m:.1} m high or more: check the unit of the file's lengths")
    })
}

/// The format of a file that begins with `head`; [`Format::HEAD_BYTES`] are enough.
///
/// # Errors
/// The file is empty or of no known format.
pub fn recognise(head: &[u8]) -> Result<&'static Format, MapError> {
    FORMATS.iter().find(|format| format.recognises(head)).ok_or_else(|| {
        let names: Vec<_> = FORMATS.iter().map(Format::name).collect();
        let message = if head.is_empty() { "the file is empty" } else { "the file is of no known map format" };
        let error = MapError::new(message).hint(format!("known formats: {}", names.join(", ")));
        let head = &head[..head.len().min(Format::HEAD_BYTES)];
        RELATIVES.iter().filter(|(is_it, _)| is_it(head)).fold(error, |error, (_, advice)| error.hint(*advice))
    })
}
