//! [`GeoOrigin`]: where a town lies on the globe.

use cosfly_domain::MapOrigin;
use cosfly_frames::{DVec3, real};

/// Equatorial radius of WGS84, metres.
const RADIUS_M: f64 = 6_378_137.0;
/// Square of the first eccentricity of WGS84.
const ECCENTRICITY_SQUARE: f64 = 6.694_379_990_141_316e-3;
/// Distance of the world's origin from the projection's that a plane may bridge, metres.
const PLANE_M: f64 = 100_000.0;

/// Latitude and longitude of the world's origin, degrees; its height is 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GeoOrigin {
    /// Degrees, positive to the north.
    pub latitude_deg: f64,
    /// Degrees, positive to the east.
    pub longitude_deg: f64,
}

impl GeoOrigin {
    /// The origin of a map: `lat_0` and `lon_0` of its projection and the world's offset from there. Maps that state neither, and those
    /// whose world begins more than 100 km from there, lie at latitude 0 and longitude 0.
    pub fn of(origin: &MapOrigin) -> Self {
        let text = origin.geo_reference.as_deref().unwrap_or_default();
        let number = |key: &str| {
            let word = text.split_whitespace().find_map(|word| word.strip_prefix(key))?;
            word.parse::<f64>().ok().filter(|degrees| degrees.abs() <= 180.0)
        };
        let (Some(latitude_deg), Some(longitude_deg)) = (number("+lat_0="), number("+lon_0=")) else {
            return Self::default();
        };
        if latitude_deg.abs() > 89.0 || origin.offset_m.truncate().length() > PLANE_M {
            return Self::default();
        }
        let [latitude_deg, longitude_deg] = Self { latitude_deg, longitude_deg }.degrees_at(origin.offset_m);
        Self { latitude_deg, longitude_deg }
    }

    /// Latitude and longitude of a point of the world, degrees, on the plane that touches the ellipsoid at the origin.
    pub fn degrees_at(&self, point_in_world: DVec3) -> [f64; 2] {
        let (sin, cos) = real::sin_cos(self.latitude_deg.to_radians());
        let bend = 1.0 - ECCENTRICITY_SQUARE * sin * sin;
        let across_m = RADIUS_M / bend.sqrt();
        let along_m = across_m * (1.0 - ECCENTRICITY_SQUARE) / bend;
        let (north_m, east_m) = (-point_in_world.y, point_in_world.x);
        [
            self.latitude_deg + (north_m / along_m).to_degrees(),
            self.longitude_deg + (east_m / (across_m * cos)).to_degrees(),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_origin_is_that_of_the_projection_and_north_is_against_y() {
        let of = |text: &str, offset_m: DVec3| {
            GeoOrigin::of(&MapOrigin { offset_m, geo_reference: Some(text.into()), ..MapOrigin::default() })
        };
        let carla = of("+proj=tmerc +lat_0=4.9e+1 +lon_0=8 +k=1", DVec3::ZERO);
        assert_eq!(carla, GeoOrigin { latitude_deg: 49.0, longitude_deg: 8.0 });
        // A degree of latitude at 49 degrees has 111,210 m on WGS84, one of longitude 73,172 m.
        let [latitude, longitude] = carla.degrees_at(DVec3::new(731.72, -1112.1, 5.0));
        assert!((latitude - 49.01).abs() < 1e-6 && (longitude - 8.01).abs() < 1e-6, "{latitude} {longitude}");
        for (text, offset_m) in [
            ("", DVec3::ZERO),
            ("+proj=utm +zone=32", DVec3::ZERO),
            ("+lat_0=nan +lon_0=1", DVec3::ZERO),
            ("+lat_0=49 +lon_0=8", DVec3::new(500_000.0, 0.0, 0.0)),
        ] {
            assert_eq!(of(text, offset_m), GeoOrigin::default(), "{text}");
        }
    }
}
