//! [`TransverseMercator`]: degrees on an ellipsoid to metres about a middle.
//!
//! Krüger's series in the third flattening, to the sixth power (Karney 2011, "Transverse Mercator with an accuracy of a few
//! nanometers"). Written here because the crates for projections call the platform's maths library, whose last digits
//! differ between machines.

use crate::datum::{Ellipsoid, WGS84, atanh};
use cosfly_frames::{DVec2, real};

/// A transverse Mercator projection of scale 1 about a point, which is its origin; x east, y north, metres.
///
/// Lengths are true along the middle meridian and too long by 1 part in 81 million x (distance from it in km)²:
/// 3 mm in a kilometre at 15 km.
#[derive(Clone, Debug, PartialEq)]
pub struct TransverseMercator {
    ellipsoid: Ellipsoid,
    middle_deg: [f64; 2],
    middle_northing_m: f64,
}

impl TransverseMercator {
    /// The projection about a point of WGS84: longitude, latitude, degrees.
    pub fn about(middle_deg: [f64; 2]) -> Self {
        Self::on(WGS84, middle_deg)
    }

    /// The projection about a point of an ellipsoid: longitude, latitude, degrees.
    pub fn on(ellipsoid: Ellipsoid, middle_deg: [f64; 2]) -> Self {
        let raw = Self { ellipsoid, middle_deg, middle_northing_m: 0.0 };
        let middle_northing_m = raw.project(middle_deg).y;
        Self { middle_northing_m, ..raw }
    }

    /// The plan position of a point: longitude, latitude, degrees.
    pub fn project(&self, [lon_deg, lat_deg]: [f64; 2]) -> DVec2 {
        let n = self.ellipsoid.flattening / (2.0 - self.ellipsoid.flattening);
        let (sin_lat, (sin_lon, cos_lon)) =
            (real::sin(lat_deg.to_radians()), real::sin_cos((lon_deg - self.middle_deg[0]).to_radians()));
        let conformal = sinh(self.ellipsoid.isometric(sin_lat));
        let along = real::atan2(conformal, cos_lon);
        let across = atanh(sin_lon / real::hypot(1.0, conformal));
        let (mut x, mut y) = (across, along);
        for (index, factor) in series(n).into_iter().enumerate() {
            let times = 2.0 * (index + 1) as f64;
            let (sin, cos) = real::sin_cos(times * along);
            x += factor * cos * sinh(times * across);
            y += factor * sin * cosh(times * across);
        }
        let scale_m =
            self.ellipsoid.radius_m / (1.0 + n) * (1.0 + n.powi(2) / 4.0 + n.powi(4) / 64.0 + n.powi(6) / 256.0);
        DVec2::new(scale_m * x, scale_m * y - self.middle_northing_m)
    }

    /// The projection as PROJ writes it, of WGS84.
    pub fn proj_text(&self) -> String {
        let [lon, lat] = self.middle_deg;
        format!("+proj=tmerc +lat_0={lat} +lon_0={lon} +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m +no_defs")
    }
}

/// Factors of the sines of 2, 4, ... 12 times the conformal latitude.
fn series(n: f64) -> [f64; 6] {
    let sum = |first: i32, factors: &[f64]| {
        factors.iter().enumerate().map(|(index, factor)| factor * n.powi(first + index as i32)).sum()
    };
    [
        sum(1, &[1.0 / 2.0, -2.0 / 3.0, 5.0 / 16.0, 41.0 / 180.0, -127.0 / 288.0, 7891.0 / 37800.0]),
        sum(2, &[13.0 / 48.0, -3.0 / 5.0, 557.0 / 1440.0, 281.0 / 630.0, -1_983_433.0 / 1_935_360.0]),
        sum(3, &[61.0 / 240.0, -103.0 / 140.0, 15061.0 / 26880.0, 167_603.0 / 181_440.0]),
        sum(4, &[49561.0 / 161_280.0, -179.0 / 168.0, 6_601_661.0 / 7_257_600.0]),
        sum(5, &[34729.0 / 80640.0, -3_418_889.0 / 1_995_840.0]),
        sum(6, &[212_378_941.0 / 319_334_400.0]),
    ]
}

fn sinh(x: f64) -> f64 {
    0.5 * (real::exp(x) - real::exp(-x))
}

fn cosh(x: f64) -> f64 {
    0.5 * (real::exp(x) + real::exp(-x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_agree_with_proj() {
        // Middle, point, and what PROJ 9 makes of it with the text of `proj_text`.
        for (middle, point, expected) in [
            ([13.35, 52.5144], [13.3155903, 52.5219129], [-2335.608755, 836.570872]),
            ([7.43, 43.74], [7.5002447, 43.5165358], [5679.607418, -24825.589609]),
            ([103.859, 1.2845], [103.8672734, 1.2990674], [920.755548, 1610.789433]),
            ([-2.1, -57.15], [-2.4, -57.0], [-18231.621747, 16664.152559]),
            ([24.9, 60.17], [25.4, 60.5], [27477.750991, 36872.278546]),
        ] {
            let found = TransverseMercator::about(middle).project(point);
            assert!(found.distance(DVec2::from_array(expected)) < 2e-6, "{point:?}: {found}");
            assert_eq!(TransverseMercator::about(middle).project(middle), DVec2::ZERO);
        }
    }
}
