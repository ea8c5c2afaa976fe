//! Sensor `satellite_receiver`: position and velocity by the satellites that the town leaves in view.

use crate::constellation::directions_in_world;
use crate::drift::Drift;
use crate::sensor::{Carrier, Quantity, Sensor, SensorMoment};
use cosfly_frames::{DVec2, DVec3};
use cosfly_geometry::SpatialQuery;

/// Sine of the least elevation of a satellite that is used, 10 degrees.
const LEAST_SINE: f64 = 0.173_648_177_666_930_3;
/// Distance within which the town hides satellites, metres.
const HIDING_M: f64 = 2000.0;
/// Wandering error of the distance to a satellite, metres: air, orbit and clock.
const RANGE_DRIFT: Drift = Drift { deviation: 2.5, time_constant_s: 200.0 };
/// White noise of the distance to a satellite, metres.
const RANGE_NOISE_M: f64 = 0.5;
/// White noise of the change of that distance, m/s.
const RATE_NOISE_MPS: f64 = 0.05;
/// Dilution of the horizontal position beyond which there is no fix.
const MOST_DILUTION: f64 = 20.0;
/// Length of a day of the stars, seconds.
const DAY_S: f64 = 86_164.0;

/// A receiver of one frequency.
pub static SENSOR: Sensor = Sensor {
    name: "satellite_receiver",
    doc: "Position and velocity by least squares over the satellites that are 10 degrees high and not behind boxes of the town, of 24 as \
          GPS has them, at a time of day of the flight's own. Distances err by a drift of 2.5 m and noise of 0.5 m; nothing is received \
          by reflections.",
    version: 1,
    carrier: Carrier::Airframe,
    quantities: &[
        Quantity {
            name: "is_fix",
            doc: "1 where four satellites or more give a position, else 0; then the numbers of the position are 0",
        },
        Quantity { name: "satellites", doc: "number of satellites in view" },
        Quantity {
            name: "horizontal_dilution",
            doc: "error of the horizontal position for one of a metre in distances",
        },
        Quantity { name: "vertical_dilution", doc: "error of the height for one of a metre in distances" },
        Quantity { name: "east_m", doc: "position to the east of the world's origin, which is x, metres" },
        Quantity { name: "north_m", doc: "position to the north of the world's origin, which is -y, metres" },
        Quantity { name: "up_m", doc: "height above the world's origin, metres" },
        Quantity { name: "velocity_east_mps", doc: "velocity to the east, m/s" },
        Quantity { name: "velocity_north_mps", doc: "velocity to the north, m/s" },
        Quantity { name: "velocity_up_mps", doc: "velocity up, m/s" },
        Quantity { name: "latitude_deg", doc: "latitude of WGS84, degrees, by the projection that the map states" },
        Quantity { name: "longitude_deg", doc: "longitude of WGS84, degrees" },
    ],
    truths: &[
        Quantity { name: "true_east_m", doc: "`east_m` without errors" },
        Quantity { name: "true_north_m", doc: "`north_m` without errors" },
        Quantity { name: "true_up_m", doc: "`up_m` without errors" },
        Quantity { name: "true_velocity_east_mps", doc: "`velocity_east_mps` without errors" },
        Quantity { name: "true_velocity_north_mps", doc: "`velocity_north_mps` without errors" },
        Quantity { name: "true_velocity_up_mps", doc: "`velocity_up_mps` without errors" },
    ],
    read,
};

fn read(at: &SensorMoment<'_>, values: &mut [f64]) {
    let (position, velocity) = (at.airframe.position_in_world, at.airframe.velocity_in_world);
    let seen = in_view(at);
    let rays: Vec<DVec3> = seen.iter().map(|(_, ray)| *ray).collect();
    values.fill(0.0);
    values[1] = rays.len() as f64;
    values[12..].copy_from_slice([enu(position), enu(velocity)].as_flattened());
    let Some(solution) = Solution::of(&rays).filter(|it| it.dilution().x <= MOST_DILUTION) else { return };
    let (mut range_errors, mut rate_errors) = (vec![], vec![]);
    for (satellite, _) in &seen {
        let [drift_m] = RANGE_DRIFT.at(&at.flight_seed.child("satellite", *satellite as u64), "range", at.time_s);
        let mut noise = at.seed.child("satellite", *satellite as u64).stream("noise");
        range_errors.push(drift_m + noise.normal(0.0, RANGE_NOISE_M));
        rate_errors.push(noise.normal(0.0, RATE_NOISE_MPS));
    }
    let found = position + solution.error(&rays, &range_errors);
    let moving = velocity + solution.error(&rays, &rate_errors);
    let dilution = solution.dilution();
    values[0] = 1.0;
    values[2..4].copy_from_slice(&[dilution.x, dilution.y]);
    values[4..10].copy_from_slice([enu(found), enu(moving)].as_flattened());
    values[10..12].copy_from_slice(&at.origin.degrees_at(found));
}

/// East, north, up of a vector of the world.
fn enu(in_world: DVec3) -> [f64; 3] {
    [in_world.x, -in_world.y, in_world.z]
}

/// Satellites that are high enough and not behind the town, with the directions to them.
pub(crate) fn in_view(at: &SensorMoment<'_>) -> Vec<(usize, DVec3)> {
    let day_s = at.flight_seed.stream("time of day").uniform(0.0, DAY_S) + at.time_s;
    let (sky, from) = (directions_in_world(&at.origin, day_s), at.airframe.position_in_world);
    let is_seen = |ray: &DVec3| ray.z >= LEAST_SINE && at.town.closest_hit(from, *ray, HIDING_M).is_none();
    sky.into_iter().enumerate().filter(|(_, ray)| is_seen(ray)).collect()
}

/// Least squares for position and clock: the inverse of the normal matrix.
struct Solution([[f64; 4]; 4]);

impl Solution {
    /// Solution for the directions to satellites; `None` where they do not fix a position.
    fn of(rays: &[DVec3]) -> Option<Self> {
        if rays.len() < 4 {
            return None;
        }
        let mut rows = [[0.0; 8]; 4];
        for ray in rays {
            let row = row(ray);
            for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
                rows[i][j] += row[i] * row[j];
            }
        }
        (0..4).for_each(|i| rows[i][4 + i] = 1.0);
        // Gauss and Jordan; the matrix is symmetric and not negative, so that its diagonal serves for pivots.
        for pivot in 0..4 {
            let scale = rows[pivot][pivot];
            if scale < 1e-9 {
                return None;
            }
            rows[pivot] = rows[pivot].map(|value| value / scale);
            let own = rows[pivot];
            for (_, row) in rows.iter_mut().enumerate().filter(|(number, _)| *number != pivot) {
                let factor = row[pivot];
                row.iter_mut().zip(own).for_each(|(value, of_pivot)| *value -= factor * of_pivot);
            }
        }
        Some(Self(rows.map(|row| [row[4], row[5], row[6], row[7]])))
    }

    /// Horizontal and vertical dilution.
    fn dilution(&self) -> DVec2 {
        let m = &self.0;
        DVec2::new((m[0][0] + m[1][1]).max(0.0).sqrt(), m[2][2].max(0.0).sqrt())
    }

    /// Error of the position that errors of the distances make.
    fn error(&self, rays: &[DVec3], errors: &[f64]) -> DVec3 {
        let mut sums = [0.0; 4];
        for (ray, error) in rays.iter().zip(errors) {
            sums.iter_mut().zip(row(ray)).for_each(|(sum, value)| *sum += value * error);
        }
        let of = |axis: usize| self.0[axis].iter().zip(sums).map(|(a, b)| a * b).sum::<f64>();
        DVec3::new(of(0), of(1), of(2))
    }
}

/// Change of a distance by that of position and clock.
fn row(ray: &DVec3) -> [f64; 4] {
    [-ray.x, -ray.y, -ray.z, 1.0]
}
