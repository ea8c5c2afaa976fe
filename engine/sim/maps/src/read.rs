//! [`read_town`]: bytes of any known format into a finished, checked [`Town`].

use crate::bounds::PlanRectangle;
use crate::combine::add_source;
use crate::fill::fill;
use crate::paving::pave_quarters;
use crate::recognise::recognise;
use crate::streets::{Streets, has_houses_alone, invent_streets};
use crate::{MapConfig, apart};
use cosfly_domain::{ObstacleKind, Town};
use cosfly_frames::Seed;
use cosfly_geodata::cityjson::CityJson;
use cosfly_town::simplify::simplify;
use cosfly_town::{MapError, MapFormat};
use std::collections::BTreeMap;

/// Fewer houses may have any height.
const LEAST_HOUSES: usize = 5;
/// Heights that half of a town's houses may have, metres.
const USUAL_HEIGHT_M: core::ops::RangeInclusive<f64> = 1.5..=150.0;

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
/// Those of [`read_town`], with the number of the file; a number of files that is not that of the configuration.
pub fn read_town_of(files: &[&[u8]], config: &MapConfig, seed: Seed) -> Result<(Town, Vec<String>), (usize, MapError)> {
    let [first, more @ ..] = files else { return Err((0, MapError::new("no map file is given"))) };
    if more.len() != config.more.len() {
        return Err((
            0,
            MapError::new(format!("{} further files for {} further sources", more.len(), config.more.len())),
        ));
    }
    let read = |bytes: &[u8]| recognise(bytes)?.read(bytes, &config.options);
    let bounds = config.bounds_m.map(PlanRectangle::new).transpose().map_err(|rule| (0, MapError::new(rule)))?;
    let (mut town, mut warnings) = read(first).map_err(|error| (0, error))?;
    if let Some(name) = &config.name {
        town.name.clone_from(name);
    }
    if let Some(bounds) = &bounds {
        kept(&mut town, bounds).map_err(|error| (0, error))?;
    }
    for (index, (further, bytes)) in config.more.iter().zip(more).enumerate() {
        let added = add_source(&mut town, further, bytes, bounds.as_ref());
        let more_warnings = added.map_err(|error| (index + 1, error))?;
        warnings.extend(more_warnings.into_iter().map(|warning| format!("{}: {warning}", further.source)));
    }
    let format = recognise(first).map_err(|error| (0, error))?.name();
    let is_asked = config.streets == Some(Streets::Invented);
    let is_usual = config.streets.is_none() && format == CityJson::NAME && has_houses_alone(&town);
    let invented = (is_asked || is_usual).then(|| invent_streets(&mut town));
    let has_invented = matches!(invented, Some(Ok(())));
    // Who did not ask hears of it where a part of the town would have streets.
    let is_told = |why: &String| is_asked || why.contains("`bounds_m` keeps a part");
    warnings.extend(invented.and_then(Result::err).filter(is_told));
    finished(town, warnings, config, (seed, has_invented)).map_err(|error| (0, error))
}

/// Cuts a town.
///
/// # Errors
/// Bounds that leave nothing of it.
fn kept(town: &mut Town, bounds: &PlanRectangle) -> Result<(), MapError> {
    town.update_bounds();
    let whole = PlanRectangle { low: town.min_in_world.truncate(), high: town.max_in_world.truncate() };
    bounds.cut(town);
    if town.obstacles.is_empty() && town.walkable.is_empty() && town.lanes.is_empty() {
        let error = MapError::new(format!("nothing of the town lies within `{}`", bounds.written()));
        return Err(error.hint(format!("the whole town is `{}`", whole.written())));
    }
    Ok(())
}

/// The town with what is invented, its planning boxes and bounds.
fn finished(
    mut town: Town,
    mut warnings: Vec<String>,
    config: &MapConfig,
    (seed, invented_streets): (Seed, bool),
) -> Result<(Town, Vec<String>), MapError> {
    if config.bounds_m.is_some() && town.walkable.is_empty() {
        let error = MapError::new("no ground for people lies within `bounds_m`");
        return Err(error.hint("`cosfly map inspect` shows where people walk: give wider bounds, or others"));
    }
    warnings.extend(apart::check(&town)?);
    if config.fill.is_on() {
        warnings.extend(fill(&mut town, &config.fill, seed));
    }
    pave_quarters(&mut town, invented_streets);
    (town.planning_boxes, town.simplification) = simplify(&town.obstacles, &town.walkable, &config.simplify);
    cosfly_town::lanes::link_lanes(&mut town);
    town.update_bounds();
    warnings.extend(odd_heights(&town));
    cosfly_town::assert_well_formed(&town).map_err(|rule| {
        MapError::new(format!("the town is not well formed: {rule}"))
            .hint("the file seems to be damaged: fetch or export it again")
    })?;
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
