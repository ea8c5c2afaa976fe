//! What plugins may call: messages and questions about the town.

use crate::interface_0_1::Severity;
use crate::session::Guest;
use cosfly_frames::DVec3;
use wasmtime::component::Linker;
use wasmtime::{Engine, Result, StoreContextMut, bail};

/// The interfaces offered, as plugins import them.
pub const OFFERED: [&str; 2] = ["cosfly:plugin/log@0.1.0", "cosfly:plugin/town@0.1.0"];

/// All offered functions.
pub fn linker(engine: &Engine) -> Result<Linker<Guest>> {
    let mut linker = Linker::new(engine);
    let mut log = linker.instance(OFFERED[0])?;
    log.func_wrap("message", |mut store: StoreContextMut<'_, Guest>, (severity, text): (Severity, String)| {
        store.data_mut().say(severity, &text);
        Ok(())
    })?;
    let mut town = linker.instance(OFFERED[1])?;
    town.func_wrap("rays", |store: StoreContextMut<'_, Guest>, (origins, ends): (Vec<f64>, Vec<f64>)| {
        let (origins, ends) = (points("rays", &origins)?, points("rays", &ends)?);
        if origins.len() != ends.len() {
            bail!("`rays` was given {} origins and {} ends", origins.len(), ends.len());
        }
        let town = &store.data().town;
        let share = |(from, to): (&DVec3, &DVec3)| town.first_hit(*from, *to).unwrap_or(f64::INFINITY);
        Ok((origins.iter().zip(&ends).map(share).collect::<Vec<f64>>(),))
    })?;
    town.func_wrap("distances", |store: StoreContextMut<'_, Guest>, (given, within): (Vec<f64>, f64)| {
        let given = points("distances", &given)?;
        if !(within.is_finite() && within >= 0.0) {
            bail!("`distances` was given `within` = {within}; it must be a number from 0 on");
        }
        let town = &store.data().town;
        Ok((given.iter().map(|point| town.distance_m(*point, within)).collect::<Vec<f64>>(),))
    })?;
    town.func_wrap("ground", |store: StoreContextMut<'_, Guest>, (places,): (Vec<f64>,)| {
        let (pairs, rest) = places.as_chunks::<2>();
        if !rest.is_empty() {
            bail!("`ground` was given {} numbers; it takes 2 per place", places.len());
        }
        let town = &store.data().town;
        Ok((pairs.iter().map(|[x, y]| town.ground_m(*x, *y).unwrap_or(f64::NAN)).collect::<Vec<f64>>(),))
    })?;
    town.func_wrap("buildings", |store: StoreContextMut<'_, Guest>, (): ()| {
        let numbers = store.data().town.buildings().into_iter().flat_map(|(building, shape)| {
            let (center, half) = (shape.center_in_world, shape.half_extents_m);
            [f64::from(building), center.x, center.y, center.z, half.x, half.y, half.z, shape.yaw_rad]
        });
        Ok((numbers.collect::<Vec<f64>>(),))
    })?;
    Ok(linker)
}

fn points(function: &str, numbers: &[f64]) -> Result<Vec<DVec3>> {
    let (triples, rest) = numbers.as_chunks::<3>();
    if !rest.is_empty() {
        bail!("`{function}` was given {} numbers; it takes 3 per point", numbers.len());
    }
    Ok(triples.iter().map(|triple| DVec3::from_array(*triple)).collect())
}
