//! The town, asked in batches; empty and flat in native tests.

use crate::Point;
#[cfg(target_family = "wasm")]
use crate::abi::answered;

/// The functions of the host: lists are an address and a count, the last argument is where the answer goes.
#[cfg(target_family = "wasm")]
mod host {
    #[link(wasm_import_module = "cosfly:plugin/town@0.1.0")]
    unsafe extern "C" {
        pub fn rays(origins: *const f64, o: usize, ends: *const f64, e: usize, answer: *mut [usize; 2]);
        pub fn distances(points: *const f64, p: usize, within: f64, answer: *mut [usize; 2]);
        pub fn ground(places: *const f64, p: usize, answer: *mut [usize; 2]);
        pub fn buildings(answer: *mut [usize; 2]);
    }
}

/// A box of a building.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuildingBox {
    /// Number of the building.
    pub building: u32,
    /// The middle, metres.
    pub center: Point,
    /// Half of its sizes, metres.
    pub half: Point,
    /// Turn about z, radians.
    pub yaw: f64,
}

/// Where the straight way from each origin to its end first meets an obstacle, as a share of the way; infinity where it is free.
pub fn rays(origins: &[Point], ends: &[Point]) -> Vec<f64> {
    #[cfg(target_family = "wasm")]
    return {
        let (origins, ends) = (origins.as_flattened(), ends.as_flattened());
        // SAFETY: the lists are there while the host reads them, here and below.
        answered(|to| unsafe { host::rays(origins.as_ptr(), origins.len(), ends.as_ptr(), ends.len(), to) })
    };
    #[cfg(not(target_family = "wasm"))]
    vec![f64::INFINITY; origins.len().min(ends.len())]
}

/// Distance from each point to the nearest obstacle, metres, at most `within`; negative inside one.
pub fn distances(points: &[Point], within: f64) -> Vec<f64> {
    #[cfg(target_family = "wasm")]
    return {
        let points = points.as_flattened();
        answered(|to| unsafe { host::distances(points.as_ptr(), points.len(), within, to) })
    };
    #[cfg(not(target_family = "wasm"))]
    vec![within; points.len()]
}

/// Height of the ground at each place, metres; not a number where there is none.
pub fn ground(places: &[[f64; 2]]) -> Vec<f64> {
    #[cfg(target_family = "wasm")]
    return {
        let places = places.as_flattened();
        answered(|to| unsafe { host::ground(places.as_ptr(), places.len(), to) })
    };
    #[cfg(not(target_family = "wasm"))]
    vec![0.0; places.len()]
}

/// The boxes of all buildings; those of one building follow each other.
pub fn buildings() -> Vec<BuildingBox> {
    #[cfg(target_family = "wasm")]
    let numbers: Vec<f64> = answered(|to| unsafe { host::buildings(to) });
    #[cfg(not(target_family = "wasm"))]
    let numbers: Vec<f64> = Vec::new();
    let (boxes, _) = numbers.as_chunks::<8>();
    let of = |n: &[f64; 8]| BuildingBox {
        building: n[0] as u32,
        center: [n[1], n[2], n[3]],
        half: [n[4], n[5], n[6]],
        yaw: n[7],
    };
    boxes.iter().map(of).collect()
}
