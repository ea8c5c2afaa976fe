//! The functions that plugins may call: messages and questions about the town, from components and from core modules.

use crate::direct_abi::DirectAbi;
use crate::interface_0_1::Severity;
use crate::sandbox::Guest;
use crate::town::TownView;
use cosfly_diagnose::counted;
use cosfly_frames::DVec3;
use wasmtime::component::Linker;
use wasmtime::{Caller, Engine, Result, StoreContextMut, bail};

const LOG: &str = "cosfly:plugin/log@0.1.0";
const TOWN: &str = "cosfly:plugin/town@0.1.0";
/// The interfaces offered, as plugins import them.
pub const OFFERED: [&str; 2] = [LOG, TOWN];

/// All offered functions for components.
pub fn linker(engine: &Engine) -> Result<Linker<Guest>> {
    type Store<'a> = StoreContextMut<'a, Guest>;
    let mut linker = Linker::new(engine);
    let mut log = linker.instance(LOG)?;
    log.func_wrap("message", |mut store: Store<'_>, (severity, text): (Severity, String)| {
        store.data_mut().say(severity, &text);
        Ok(())
    })?;
    let mut town = linker.instance(TOWN)?;
    town.func_wrap("rays", |store: Store<'_>, (origins, ends): (Vec<f64>, Vec<f64>)| {
        Ok((rays(&*store.data().town, &origins, &ends)?,))
    })?;
    town.func_wrap("distances", |store: Store<'_>, (given, within): (Vec<f64>, f64)| {
        Ok((distances(&*store.data().town, &given, within)?,))
    })?;
    town.func_wrap("ground", |store: Store<'_>, (places,): (Vec<f64>,)| Ok((ground(&*store.data().town, &places)?,)))?;
    town.func_wrap("buildings", |store: Store<'_>, (): ()| Ok((buildings(&*store.data().town),)))?;
    Ok(linker)
}

/// All offered functions for core modules: lists come as address and count, answers go where the last argument says.
pub fn direct_linker(engine: &Engine) -> Result<wasmtime::Linker<Guest>> {
    type Store<'a> = Caller<'a, Guest>;
    let mut linker = wasmtime::Linker::new(engine);
    linker.func_wrap(LOG, "message", |mut store: Store<'_>, severity: u32, at: u32, bytes: u32| {
        let severity = match severity {
            0 => Severity::Debug,
            1 => Severity::Info,
            2 => Severity::Warn,
            3 => Severity::Error,
            other => bail!("`message` was given the level {other}"),
        };
        let text = abi(&store)?.text(&store, at, bytes)?;
        store.data_mut().say(severity, &text);
        Ok(())
    })?;
    linker.func_wrap(
        TOWN,
        "rays",
        |mut store: Store<'_>, from: u32, froms: u32, to: u32, tos: u32, answer: u32| -> Result<()> {
            let abi = abi(&store)?;
            let (origins, ends) = (abi.numbers(&store, from, froms)?, abi.numbers(&store, to, tos)?);
            let shares = rays(&*store.data().town, &origins, &ends)?;
            abi.answer(&mut store, answer, &shares)
        },
    )?;
    linker.func_wrap(
        TOWN,
        "distances",
        |mut store: Store<'_>, at: u32, count: u32, within: f64, answer: u32| -> Result<()> {
            let abi = abi(&store)?;
            let given = abi.numbers(&store, at, count)?;
            let found = distances(&*store.data().town, &given, within)?;
            abi.answer(&mut store, answer, &found)
        },
    )?;
    linker.func_wrap(TOWN, "ground", |mut store: Store<'_>, at: u32, count: u32, answer: u32| -> Result<()> {
        let abi = abi(&store)?;
        let places = abi.numbers(&store, at, count)?;
        let heights = ground(&*store.data().town, &places)?;
        abi.answer(&mut store, answer, &heights)
    })?;
    linker.func_wrap(TOWN, "buildings", |mut store: Store<'_>, answer: u32| -> Result<()> {
        let numbers = buildings(&*store.data().town);
        abi(&store)?.answer(&mut store, answer, &numbers)
    })?;
    Ok(linker)
}

fn abi(store: &Caller<'_, Guest>) -> Result<DirectAbi> {
    match &store.data().abi {
        Some(abi) => Ok(abi.clone()),
        None => bail!("it called the host before it was there itself"),
    }
}

fn rays(town: &dyn TownView, origins: &[f64], ends: &[f64]) -> Result<Vec<f64>> {
    let (origins, ends) = (points("rays", origins)?, points("rays", ends)?);
    if origins.len() != ends.len() {
        bail!("`rays` was given {} origins and {} ends", origins.len(), ends.len());
    }
    let share = |(from, to): (&DVec3, &DVec3)| town.first_hit(*from, *to).unwrap_or(f64::INFINITY);
    Ok(origins.iter().zip(&ends).map(share).collect())
}

fn distances(town: &dyn TownView, given: &[f64], within: f64) -> Result<Vec<f64>> {
    let given = points("distances", given)?;
    if !(within.is_finite() && within >= 0.0) {
        bail!("`distances` was given `within` = {within}; it must be a number from 0 on");
    }
    Ok(given.iter().map(|point| town.distance_m(*point, within)).collect())
}

fn ground(town: &dyn TownView, places: &[f64]) -> Result<Vec<f64>> {
    let (pairs, rest) = places.as_chunks::<2>();
    if !rest.is_empty() {
        bail!("`ground` was given {}; it takes 2 per place", counted(places.len(), "number"));
    }
    Ok(pairs.iter().map(|[x, y]| town.ground_m(*x, *y).unwrap_or(f64::NAN)).collect())
}

fn buildings(town: &dyn TownView) -> Vec<f64> {
    let numbers = town.buildings().into_iter().flat_map(|(building, shape)| {
        let (center, half) = (shape.center_in_world, shape.half_extents_m);
        [f64::from(building), center.x, center.y, center.z, half.x, half.y, half.z, shape.yaw_rad]
    });
    numbers.collect()
}

fn points(function: &str, numbers: &[f64]) -> Result<Vec<DVec3>> {
    let (triples, rest) = numbers.as_chunks::<3>();
    if !rest.is_empty() {
        bail!("`{function}` was given {}; it takes 3 per point", counted(numbers.len(), "number"));
    }
    Ok(triples.iter().map(|triple| DVec3::from_array(*triple)).collect())
}
