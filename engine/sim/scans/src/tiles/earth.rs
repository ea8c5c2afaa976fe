//! Places on the Earth: from latitude, longitude and height to the frame that counts from its centre, and back.

use cosfly_frames::{DVec3, real};
use glam::DMat4;

/// Half axes of WGS84: radius at the equator, metres, and square of the eccentricity.
const RADIUS_M: f64 = 6_378_137.0;
const SQUARED: f64 = 0.006_694_379_990_141_316;
/// Steps that find a latitude to less than a millimetre.
const ROUNDS: usize = 6;

/// A place: latitude and longitude, radians, and height above the ellipsoid, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Geodetic {
    pub lat_rad: f64,
    pub lon_rad: f64,
    pub height_m: f64,
}

impl Geodetic {
    /// From degrees and metres.
    pub fn of_degrees([lat_deg, lon_deg, height_m]: [f64; 3]) -> Self {
        Self { lat_rad: lat_deg.to_radians(), lon_rad: lon_deg.to_radians(), height_m }
    }

    /// Latitude and longitude, degrees, and height, metres.
    pub fn degrees(&self) -> [f64; 3] {
        [self.lat_rad.to_degrees(), self.lon_rad.to_degrees(), self.height_m]
    }

    /// The place of a point of the frame that counts from the Earth's centre.
    pub fn of_point(point: DVec3) -> Self {
        let plan_m = real::hypot(point.x, point.y);
        let mut lat_rad = real::atan2(point.z, plan_m * (1.0 - SQUARED));
        for _ in 0..ROUNDS {
            let sin = real::sin(lat_rad);
            lat_rad = real::atan2(point.z + SQUARED * across_m(sin) * sin, plan_m);
        }
        let (sin, cos) = real::sin_cos(lat_rad);
        // Good at the poles, too.
        let height_m = plan_m * cos + point.z * sin - RADIUS_M * (1.0 - SQUARED * sin * sin).sqrt();
        Self { lat_rad, lon_rad: real::atan2(point.y, point.x), height_m }
    }

    /// From a frame here, x to the east, y to the north, z up, to the one that counts from the Earth's centre.
    pub fn earth_from_here(&self) -> DMat4 {
        let ((sin_lat, cos_lat), (sin_lon, cos_lon)) = (real::sin_cos(self.lat_rad), real::sin_cos(self.lon_rad));
        let east = DVec3::new(-sin_lon, cos_lon, 0.0);
        let up = DVec3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat);
        let foot = across_m(sin_lat) * DVec3::new(up.x, up.y, (1.0 - SQUARED) * up.z);
        let origin = foot + self.height_m * up;
        DMat4::from_cols(east.extend(0.0), up.cross(east).extend(0.0), up.extend(0.0), origin.extend(1.0))
    }
}

/// Radius of curvature across the meridian, metres.
fn across_m(sin_lat: f64) -> f64 {
    RADIUS_M / (1.0 - SQUARED * sin_lat * sin_lat).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_points_are_one() {
        for degrees in [[48.2, 16.37, 151.0], [-33.9, -70.6, 0.0], [89.9, 10.0, 1000.0], [0.0, 180.0, -20.0]] {
            let place = Geodetic::of_degrees(degrees);
            let here = place.earth_from_here();
            let found = Geodetic::of_point(here.w_axis.truncate());
            assert!((found.height_m - degrees[2]).abs() < 1e-6, "{found:?}");
            assert!((found.earth_from_here().w_axis - here.w_axis).length() < 1e-6);
            let up = here.inverse().transform_point3((here.w_axis + 7.0 * here.z_axis).truncate());
            assert!(up.abs_diff_eq(7.0 * DVec3::Z, 1e-6));
        }
        // The ends of the ellipsoid's axes.
        let point = |lat_deg| Geodetic::of_degrees([lat_deg, 0.0, 0.0]).earth_from_here().w_axis.truncate();
        assert!(point(0.0).abs_diff_eq(DVec3::X * RADIUS_M, 1e-6) && (point(90.0).z - 6_356_752.314_245).abs() < 1e-5);
    }
}
