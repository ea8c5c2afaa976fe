//! Satellites for receivers: where they stand in the sky of a place.

use crate::geo_origin::GeoOrigin;
use cosfly_frames::{DVec3, real};

/// Number of satellites.
pub const SATELLITES: usize = 24;

/// Planes of the orbits, with four satellites each.
const PLANES: usize = 6;
/// Radius of the orbits, metres.
const RADIUS_M: f64 = 26_559_700.0;
/// Tilt of the orbits against the equator, radians: 55 degrees.
const INCLINATION_RAD: f64 = 0.959_931_088_596_881;
/// Angular velocity along the orbits, rad/s: half a sidereal day a turn.
const ORBIT_RAD_S: f64 = 1.458_423e-4;
/// Angular velocity of the Earth, rad/s.
const EARTH_RAD_S: f64 = 7.292_115e-5;
/// Radius of the Earth, metres; a sphere is enough for directions.
const EARTH_M: f64 = 6_371_000.0;

/// Directions to all satellites from a place, world frame, of length 1, at a time of the day in seconds: those of 24 satellites in six
/// planes at 55 degrees, as GPS has them (a BodyFigure constellation 24/6/1).
pub fn directions_in_world(origin: &GeoOrigin, day_s: f64) -> [DVec3; SATELLITES] {
    let (sin_lat, cos_lat) = real::sin_cos(origin.latitude_deg.to_radians());
    let (sin_lon, cos_lon) = real::sin_cos(origin.longitude_deg.to_radians());
    let up = DVec3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat);
    let east = DVec3::new(-sin_lon, cos_lon, 0.0);
    let north = DVec3::new(-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat);
    let (sin_tilt, cos_tilt) = real::sin_cos(INCLINATION_RAD);
    core::array::from_fn(|number| {
        let (plane, place) = (number % PLANES, number / PLANES);
        let node_rad = real::TAU * plane as f64 / PLANES as f64 - EARTH_RAD_S * day_s;
        let along_rad = real::TAU * (place as f64 / 4.0 + plane as f64 / SATELLITES as f64) + ORBIT_RAD_S * day_s;
        let ((sin_node, cos_node), (sin, cos)) = (real::sin_cos(node_rad), real::sin_cos(along_rad));
        let on_orbit = DVec3::new(
            cos * cos_node - sin * cos_tilt * sin_node,
            cos * sin_node + sin * cos_tilt * cos_node,
            sin * sin_tilt,
        );
        let ray = (RADIUS_M * on_orbit - EARTH_M * up).normalize();
        DVec3::new(ray.dot(east), -ray.dot(north), ray.dot(up))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_open_sky_has_enough_satellites_at_any_time_and_repeats_each_sidereal_day() {
        for latitude_deg in [0.0, 49.0, -60.0] {
            let origin = GeoOrigin { latitude_deg, longitude_deg: 8.0 };
            for hour in 0..48 {
                let day_s = 1800.0 * f64::from(hour);
                let sky = directions_in_world(&origin, day_s);
                assert!(sky.iter().all(|ray| (ray.length() - 1.0).abs() < 1e-12));
                let high = sky.iter().filter(|ray| ray.z > 0.17).count();
                assert!((5..=12).contains(&high), "{latitude_deg} {day_s}: {high}");
                let later = directions_in_world(&origin, day_s + real::TAU / EARTH_RAD_S);
                assert!(sky.iter().zip(later).all(|(a, b)| a.distance(b) < 1e-3));
            }
        }
        // No orbit of 55 degrees comes near the pole's zenith.
        let pole = GeoOrigin { latitude_deg: 89.0, longitude_deg: 0.0 };
        assert!(directions_in_world(&pole, 0.0).iter().all(|ray| ray.z < 0.8));
    }
}
