//! The polar lattice of viewpoints around the moving target.
//!
//! A node is (azimuth, altitude, horizontal radius) around the target's feet in **world** azimuth, so that
//! "stay" moves with the target. The (altitude, radius) pairs of one azimuth are its *lanes*; their number is
//! rounded up to whole vectors of [`VECTOR`], and the lanes beyond are never free.

use crate::config::ViewConfig;
use cosfly_frames::{DVec3, real};

/// Lanes are handled in groups of this many.
pub const VECTOR: usize = 16;
/// Largest number of (altitude, radius) pairs.
pub const MAX_LANES: usize = 96;

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
    /// Altitude of each lane, metres, vectors filled up.
    pub lane_altitude_m: Vec<f32>,
    /// Radius of each lane, metres, vectors filled up.
    pub lane_radius_m: Vec<f32>,
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
        let lanes = altitudes_m.len() * radii_m.len();
        let padded = lanes.next_multiple_of(VECTOR);
        let lane = |of: &dyn Fn(usize) -> f64| (0..padded).map(|lane| of(lane.min(lanes - 1)) as f32).collect();
        Self {
            lane_altitude_m: lane(&|lane| altitudes_m[lane / radii_m.len()]),
            lane_radius_m: lane(&|lane| radii_m[lane % radii_m.len()]),
            directions,
            altitudes_m,
            radii_m,
        }
    }

    /// (altitude, radius) pairs per azimuth.
    pub fn lanes(&self) -> usize {
        self.altitudes_m.len() * self.radii_m.len()
    }

    /// Lanes per azimuth with those that fill up the last vector.
    pub fn stride(&self) -> usize {
        self.lane_radius_m.len()
    }

    /// Nodes per frame, filled up; node = azimuth * stride + altitude * radii + radius.
    pub fn nodes(&self) -> usize {
        self.directions.len() * self.stride()
    }

    /// Whether a node is one and not filling.
    pub fn is_real(&self, node: usize) -> bool {
        node % self.stride() < self.lanes()
    }

    /// (azimuth, altitude, radius) of a real node.
    pub fn split(&self, node: usize) -> (usize, usize, usize) {
        let (azimuth, lane) = (node / self.stride(), node % self.stride());
        (azimuth, lane / self.radii_m.len(), lane % self.radii_m.len())
    }

    /// Where a real node is relative to the target's feet, metres.
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
