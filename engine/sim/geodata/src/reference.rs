//! [`GeoReference`]: the projection of a map by its text, and back to degrees.

use crate::projection::TransverseMercator;
use cosfly_frames::DVec2;

/// A transverse Mercator projection with scale and false origin, as UTM and most national grids are.
#[derive(Clone, Debug, PartialEq)]
pub struct GeoReference {
    projection: TransverseMercator,
    middle_deg: [f64; 2],
    scale: f64,
    false_m: DVec2,
}

/// Steps of Newton's method; three suffice within a zone.
const MOST_STEPS: usize = 12;
const NEAR_ENOUGH_M: f64 = 1e-7;
const DIFFERENCE_DEG: f64 = 1e-6;

impl GeoReference {
    /// The projection that a PROJ text, an EPSG code or a URL of one names; none for other kinds. All datums within
    /// a metre of WGS84 (ETRS89, NAD83) count as WGS84.
    pub fn parse(text: &str) -> Option<Self> {
        match text.contains("+proj=") {
            true => Self::of_proj(text),
            false => Self::of_epsg(text),
        }
    }

    fn of_proj(text: &str) -> Option<Self> {
        let value = |key: &str| -> Option<f64> {
            let word = text
                .split_whitespace()
                .find_map(|word| word.strip_prefix('+')?.strip_prefix(key)?.strip_prefix('='))?;
            word.parse().ok().filter(|value: &f64| value.is_finite())
        };
        let has = |word: &str| text.split_whitespace().any(|known| known == word);
        if value("to_meter").is_some_and(|metres| metres != 1.0) || (text.contains("+units=") && !has("+units=m")) {
            return None;
        }
        if has("+proj=utm") {
            return Self::utm(value("zone")?, has("+south"));
        }
        if !has("+proj=tmerc") {
            return None;
        }
        let scale = value("k").or_else(|| value("k_0")).unwrap_or(1.0);
        let middle_deg = [value("lon_0").unwrap_or(0.0), value("lat_0").unwrap_or(0.0)];
        Self::of(middle_deg, scale, DVec2::new(value("x_0").unwrap_or(0.0), value("y_0").unwrap_or(0.0)))
    }

    /// UTM on WGS84 (326xx, 327xx) and ETRS89 (258xx); compound codes with a height, such as 5555 to 5557 of ETRS89.
    fn of_epsg(text: &str) -> Option<Self> {
        let tail = text.trim().rsplit(['/', ':']).next()?;
        let code: u32 = tail.trim().parse().ok()?;
        match code {
            32601..=32660 => Self::utm(f64::from(code - 32600), false),
            32701..=32760 => Self::utm(f64::from(code - 32700), true),
            25828..=25838 => Self::utm(f64::from(code - 25800), false),
            5554..=5556 => Self::utm(f64::from(code - 5554 + 31), false),
            _ => None,
        }
    }

    fn utm(zone: f64, is_south: bool) -> Option<Self> {
        let false_m = DVec2::new(500_000.0, if is_south { 10_000_000.0 } else { 0.0 });
        (zone.fract() == 0.0 && (1.0..=60.0).contains(&zone))
            .then(|| Self::of([6.0 * zone - 183.0, 0.0], 0.9996, false_m))
            .flatten()
    }

    fn of(middle_deg: [f64; 2], scale: f64, false_m: DVec2) -> Option<Self> {
        let is_sound = middle_deg[0].abs() <= 360.0 && middle_deg[1].abs() <= 89.0 && (0.5..2.0).contains(&scale);
        is_sound.then(|| Self { projection: TransverseMercator::about(middle_deg), middle_deg, scale, false_m })
    }

    /// Map position of a point: longitude, latitude, degrees.
    pub fn project(&self, point_deg: [f64; 2]) -> DVec2 {
        self.scale * self.projection.project(point_deg) + self.false_m
    }

    /// Longitude and latitude of a map position, degrees; none far outside the projection.
    pub fn unproject(&self, point_m: DVec2) -> Option<[f64; 2]> {
        let mut guess = DVec2::from_array(self.middle_deg);
        for _ in 0..MOST_STEPS {
            let here = self.project(guess.to_array());
            let missing = point_m - here;
            if !missing.is_finite() {
                return None;
            }
            if missing.length() < NEAR_ENOUGH_M {
                return Some(guess.to_array());
            }
            let along = |step: DVec2| (self.project((guess + step).to_array()) - here) / DIFFERENCE_DEG;
            let (east, north) = (along(DVec2::new(DIFFERENCE_DEG, 0.0)), along(DVec2::new(0.0, DIFFERENCE_DEG)));
            let determinant = east.perp_dot(north);
            let step = DVec2::new(missing.perp_dot(north), east.perp_dot(missing)) / determinant;
            guess += step.clamp(DVec2::splat(-20.0), DVec2::splat(20.0));
        }
        let missed_m = (self.project(guess.to_array()) - point_m).length();
        (missed_m < 1e-3).then(|| guess.to_array())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn utm_agrees_with_proj_and_comes_back() {
        // Munich in zone 32 and Sydney in zone 56 south, as PROJ 9 gives them.
        for (text, point, expected) in [
            ("+proj=utm +zone=32 +datum=WGS84 +units=m", [11.5755, 48.1374], DVec2::new(691_603.03, 5_334_780.03)),
            ("EPSG:25832", [11.5755, 48.1374], DVec2::new(691_603.03, 5_334_780.03)),
            (
                "https://www.opengis.net/def/crs/EPSG/0/32756",
                [151.2093, -33.8688],
                DVec2::new(334_368.63, 6_250_948.35),
            ),
        ] {
            let reference = GeoReference::parse(text).unwrap();
            let found = reference.project(point);
            assert!(found.distance(expected) < 0.02, "{text}: {found}");
            let back = DVec2::from_array(reference.unproject(found).unwrap());
            assert!(back.distance(DVec2::from_array(point)) < 1e-9, "{text}: {back}");
        }
    }

    #[test]
    fn other_projections_and_broken_texts_are_none() {
        for text in [
            "",
            "EPSG:4326",
            "EPSG:28992",
            "+proj=lcc +lat_1=44",
            "+proj=utm",
            "+proj=utm +zone=99",
            "+proj=utm +zone=nan",
            "+proj=tmerc +lat_0=91",
            "+proj=tmerc +k=0",
            "+proj=tmerc +units=us-ft",
            "+proj=utm +zone=32.5",
        ] {
            assert_eq!(GeoReference::parse(text), None, "{text}");
        }
        let local = GeoReference::parse("+proj=tmerc +lat_0=48 +lon_0=11 +k=1 +x_0=0 +y_0=0").unwrap();
        assert_eq!(local.unproject(DVec2::splat(f64::NAN)), None);
        assert_eq!(local.project([11.0, 48.0]), DVec2::ZERO);
    }
}
