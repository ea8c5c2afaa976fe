//! [`ScannedFlight`]: a flight that carries a lidar, scanned sweep by sweep.

use super::bodies::MovingBodies;
use super::echo::{loss_per_m, noise, power, reflectivity};
use super::pattern::LidarPattern;
use super::point::LidarPoint;
use super::scene::LidarScene;
use crate::airframe::Airframe;
use crate::place::SensorPlace;
use crate::smooth_flight::SmoothFlight;
use cosfly_domain::Weather;
use cosfly_figures::FigureInPicture;
use cosfly_frames::{DQuat, DVec3, Pose, RandomStream, Seed};
use std::ops::Range;

/// Deviation of the power of the weakest echo that is heard, as a share of it.
const THRESHOLD_DEVIATION: f64 = 0.1;
/// Longest time in which the limbs of bodies stand still and bodies move evenly, seconds.
const EVEN_S: f64 = 0.01;

/// Most beams of a flight: their points fill 1.4 GB.
pub const MOST_BEAMS: usize = 50_000_000;

/// A flight that carries a lidar on its airframe.
#[derive(Clone, Copy)]
pub struct ScannedFlight<'a> {
    /// Surfaces that rays meet beside bodies.
    pub scene: &'a LidarScene,
    /// Adds the people and vehicles that are there at a time, seconds since the first frame.
    pub bodies: &'a dyn Fn(f64, &mut Vec<FigureInPicture>),
    /// Pose of the drone in each frame.
    pub poses_in_world: &'a [Pose],
    /// Time between frames, seconds.
    pub dt_s: f64,
    /// Where the lidar sits.
    pub place: SensorPlace,
    /// Sweeps a second, which divide the pattern's shots.
    pub rate_hz: f64,
    /// Weather, which takes light away.
    pub weather: &'a Weather,
    /// Seed of the noise.
    pub seed: Seed,
}

/// One sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct LidarSweep {
    /// Frame at the time of the beginning, or the last one before it.
    pub frame: usize,
    /// Time of the beginning since the first frame, seconds.
    pub time_s: f64,
    /// The lidar at the beginning.
    pub sensor: Airframe,
    /// The points, by shot and beam.
    pub points: Vec<LidarPoint>,
}

impl LidarSweep {
    /// Place of the lidar at the beginning, and the quaternion (x, y, z, w) that turns its vectors into the world.
    pub fn pose(&self) -> [f64; 7] {
        let turn = DQuat::from_mat3(&self.sensor.world_from_body);
        let [x, y, z] = self.sensor.position_in_world.to_array();
        let [qx, qy, qz, qw] = (if turn.w < 0.0 { -turn } else { turn }).to_array();
        [x, y, z, qx, qy, qz, qw]
    }
}

/// A lidar on its way.
struct Carried<'a> {
    flight: &'a ScannedFlight<'a>,
    pattern: &'a LidarPattern,
    smooth: SmoothFlight,
    loss_per_m: f64,
    /// Shots of a sweep.
    shots: usize,
}

impl ScannedFlight<'_> {
    /// Number of sweeps that end within the flight.
    pub fn sweeps(&self) -> usize {
        let last_s = self.poses_in_world.len().saturating_sub(1) as f64 * self.dt_s;
        // Half a microsecond keeps the last one where the times meet.
        ((last_s + 5e-7) * self.rate_hz) as usize
    }

    /// Number of beams that are shot.
    pub fn beams(&self, pattern: &LidarPattern) -> usize {
        self.sweeps() * pattern.shots(self.rate_hz).unwrap_or_default() * pattern.beams()
    }

    /// Scans sweep by sweep. Points are in the axes of the lidar at the time of their shot.
    pub fn scan(&self, pattern: &LidarPattern, each: &mut dyn FnMut(LidarSweep)) {
        let Some(shots) = pattern.shots(self.rate_hz).filter(|_| !self.poses_in_world.is_empty()) else { return };
        let smooth = SmoothFlight::new(self.poses_in_world, self.dt_s);
        let carried = Carried { flight: self, pattern, smooth, loss_per_m: loss_per_m(self.weather), shots };
        (0..self.sweeps()).for_each(|number| each(carried.sweep(number)));
    }
}

impl Carried<'_> {
    fn sensor(&self, time_s: f64) -> Airframe {
        let last = (self.flight.poses_in_world.len() - 1) as f64;
        let at = (time_s / self.flight.dt_s).clamp(0.0, last);
        self.smooth.without_turn_acceleration(at).at(&self.flight.place)
    }

    fn sweep(&self, number: usize) -> LidarSweep {
        let time_s = number as f64 / self.flight.rate_hz;
        let mut stream = self.flight.seed.child("sweep", number as u64).stream("lidar");
        let parts = (1.0 / (self.flight.rate_hz * EVEN_S)).ceil().max(1.0) as usize;
        let shots_of_part = self.shots.div_ceil(parts);
        let mut points = Vec::with_capacity(self.shots * self.pattern.beams());
        for first in (0..self.shots).step_by(shots_of_part) {
            let shots = first..(first + shots_of_part).min(self.shots);
            self.scan_part(time_s, shots, &mut stream, &mut points);
        }
        // A microsecond before a frame is that frame.
        let frame = (time_s / self.flight.dt_s + 1e-6) as usize;
        LidarSweep { frame, time_s, sensor: self.sensor(time_s), points }
    }

    /// Adds the points of some shots of the sweep that begins at a time.
    fn scan_part(&self, begins_s: f64, shots: Range<usize>, stream: &mut RandomStream, points: &mut Vec<LidarPoint>) {
        let step_s = 1.0 / f64::from(self.pattern.shots_hz);
        let half_s = 0.5 * shots.len() as f64 * step_s;
        let middle_s = begins_s + shots.start as f64 * step_s + half_s;
        let from = self.sensor(middle_s).position_in_world;
        let bodies = MovingBodies::around(self.flight.bodies, (middle_s, half_s), from, self.pattern.range_m[1]);
        for shot in shots {
            let (after_s, share) = (shot as f64 * step_s, shot as f64 / self.shots as f64);
            let sensor = self.sensor(begins_s + after_s);
            self.pattern.shoot(share, begins_s + after_s, &mut |ring, in_sensor| {
                let from_middle_s = begins_s + after_s - middle_s;
                let Some(mut point) = self.point(&sensor, &bodies, from_middle_s, in_sensor, stream) else { return };
                (point.time_s, point.ring) = (after_s as f32, ring as u16);
                points.push(point);
            });
        }
    }

    /// The echo of a beam, if one is heard.
    fn point(
        &self,
        sensor: &Airframe,
        bodies: &MovingBodies,
        from_middle_s: f64,
        in_sensor: DVec3,
        stream: &mut RandomStream,
    ) -> Option<LidarPoint> {
        let [nearest_m, farthest_m] = self.pattern.range_m;
        let (from, ray) = (sensor.position_in_world, sensor.world_from_body * in_sensor);
        let of_town = self.flight.scene.echo(from, ray, farthest_m);
        let reach_m = of_town.map_or(farthest_m, |echo| echo.distance_m);
        let echo = bodies.echo(from_middle_s, from, ray, reach_m).or(of_town)?;
        let intensity = reflectivity(echo.label) * echo.cosine;
        let heard = 1.0 + THRESHOLD_DEVIATION * noise(stream);
        let is_heard = power(intensity, echo.distance_m, farthest_m, self.loss_per_m) >= heard;
        if echo.distance_m < nearest_m || !is_heard {
            return None;
        }
        let place_m = (echo.distance_m + self.pattern.deviation_m * noise(stream)) * in_sensor;
        Some(LidarPoint {
            place_m: place_m.to_array().map(|value| value as f32),
            intensity: intensity as f32,
            time_s: 0.0,
            ring: 0,
            label: echo.label,
            instance: echo.instance,
        })
    }
}
