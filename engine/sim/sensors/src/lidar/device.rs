//! [`Lidar`]: devices by the figures of their data sheets.

use super::pattern::{Beams, LidarPattern};
use cosfly_frames::real;

/// A device.
#[derive(Debug)]
pub struct Lidar {
    /// Name in recipes and of the table.
    pub name: &'static str,
    /// Meaning with its figures, a sentence.
    pub doc: &'static str,
    /// Raised whenever the points change.
    pub version: u32,
    /// Sweeps a second: least, usual, most.
    pub rates_hz: [f64; 3],
    /// Shots a second; the beams of a shot are fired together.
    shots_hz: u32,
    /// Distances of the nearest echo, and of the farthest one from a surface that reflects 80 %, metres.
    range_m: [f64; 2],
    /// Standard deviation of a distance, metres.
    deviation_m: f64,
    beams: DeviceBeams,
}

/// Directions of a device's beams.
#[derive(Debug)]
enum DeviceBeams {
    /// Number of rings, and the elevation of each, degrees, from below.
    Rings(usize, fn(f64) -> f64),
    /// Azimuth to the right and elevation of a single beam at a time, seconds; radians.
    Beam(fn(f64) -> [f64; 2]),
}

impl Lidar {
    /// Shots, directions and ranges.
    pub fn pattern(&self) -> LidarPattern {
        let beams = match self.beams {
            DeviceBeams::Rings(count, elevation_deg) => {
                let elevations_deg: Vec<f64> = (0..count).map(|ring| elevation_deg(ring as f64)).collect();
                Beams::rings(&elevations_deg, [0.0, 360.0])
            }
            DeviceBeams::Beam(angles_rad) => Beams::Beam(angles_rad),
        };
        let Self { shots_hz, range_m, deviation_m, .. } = *self;
        LidarPattern { shots_hz, range_m, deviation_m, beams }
    }
}

/// All devices, sorted by name.
pub static LIDARS: &[&Lidar] = &[&HDL32E, &HDL64E, &MID360, &MID40, &OS1_64, &VLP16];

/// The device called `name`.
pub fn lidar(name: &str) -> Option<&'static Lidar> {
    LIDARS.iter().copied().find(|lidar| lidar.name == name)
}

static HDL32E: Lidar = Lidar {
    name: "hdl32e",
    doc: "Velodyne HDL-32E: 32 rings from 30.67 degrees below to 10.67 above, 694,400 shots a second, 100 m, 2 cm.",
    version: 1,
    rates_hz: [5.0, 10.0, 20.0],
    shots_hz: 21_700,
    range_m: [1.0, 100.0],
    deviation_m: 0.02,
    beams: DeviceBeams::Rings(32, |ring| (4.0 * ring - 92.0) / 3.0),
};

static HDL64E: Lidar = Lidar {
    name: "hdl64e",
    doc: "Velodyne HDL-64E S2: 64 rings from 24.33 degrees below to 2 above, dense in the upper half, 1,331,200 shots a second, 120 m, 2 cm.",
    version: 2,
    rates_hz: [5.0, 10.0, 20.0],
    shots_hz: 20_800,
    range_m: [1.0, 120.0],
    deviation_m: 0.02,
    beams: DeviceBeams::Rings(64, |ring| if ring < 32.0 { 0.5 * ring - 73.0 / 3.0 } else { (ring - 57.0) / 3.0 }),
};

static MID360: Lidar = Lidar {
    name: "mid360",
    doc: "Livox Mid-360: one beam all around, from 7 degrees below to 52 above, 200,000 shots a second, 70 m, 2 cm; \
          the paths of its mirror are a model that repeats after 10 s.",
    version: 1,
    rates_hz: [1.0, 10.0, 100.0],
    shots_hz: 200_000,
    range_m: [0.1, 70.0],
    deviation_m: 0.02,
    beams: DeviceBeams::Beam(|time_s| {
        let [around, along] = [97.3, 1873.7].map(|turns_hz: f64| real::TAU * (turns_hz * time_s).fract());
        [around, (22.5 + 29.5 * real::sin(along)).to_radians()]
    }),
};

static MID40: Lidar = Lidar {
    name: "mid40",
    doc: "Livox Mid-40: one beam through two prisms that turn at 7,294 and -4,664 rounds a minute, a rosette of 38.4 degrees that \
          does not repeat, 100,000 shots a second, 260 m, 2 cm.",
    version: 1,
    rates_hz: [1.0, 10.0, 100.0],
    shots_hz: 100_000,
    range_m: [1.0, 260.0],
    deviation_m: 0.02,
    beams: DeviceBeams::Beam(|time_s| {
        let arm_rad = 0.25 * 38.4_f64.to_radians();
        let [first, second] =
            [7294.0, -4664.0].map(|rounds: f64| real::sin_cos(real::TAU * (rounds / 60.0 * time_s).fract()));
        [arm_rad * (first.1 + second.1), arm_rad * (first.0 + second.0)]
    }),
};

static OS1_64: Lidar = Lidar {
    name: "os1_64",
    doc: "Ouster OS1-64, revision C: 64 even rings from 22.5 degrees below to 22.5 above, 1,310,720 shots a second, 120 m, 2 cm.",
    version: 1,
    rates_hz: [10.0, 10.0, 20.0],
    shots_hz: 20_480,
    range_m: [0.3, 120.0],
    deviation_m: 0.02,
    beams: DeviceBeams::Rings(64, |ring| 45.0 / 63.0 * ring - 22.5),
};

static VLP16: Lidar = Lidar {
    name: "vlp16",
    doc: "Velodyne VLP-16: 16 rings from 15 degrees below to 15 above, 289,280 shots a second, 100 m, 3 cm.",
    version: 1,
    rates_hz: [5.0, 10.0, 20.0],
    shots_hz: 18_080,
    range_m: [0.5, 100.0],
    deviation_m: 0.03,
    beams: DeviceBeams::Rings(16, |ring| 2.0 * ring - 15.0),
};
