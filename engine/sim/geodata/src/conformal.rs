//! [`Conformal`]: the conformal projections of national grids that are not transverse Mercator, about their own origins.

use crate::datum::{Ellipsoid, atanh};
use cosfly_frames::{DVec2, real};

/// A projection of scale 1 from degrees (longitude, latitude) to metres; x east, y north.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Conformal {
    /// Lambert's conic.
    Cone {
        /// Longitude of the middle meridian, degrees.
        lon_deg: f64,
        /// Sine of the cone's opening.
        opening: f64,
        /// Distance from the tip where the isometric latitude is 0, and at the origin, metres.
        reach_m: [f64; 2],
        /// The ellipsoid.
        ellipsoid: Ellipsoid,
    },
    /// Oblique stereographic, by a sphere that touches the ellipsoid.
    Stereographic(Sphere),
    /// Oblique Mercator of Switzerland, by a sphere that touches the ellipsoid.
    Swiss(Sphere),
}

/// Gauss's sphere: conformal to an ellipsoid, true to scale around a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    lon_deg: f64,
    ellipsoid: Ellipsoid,
    radius_m: f64,
    /// Degrees of longitude on the sphere for one on the ellipsoid.
    stretch: f64,
    /// Isometric latitude on the sphere where that on the ellipsoid is 0.
    offset: f64,
    /// Sine and cosine of the point's latitude on the sphere.
    middle: [f64; 2],
}

impl Sphere {
    /// The sphere around a point: longitude, latitude, degrees.
    pub fn around(ellipsoid: Ellipsoid, [lon_deg, lat_deg]: [f64; 2]) -> Self {
        let (sin_lat, cos_lat) = real::sin_cos(lat_deg.to_radians());
        let squared = ellipsoid.eccentricity_squared();
        let stretch = (1.0 + squared * cos_lat.powi(4) / (1.0 - squared)).sqrt();
        let radius_m = ellipsoid.radius_m * (1.0 - squared).sqrt() / (1.0 - squared * sin_lat * sin_lat);
        let sine = sin_lat / stretch;
        let offset = atanh(sine) - stretch * ellipsoid.isometric(sin_lat);
        Self { lon_deg, ellipsoid, radius_m, stretch, offset, middle: [sine, (1.0 - sine * sine).sqrt()] }
    }

    /// A point on the sphere, turned so that the middle is x: towards the middle, east, north.
    fn turned(&self, [lon_deg, lat_deg]: [f64; 2]) -> [f64; 3] {
        let along = self.stretch * self.ellipsoid.isometric(real::sin(lat_deg.to_radians())) + self.offset;
        let (up, down) = (real::exp(along), real::exp(-along));
        let (sine, cosine) = ((up - down) / (up + down), 2.0 / (up + down));
        let (sin_lon, cos_lon) = real::sin_cos(self.stretch * (lon_deg - self.lon_deg).to_radians());
        let [middle_sine, middle_cosine] = self.middle;
        [
            middle_sine * sine + middle_cosine * cosine * cos_lon,
            cosine * sin_lon,
            middle_cosine * sine - middle_sine * cosine * cos_lon,
        ]
    }
}

impl Conformal {
    /// Lambert's conic through an origin, true to scale at one latitude or two.
    pub fn cone(ellipsoid: Ellipsoid, [lon_deg, lat_deg]: [f64; 2], true_lats_deg: [f64; 2]) -> Self {
        let sines = true_lats_deg.map(|lat_deg| real::sin(lat_deg.to_radians()));
        let squared = ellipsoid.eccentricity_squared();
        // Logarithm of the parallel's radius in those of the ellipsoid.
        let logs = sines.map(|sine| 0.5 * real::ln((1.0 - sine * sine) / (1.0 - squared * sine * sine)));
        let along = sines.map(|sine| ellipsoid.isometric(sine));
        let is_one = (true_lats_deg[0] - true_lats_deg[1]).abs() < 1e-9;
        let opening = if is_one { sines[0] } else { (logs[0] - logs[1]) / (along[1] - along[0]) };
        let equator_m = ellipsoid.radius_m * real::exp(logs[0] + opening * along[0]) / opening;
        let origin = ellipsoid.isometric(real::sin(lat_deg.to_radians()));
        let reach_m = [equator_m, equator_m * real::exp(-opening * origin)];
        Self::Cone { lon_deg, opening, reach_m, ellipsoid }
    }

    /// The plan position of a point: longitude, latitude, degrees.
    pub fn project(&self, [lon_deg, lat_deg]: [f64; 2]) -> DVec2 {
        match self {
            Self::Cone { lon_deg: middle_deg, opening, reach_m, ellipsoid } => {
                let along = ellipsoid.isometric(real::sin(lat_deg.to_radians()));
                let from_tip_m = reach_m[0] * real::exp(-opening * along);
                let (sin, cos) = real::sin_cos(opening * (lon_deg - middle_deg).to_radians());
                DVec2::new(from_tip_m * sin, reach_m[1] - from_tip_m * cos)
            }
            Self::Stereographic(sphere) => {
                let [ahead, east, north] = sphere.turned([lon_deg, lat_deg]);
                2.0 * sphere.radius_m / (1.0 + ahead) * DVec2::new(east, north)
            }
            Self::Swiss(sphere) => {
                let [ahead, east, north] = sphere.turned([lon_deg, lat_deg]);
                sphere.radius_m * DVec2::new(real::atan2(east, ahead), atanh(north))
            }
        }
    }
}
