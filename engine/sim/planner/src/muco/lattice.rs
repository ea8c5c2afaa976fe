//! The polar lattice of viewpoints around the moving target.
//!
//! A node is (azimuth, altitude, horizontal radius) around the target's feet in **world** azimuth, so that
//! "stay" moves with the target. An (altitude, radius) pair is a *ring* of nodes at all azimuths.

use crate::config::view::ViewConfig;
use cosfly_frames::{DVec3, real};

/// Largest number of rings.
pub const MAX_RINGS: usize = 96;

/// Numbers of altitudes and the like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LatticeSize {
    /// Directions around the target.
    pub azimuths: usize,
    /// Altitudes between the lowest and the highest.
    pub altitudes: usize,
    /// Horizontal distances between the smallest and the largest.
    pub radii: usize,
}

/// The shape of the lattice, the same at every frame.
pub struct Lattice {
    /// Unit vectors of the azimuths.
    pub directions: Vec<DVec3>,
    /// Altitudes above the target's feet, metres, ascending.
    pub altitudes_m: Vec<f64>,
    /// Horizontal radii, metres, ascending.
    pub radii_m: Vec<f64>,
}

impl Lattice {
    /// Spreads altitudes and radii over the bands of `view`; low altitudes are closer together.
    pub fn new(size: LatticeSize, view: &ViewConfig) -> Self {
        let directions = (0..size.azimuths)
            .map(|a| {
                let (sin, cos) = real::sin_cos(real::TAU * a as f64 / size.azimuths as f64);
                DVec3::new(cos, sin, 0.0)
            })
            .collect();
        // Just above the lowest altitude, so that smoothing need not press against its bound.
        let low = (view.min_altitude_m + 0.5).min(view.max_altitude_m);
        let altitudes_m = spread(size.altitudes, low, view.max_altitude_m, 1.3);
        let radii_m = spread(size.radii, view.min_radius_m, view.max_radius_m, 1.0);
        Self { directions, altitudes_m, radii_m }
    }

    /// (altitude, radius) pairs.
    pub fn rings(&self) -> usize {
        self.altitudes_m.len() * self.radii_m.len()
    }

    /// Altitude and radius of a ring, metres.
    pub fn ring_m(&self, ring: usize) -> (f64, f64) {
        (self.altitudes_m[ring / self.radii_m.len()], self.radii_m[ring % self.radii_m.len()])
    }

    /// Nodes per frame; node = (altitude * radii + radius) * azimuths + azimuth.
    pub fn nodes(&self) -> usize {
        self.directions.len() * self.rings()
    }

    /// (azimuth, altitude, radius) of a node.
    pub fn split(&self, node: usize) -> (usize, usize, usize) {
        let (ring, azimuth) = (node / self.directions.len(), node % self.directions.len());
        (azimuth, ring / self.radii_m.len(), ring % self.radii_m.len())
    }

    /// Position of a node relative to the target's feet, metres.
    pub fn offset(&self, node: usize) -> DVec3 {
        let (azimuth, altitude, radius) = self.split(node);
        self.directions[azimuth] * self.radii_m[radius] + DVec3::new(0.0, 0.0, self.altitudes_m[altitude])
    }
}

/// `count` numbers from `low` to `high`; a `bend` above 1 crowds them at the low end.
fn spread(count: usize, low: f64, high: f64, bend: f64) -> Vec<f64> {
    if count < 2 {
        return vec![low];
    }
    (0..count).map(|i| low + (high - low) * real::powf(i as f64 / (count - 1) as f64, bend)).collect()
}
