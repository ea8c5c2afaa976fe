//! [`LidarPattern`]: when and where a lidar shoots.

use cosfly_frames::{DVec3, real};

/// Shots, directions and ranges of a lidar.
#[derive(Clone, Debug)]
pub struct LidarPattern {
    /// Shots a second; the beams of a shot are fired together.
    pub shots_hz: u32,
    /// Distances of the nearest echo, and of the farthest one from a surface that reflects 80 %, metres.
    pub range_m: [f64; 2],
    /// Standard deviation of a distance, metres.
    pub deviation_m: f64,
    pub(super) beams: Beams,
}

/// Directions of the beams.
#[derive(Clone, Debug)]
pub(super) enum Beams {
    /// Beams of one azimuth, which turns through a range in a sweep: sine and cosine of each elevation, azimuths in radians.
    Rings { elevations: Vec<(f64, f64)>, azimuths_rad: [f64; 2] },
    /// Azimuth to the right and elevation of a single beam at a time, seconds; radians.
    Beam(fn(f64) -> [f64; 2]),
}

impl Beams {
    /// Rings at these elevations that turn from one azimuth to another, degrees.
    pub(super) fn rings(elevations_deg: &[f64], azimuths_deg: [f64; 2]) -> Self {
        let elevations = elevations_deg.iter().map(|elevation_deg| real::sin_cos(elevation_deg.to_radians())).collect();
        Self::Rings { elevations, azimuths_rad: azimuths_deg.map(f64::to_radians) }
    }
}

impl LidarPattern {
    /// Beams of a shot.
    pub fn beams(&self) -> usize {
        match &self.beams {
            Beams::Rings { elevations, .. } => elevations.len(),
            Beams::Beam(_) => 1,
        }
    }

    /// Shots of a sweep; `None` where that is no whole number.
    pub fn shots(&self, rate_hz: f64) -> Option<usize> {
        let shots = f64::from(self.shots_hz) / rate_hz;
        (shots >= 1.0 && (shots - shots.round()).abs() < 1e-6).then_some(shots.round() as usize)
    }

    /// Calls `each` with the unit vector along each beam of a shot, in the sensor's axes (x ahead, y right, z up). `share` of the sweep has
    /// passed by the shot; `time_s` is that since the flight's first frame.
    pub(super) fn shoot(&self, share: f64, time_s: f64, each: &mut dyn FnMut(usize, DVec3)) {
        match &self.beams {
            Beams::Rings { elevations, azimuths_rad: [first, last] } => {
                let (sin, cos) = real::sin_cos(first + share * (last - first));
                for (ring, (up, level)) in elevations.iter().enumerate() {
                    each(ring, DVec3::new(level * cos, level * sin, *up));
                }
            }
            Beams::Beam(angles_rad) => {
                let [azimuth_rad, elevation_rad] = angles_rad(time_s);
                let ((sin, cos), (up, level)) = (real::sin_cos(azimuth_rad), real::sin_cos(elevation_rad));
                each(0, DVec3::new(level * cos, level * sin, up));
            }
        }
    }
}
