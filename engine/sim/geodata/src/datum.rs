//! [`Datum`]: the ellipsoid of a map's degrees, and the way from degrees of WGS84 to these.

use cosfly_frames::{DVec3, real};

/// Rounds of the search for a latitude; three suffice near the ground.
const ROUNDS: usize = 6;

/// An ellipsoid of rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    /// Half the equator's diameter, metres.
    pub radius_m: f64,
    /// Flattening.
    pub flattening: f64,
}

/// WGS84; GRS80 differs by a tenth of a millimetre.
pub const WGS84: Ellipsoid = Ellipsoid { radius_m: 6_378_137.0, flattening: 1.0 / 298.257_223_563 };
const BESSEL: Ellipsoid = Ellipsoid { radius_m: 6_377_397.155, flattening: 1.0 / 299.152_812_8 };
const AIRY: Ellipsoid = Ellipsoid { radius_m: 6_377_563.396, flattening: 1.0 / 299.324_964_6 };
const INTERNATIONAL: Ellipsoid = Ellipsoid { radius_m: 6_378_388.0, flattening: 1.0 / 297.0 };
const KRASSOWSKY: Ellipsoid = Ellipsoid { radius_m: 6_378_245.0, flattening: 1.0 / 298.3 };

/// Degrees on an ellipsoid that lies askew in WGS84.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Datum {
    /// The ellipsoid.
    pub ellipsoid: Ellipsoid,
    /// From the datum to WGS84: shift in metres, turn in seconds of arc, scale in millionths (position vectors, as in
    /// PROJ's `+towgs84`).
    pub to_wgs84: [f64; 7],
}

impl Datum {
    /// Datum of satellites: WGS84, ETRS89, NAD83, all within a metre of each other.
    pub const SATELLITES: Self = Self { ellipsoid: WGS84, to_wgs84: [0.0; 7] };

    /// By the name of the ellipsoid and of the datum in a PROJ text; none for other names.
    pub fn named(ellipsoid: Option<&str>, datum: Option<&str>) -> Option<Self> {
        let of = |ellipsoid, to_wgs84| Some(Self { ellipsoid, to_wgs84 });
        match (datum, ellipsoid) {
            (Some("WGS84" | "NAD83" | "ETRS89"), _) | (None, None | Some("WGS84" | "GRS80")) => Some(Self::SATELLITES),
            (Some("potsdam"), _) => of(BESSEL, POTSDAM),
            (Some("hermannskogel"), _) => of(BESSEL, HERMANNSKOGEL),
            (Some("OSGB36"), _) => of(AIRY, BRITAIN),
            (None, Some("bessel")) => of(BESSEL, [0.0; 7]),
            (None, Some("airy")) => of(AIRY, [0.0; 7]),
            (None, Some("intl")) => of(INTERNATIONAL, [0.0; 7]),
            (None, Some("krass")) => of(KRASSOWSKY, [0.0; 7]),
            _ => None,
        }
    }

    /// Degrees of this datum (longitude, latitude) of a point on the ground, from its degrees in WGS84.
    pub fn from_wgs84(&self, point_deg: [f64; 2]) -> [f64; 2] {
        if *self == Self::SATELLITES {
            return point_deg;
        }
        let (shift, turn, scale) = self.steps();
        let turned = (WGS84.geocentric(point_deg) - shift) / scale;
        self.ellipsoid.degrees(turned - turn.cross(turned))
    }

    fn steps(&self) -> (DVec3, DVec3, f64) {
        let [x, y, z, about_x, about_y, about_z, millionths] = self.to_wgs84;
        let turn = DVec3::new(about_x, about_y, about_z).map(|seconds| (seconds / 3600.0).to_radians());
        (DVec3::new(x, y, z), turn, 1.0 + 1e-6 * millionths)
    }
}

/// Germany's DHDN: true to about 3 m.
pub const POTSDAM: [f64; 7] = [598.1, 73.7, 418.2, 0.202, 0.045, -2.455, 6.7];
/// Austria's MGI: true to about 1.5 m.
pub const HERMANNSKOGEL: [f64; 7] = [577.326, 90.129, 463.919, 5.137, 1.474, 5.297, 2.4232];
/// Great Britain's OSGB36: true to about 5 m.
pub const BRITAIN: [f64; 7] = [446.448, -125.157, 542.06, 0.15, 0.247, 0.842, -20.489];

impl Ellipsoid {
    /// Square of the eccentricity.
    pub fn eccentricity_squared(&self) -> f64 {
        self.flattening * (2.0 - self.flattening)
    }

    /// Isometric latitude, from the sine of the latitude.
    pub fn isometric(&self, sin_lat: f64) -> f64 {
        let eccentricity = self.eccentricity_squared().sqrt();
        atanh(sin_lat) - eccentricity * atanh(eccentricity * sin_lat)
    }

    fn geocentric(&self, [lon_deg, lat_deg]: [f64; 2]) -> DVec3 {
        let ((sin_lon, cos_lon), (sin_lat, cos_lat)) =
            (real::sin_cos(lon_deg.to_radians()), real::sin_cos(lat_deg.to_radians()));
        let across_m = self.across_m(sin_lat);
        let up_m = (1.0 - self.eccentricity_squared()) * across_m * sin_lat;
        DVec3::new(across_m * cos_lat * cos_lon, across_m * cos_lat * sin_lon, up_m)
    }

    /// Radius of curvature across the meridian, metres.
    fn across_m(&self, sin_lat: f64) -> f64 {
        self.radius_m / (1.0 - self.eccentricity_squared() * sin_lat * sin_lat).sqrt()
    }

    fn degrees(&self, at: DVec3) -> [f64; 2] {
        let plan_m = real::hypot(at.x, at.y);
        let squared = self.eccentricity_squared();
        let mut lat = real::atan2(at.z, plan_m * (1.0 - squared));
        for _ in 0..ROUNDS {
            let sin_lat = real::sin(lat);
            lat = real::atan2(at.z + squared * self.across_m(sin_lat) * sin_lat, plan_m);
        }
        [real::atan2(at.y, at.x).to_degrees(), lat.to_degrees()]
    }
}

/// Inverse hyperbolic tangent.
pub fn atanh(x: f64) -> f64 {
    0.5 * real::ln((1.0 + x) / (1.0 - x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_datums_lie_askew_and_unknown_ones_are_none() {
        let point = [11.5755, 48.1374];
        assert_eq!(Datum::SATELLITES.from_wgs84(point), point);
        for name in ["potsdam", "hermannskogel", "OSGB36"] {
            let [lon, lat] = Datum::named(None, Some(name)).unwrap().from_wgs84(point);
            assert!((0.0005..0.005).contains(&real::hypot(lon - point[0], lat - point[1])), "{name}: {lon} {lat}");
        }
        assert_eq!(Datum::named(Some("nobody"), None), None);
        assert_eq!(Datum::named(Some("bessel"), Some("nobody")), None);
    }
}
