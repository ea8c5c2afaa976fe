//! The town, asked in batches; empty and flat in native tests.

use crate::Point;

/// A box of a building.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuildingBox {
    /// Number of the building.
    pub building: u32,
    /// Its middle, metres.
    pub center: Point,
    /// Half of its sizes, metres.
    pub half: Point,
    /// Turn about z, radians.
    pub yaw: f64,
}

/// Where the straight way from each origin to its end first meets an obstacle, as a share of the way; infinity where it is free.
pub fn rays(origins: &[Point], ends: &[Point]) -> Vec<f64> {
    #[cfg(target_family = "wasm")]
    return crate::bindings::cost_term::cosfly::plugin::town::rays(origins.as_flattened(), ends.as_flattened());
    #[cfg(not(target_family = "wasm"))]
    vec![f64::INFINITY; origins.len().min(ends.len())]
}

/// Distance from each point to the nearest obstacle, metres, at most `within`; negative inside one.
pub fn distances(points: &[Point], within: f64) -> Vec<f64> {
    #[cfg(target_family = "wasm")]
    return crate::bindings::cost_term::cosfly::plugin::town::distances(points.as_flattened(), within);
    #[cfg(not(target_family = "wasm"))]
    vec![within; points.len()]
}

/// Height of the ground at each place, metres; not a number where there is none.
pub fn ground(places: &[[f64; 2]]) -> Vec<f64> {
    #[cfg(target_family = "wasm")]
    return crate::bindings::cost_term::cosfly::plugin::town::ground(places.as_flattened());
    #[cfg(not(target_family = "wasm"))]
    vec![0.0; places.len()]
}

/// The boxes of all buildings; those of one building follow each other.
pub fn buildings() -> Vec<BuildingBox> {
    #[cfg(target_family = "wasm")]
    let numbers = crate::bindings::cost_term::cosfly::plugin::town::buildings();
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
