//! [`GeoReference`]: the projection of a map by its text, and back to degrees.

use crate::conformal::{Conformal, Sphere};
use crate::datum::Datum;
use crate::epsg;
use crate::projection::TransverseMercator;
use cosfly_diagnose::plausible;
use cosfly_frames::DVec2;

/// A projection with scale, false origin and datum, as UTM and national grids are.
#[derive(Clone, Debug, PartialEq)]
pub struct GeoReference {
    // Boxed: a reference is a part of small values.
    projection: Box<Projection>,
    datum: Box<Datum>,
    /// A point in the middle of the projection's use: longitude, latitude, degrees.
    middle_deg: [f64; 2],
    scale: f64,
    false_m: DVec2,
}

#[derive(Clone, Debug, PartialEq)]
enum Projection {
    TransverseMercator(TransverseMercator),
    Conformal(Conformal),
}

/// Steps of Newton's method; three suffice within a zone.
const MOST_STEPS: usize = 12;
const NEAR_ENOUGH_M: f64 = 1e-7;
const DIFFERENCE_DEG: f64 = 1e-6;

/// Keys of a PROJ text that are read, or that change no position in plan.
const READ: [&str; 24] = [
    "proj",
    "init",
    "zone",
    "north",
    "south",
    "k",
    "k_0",
    "lon_0",
    "lat_0",
    "x_0",
    "y_0",
    "lat_1",
    "lat_2",
    "ellps",
    "datum",
    "towgs84",
    "no_defs",
    "type",
    "wktext",
    "over",
    "title",
    "approx",
    "geoidgrids",
    "geoid_crs",
];
/// Keys of which only some values are read.
const USUAL: [(&str, &[&str]); 7] = [
    ("units", &["m"]),
    ("to_meter", &["1", "1.0"]),
    ("axis", &["enu"]),
    ("pm", &["greenwich", "0"]),
    ("nadgrids", &["@null"]),
    ("vunits", &["m"]),
    ("vto_meter", &["1", "1.0"]),
];
/// Keys that say what a file's numbers are.
const OF_NUMBERS: [&str; 3] = ["units", "to_meter", "axis"];

/// Words and values of a PROJ text.
#[derive(Clone, Copy)]
struct Words<'a>(&'a str);

impl<'a> Words<'a> {
    /// Whether a text is one of PROJ.
    fn of(text: &'a str) -> Option<Self> {
        let words = Self(text);
        (words.text("proj").is_some() || words.text("init").is_some()).then_some(words)
    }

    /// Keys and values; flags have an empty value.
    fn all(&self) -> impl Iterator<Item = (&'a str, &'a str)> + use<'a> {
        let words = self.0.split_whitespace().map(|word| word.strip_prefix('+').unwrap_or(word));
        words.map(|word| word.split_once('=').unwrap_or((word, "")))
    }

    fn text(&self, key: &str) -> Option<&'a str> {
        self.all().find(|(own, _)| *own == key).map(|(_, value)| value)
    }

    /// A number; `otherwise` where the text has none, none where it is no number.
    fn number(&self, key: &str, otherwise: f64) -> Option<f64> {
        match self.text(key) {
            Some(text) => text.parse().ok().filter(|value: &f64| plausible(*value).is_ok()),
            None => Some(otherwise),
        }
    }

    /// The first word that is not read, or that contradicts one before it.
    fn unread(&self) -> Option<(&'a str, &'a str)> {
        let is_read = |key: &str, value: &str| match USUAL.iter().find(|(own, _)| *own == key) {
            Some((_, values)) => values.contains(&value),
            None => READ.contains(&key),
        };
        self.all().find(|(key, value)| !is_read(key, value) || self.text(key) != Some(value))
    }

    fn datum(&self) -> Option<Datum> {
        let mut datum = Datum::named(self.text("ellps"), self.text("datum"))?;
        if let Some(shift) = self.text("towgs84") {
            let values: Vec<f64> = shift.split(',').map(|value| value.parse().ok()).collect::<Option<_>>()?;
            let is_sound = matches!(values.len(), 3 | 7) && values.iter().all(|value| value.abs() < 5000.0);
            if !is_sound {
                return None;
            }
            datum.to_wgs84 = [0.0; 7];
            datum.to_wgs84[..values.len()].copy_from_slice(&values);
        }
        Some(datum)
    }
}

/// Words of a PROJ text by which coordinates are no metres to the east and to the north; none in other texts.
pub fn unusual_words(text: &str) -> Option<String> {
    let words = Words::of(text)?;
    let is_usual = |key: &str, value: &str| USUAL.iter().any(|(own, values)| *own == key && values.contains(&value));
    let odd = words.all().filter(|(key, value)| OF_NUMBERS.contains(key) && !is_usual(key, value));
    let odd: Vec<String> = odd.map(|(key, value)| format!("+{key}={value}")).collect();
    (!odd.is_empty()).then(|| odd.join(" "))
}

impl GeoReference {
    /// The projection that a PROJ text, an EPSG code, a URL of one or well-known text with one names; none for other kinds.
    /// Datums within a metre of WGS84 (ETRS89, NAD83) count as WGS84.
    pub fn parse(text: &str) -> Option<Self> {
        match Words::of(text) {
            Some(words) if words.unread().is_some() => None,
            Some(words) => match words.text("init") {
                Some(code) => Self::of_code(code),
                None => Self::of_proj(words),
            },
            None => Self::of_code(text),
        }
    }

    /// Why [`Self::parse`] knows no projection of a text, as the end of a sentence.
    pub fn why_unknown(text: &str) -> String {
        let shown = |text: &str| text.trim().chars().take(80).collect::<String>();
        match Words::of(text) {
            Some(words) => match (words.unread(), words.text("proj")) {
                (Some((key, value)), _) if words.text(key) != Some(value) => {
                    format!("`+{}` has two values", shown(key))
                }
                (Some((key, "")), _) => format!("`+{}` is not read", shown(key)),
                (Some((key, value)), _) => format!("`+{}` is not read", shown(&format!("{key}={value}"))),
                (None, Some(name)) => format!("`+proj={}` with these numbers is not read", shown(name)),
                (None, None) => format!("the code of `{}` is not in the list of known grids", shown(text)),
            },
            None => match epsg::code(text) {
                Some(code) => format!("the code {code} is not in the list of known grids"),
                None => "it has no code of EPSG".to_owned(),
            },
        }
    }

    fn of_code(text: &str) -> Option<Self> {
        Self::of_proj(Words(&epsg::proj_text(epsg::code(text)?)?))
    }

    fn of_proj(words: Words<'_>) -> Option<Self> {
        let datum = words.datum()?;
        if words.text("proj") == Some("utm") {
            return Self::utm(datum, words.text("zone")?.parse().ok()?, words.text("south").is_some());
        }
        let scale = words.number(if words.text("k").is_some() { "k" } else { "k_0" }, 1.0)?;
        let origin_deg = [words.number("lon_0", 0.0)?, words.number("lat_0", 0.0)?];
        let false_m = DVec2::new(words.number("x_0", 0.0)?, words.number("y_0", 0.0)?);
        let is_below = |most_deg: f64| origin_deg[1].abs() <= most_deg;
        let (projection, middle_deg) = match words.text("proj")? {
            "tmerc" | "etmerc" if is_below(89.0) => {
                (Projection::TransverseMercator(TransverseMercator::on(datum.ellipsoid, origin_deg)), origin_deg)
            }
            "sterea" if is_below(89.0) => (
                Projection::Conformal(Conformal::Stereographic(Sphere::around(datum.ellipsoid, origin_deg))),
                origin_deg,
            ),
            "somerc" if is_below(80.0) => {
                (Projection::Conformal(Conformal::Swiss(Sphere::around(datum.ellipsoid, origin_deg))), origin_deg)
            }
            "lcc" if is_below(90.0) => {
                let first = words.number("lat_1", origin_deg[1])?;
                let lats_deg = [first, words.number("lat_2", first)?];
                let middle = 0.5 * (lats_deg[0] + lats_deg[1]);
                let is_cone = lats_deg.iter().all(|lat| (1.0..=89.0).contains(&(lat * middle.signum())));
                let cone = is_cone.then(|| Conformal::cone(datum.ellipsoid, origin_deg, lats_deg))?;
                (Projection::Conformal(cone), [origin_deg[0], middle])
            }
            _ => return None,
        };
        let (projection, datum) = (Box::new(projection), Box::new(datum));
        Self { projection, datum, middle_deg, scale, false_m }.checked()
    }

    fn utm(datum: Datum, zone: f64, is_south: bool) -> Option<Self> {
        let false_m = DVec2::new(500_000.0, if is_south { 10_000_000.0 } else { 0.0 });
        let middle_deg = [6.0 * zone - 183.0, 0.0];
        let projection = Projection::TransverseMercator(TransverseMercator::on(datum.ellipsoid, middle_deg));
        let (projection, datum) = (Box::new(projection), Box::new(datum));
        let is_zone = zone.fract() == 0.0 && (1.0..=60.0).contains(&zone);
        is_zone.then_some(Self { projection, datum, middle_deg, scale: 0.9996, false_m })
    }

    fn checked(self) -> Option<Self> {
        let is_sound = self.middle_deg[0].abs() <= 360.0 && (0.5..2.0).contains(&self.scale);
        (is_sound && self.project(self.middle_deg).is_finite()).then_some(self)
    }

    /// Map position of a point: longitude, latitude, degrees.
    pub fn project(&self, point_deg: [f64; 2]) -> DVec2 {
        let own_deg = self.datum.from_wgs84(point_deg);
        let plan_m = match &*self.projection {
            Projection::TransverseMercator(projection) => projection.project(own_deg),
            Projection::Conformal(projection) => projection.project(own_deg),
        };
        self.scale * plan_m + self.false_m
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
    fn national_grids_agree_with_proj_and_come_back() {
        // As PROJ 9 gives them for degrees of WGS84, with the same shifts between datums.
        for (text, point, expected) in [
            ("EPSG:28992", [5.1214, 52.0907], DVec2::new(136783.726, 455860.140)),
            ("EPSG:2056", [8.5417, 47.3769], DVec2::new(2683303.894, 1247925.628)),
            ("EPSG:21781", [6.1432, 46.2044], DVec2::new(500016.016, 117821.070)),
            ("EPSG:31466", [6.9603, 50.9375], DVec2::new(2567542.816, 5645133.261)),
            ("EPSG:31468", [11.5755, 48.1374], DVec2::new(4468513.486, 5333350.268)),
            ("EPSG:31256", [16.3738, 48.2082], DVec2::new(3096.804, 341089.370)),
            ("EPSG:27700", [-0.1276, 51.5072], DVec2::new(530043.195, 180358.209)),
            ("EPSG:2154", [2.3522, 48.8566], DVec2::new(652469.023, 6862035.259)),
            ("EPSG:31370", [4.3517, 50.8466], DVec2::new(148799.080, 170688.564)),
            ("EPSG:2193", [174.7633, -36.8485], DVec2::new(1757209.253, 5920482.809)),
            ("EPSG:3414", [103.8198, 1.3521], DVec2::new(26495.535, 37133.868)),
            ("EPSG:5973", [10.7522, 59.9139], DVec2::new(262560.482, 6649443.584)),
            ("EPSG:7856", [151.2093, -33.8688], DVec2::new(334368.634, 6250948.345)),
            (
                "+proj=lcc +lat_1=-30 +lat_0=-30 +lon_0=25 +k_0=0.999 +x_0=10 +y_0=20 +datum=WGS84",
                [25.5, -30.5],
                DVec2::new(47963.132, -55458.225),
            ),
        ] {
            let reference = GeoReference::parse(text).unwrap_or_else(|| panic!("{text}"));
            let found = reference.project(point);
            assert!(found.distance(expected) < 0.01, "{text}: {found}");
            let back = DVec2::from_array(reference.unproject(found).unwrap());
            assert!(back.distance(DVec2::from_array(point)) < 1e-9, "{text}: {back}");
        }
    }

    #[test]
    fn other_projections_and_broken_texts_are_none() {
        for text in [
            "",
            "EPSG:4326",
            "EPSG:3857",
            "EPSG:3035",
            "+proj=lcc +lat_1=0",
            "+proj=lcc +lat_1=44 +lat_2=-44",
            "+proj=laea +lat_0=52",
            "+proj=tmerc +pm=paris",
            "+proj=tmerc +nadgrids=x.gsb",
            "+proj=tmerc +ellps=nobody",
            "+proj=tmerc +towgs84=1,2",
            "+proj=utm",
            "+proj=utm +zone=99",
            "+proj=utm +zone=nan",
            "+proj=tmerc +lat_0=91",
            "+proj=tmerc +k=0",
            "+proj=tmerc +units=us-ft",
            "+proj=utm +zone=32.5",
            "+proj=utm +zone=32 +a=6377397 +rf=299",
            "+proj=tmerc +lon_0=9 +lon_0=12",
            "+proj=tmerc +x_0=1e23",
        ] {
            assert_eq!(GeoReference::parse(text), None, "{text}");
        }
        for (text, why) in [
            ("+proj=tmerc +units=us-ft", "`+units=us-ft` is not read"),
            ("+proj=tmerc +lon_0=9 +lon_0=12", "`+lon_0` has two values"),
            ("+proj=laea +lat_0=52", "`+proj=laea`"),
            ("EPSG:3857", "3857 is not in the list"),
            ("Lambert", "no code"),
        ] {
            assert!(GeoReference::why_unknown(text).contains(why), "{text}: {}", GeoReference::why_unknown(text));
        }
        assert_eq!(
            unusual_words("+proj=utm +zone=33 +units=us-ft +axis=neu").as_deref(),
            Some("+units=us-ft +axis=neu")
        );
        assert_eq!(unusual_words("+proj=utm +zone=33 +units=m +vunits=m +geoidgrids=egm96_15.gtx"), None);
        for same in ["+init=epsg:25833", "proj=utm zone=33 ellps=GRS80", "+proj=utm +zone=33 +units=m +geoidgrids=x"] {
            assert_eq!(GeoReference::parse(same), GeoReference::parse("EPSG:25833"), "{same}");
        }
        let local = GeoReference::parse("+proj=tmerc +lat_0=48 +lon_0=11 +k=1 +x_0=0 +y_0=0").unwrap();
        assert_eq!(local.unproject(DVec2::splat(f64::NAN)), None);
        assert_eq!(local.project([11.0, 48.0]), DVec2::ZERO);
    }
}
