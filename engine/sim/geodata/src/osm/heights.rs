//! [`Heights`] of a building or a part of one, from its tags.

use super::options::OsmOptions;
use super::rings::Source;
use super::stated::{Base, Doubts, Quantity};
use super::tags::{HIGHEST_M, Tags, length_m, number};
use cosfly_frames::{DVec2, real};
use cosfly_town::solids::Roof;

/// Lowest building, metres.
const LOWEST_M: f64 = 0.5;
/// Height of small things whose tags state none, metres.
const SMALL_M: f64 = 3.0;
/// Values of `building` that mean something small.
const SMALL: &[&str] = &[
    "garage",
    "garages",
    "shed",
    "carport",
    "hut",
    "kiosk",
    "roof",
    "greenhouse",
    "cabin",
    "container",
    "service",
    "toilets",
];
/// Thickness of a canopy that states no lower edge, metres.
const CANOPY_M: f64 = 0.5;

/// Height of the upper end above the ground.
const HEIGHT: Quantity = Quantity::length(
    "buildings",
    &["height", "building:height", "est_height"],
    [LOWEST_M, HIGHEST_M],
    "it counts as missing",
);
/// Number of storeys, which counts where no height is stated.
const STOREYS: Quantity = Quantity::storeys("buildings", &["building:levels"], "it counts as missing");
/// Lower end.
const BASE: Base = Base::of("buildings");
/// Height of the roof: stated, by storeys, by its slope in degrees.
const ROOF_HEIGHT: Quantity = roof(&["roof:height"], [0.0, HIGHEST_M], ["length", " m"]);
const ROOF_STOREYS: Quantity = roof(&["roof:levels"], [0.0, HIGHEST_M], ["number", ""]);
const ROOF_ANGLE: Quantity = roof(&["roof:angle"], [1.0, 79.99], ["slope", " degrees"]);
/// Bearing towards which a roof slopes, degrees.
const ROOF_DIRECTION: Quantity = Quantity {
    read: bearing_deg,
    noun: ["bearing", " degrees"],
    ..Quantity::number("roofs", &["roof:direction"], [-360.0, 360.0], "their ridge is along the longer side")
};

const fn roof(keys: &'static [&'static str], range: [f64; 2], noun: [&'static str; 2]) -> Quantity {
    let is_length = matches!(noun[0].as_bytes(), b"length");
    let read = if is_length { length_m } else { number };
    let is_word = |text: &str| text == "0";
    Quantity { read, noun, is_word, ..Quantity::number("roofs", keys, range, "it counts as missing") }
}

/// Where a building begins and ends above the ground, metres, and what is not from the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heights {
    /// Lower edge.
    pub base_m: f64,
    /// Upper edge of the walls.
    pub eaves_m: f64,
    /// Roof above the eaves.
    pub roof: Roof,
    /// Whether the height is the default one.
    pub is_default: bool,
    /// Whether the rise of the roof is a guess.
    pub is_rise_guessed: bool,
}

/// Heights from tags. `sides_m` are the longer and the shorter side of the rectangle around the outline, `longer_yaw_rad`
/// is the direction of the longer one. Values that are not believed are counted for `source`.
pub fn heights(
    tags: &Tags,
    (sides_m, longer_yaw_rad): ([f64; 2], f64),
    options: &OsmOptions,
    source: Source,
    doubts: &mut Doubts,
) -> Heights {
    let kind = tags.get("building").or(tags.get("building:part")).unwrap_or_default();
    let within = |height: &f64| (LOWEST_M..=HIGHEST_M).contains(height);
    let stated_m = doubts.read(tags, &HEIGHT, source);
    let storeys = if stated_m.is_none() { doubts.read(tags, &STOREYS, source) } else { None };
    let shape = RoofShape::of(tags.get("roof:shape").unwrap_or_default());
    let stated_rise_m =
        stated_rise_m(tags, sides_m, options, source, doubts).filter(|rise| (0.0..=HIGHEST_M).contains(rise));
    let is_rise_guessed = shape != RoofShape::Flat && stated_rise_m.is_none();
    let usual_rise_m = if shape == RoofShape::Flat { 0.0 } else { (0.35 * sides_m[1]).clamp(1.0, 5.0) };
    let rise_m = stated_rise_m.unwrap_or(usual_rise_m);

    let of_storeys = |levels: f64| levels * options.storey_height_m + rise_m;
    let default_m = || {
        let default_m = options.default_building_height_m;
        if SMALL.contains(&kind) { default_m.min(SMALL_M) } else { default_m }
    };
    let top_m = stated_m.or(storeys.map(of_storeys).filter(within));
    let is_default = top_m.is_none();
    let top_m = top_m.unwrap_or_else(default_m);

    let stated_base_m = BASE.read_m(tags, options.storey_height_m, source, doubts);
    if stated_base_m.is_some_and(|base_m| base_m > top_m - 0.1) {
        BASE.add_as_too_high(tags, source, doubts);
    }
    let canopy_m = (kind == "roof").then_some(top_m - CANOPY_M);
    let base_m = stated_base_m.or(canopy_m).filter(|base| (0.0..=top_m - 0.1).contains(base)).unwrap_or(0.0);
    // A guess leaves most of the height to the walls.
    let most_m = if is_rise_guessed { 0.4 * (top_m - base_m) } else { top_m - base_m };
    let rise_m = rise_m.min(most_m);
    let (eaves_m, roof) = match shape {
        RoofShape::Flat => (top_m, Roof::Flat),
        _ if rise_m <= 0.0 => (top_m, Roof::Flat),
        RoofShape::Gabled => (
            top_m - rise_m,
            Roof::Gabled { rise_m, ridge_yaw_rad: ridge_yaw_rad(tags, longer_yaw_rad, source, doubts) },
        ),
        RoofShape::Hipped => (top_m - rise_m, Roof::Hipped { rise_m }),
    };
    let is_rise_guessed = is_rise_guessed && roof != Roof::Flat;
    Heights { base_m, eaves_m, roof, is_default, is_rise_guessed }
}

/// Shapes of roofs as far as boxes tell them apart. Roofs that bulge beyond planes (domes, mansards) and slanted ones count
/// as flat at their highest point: nothing of them sticks out of the boxes.
#[derive(Clone, Copy, PartialEq)]
enum RoofShape {
    Flat,
    Gabled,
    Hipped,
}

impl RoofShape {
    fn of(name: &str) -> Self {
        match name {
            "gabled" | "half-hipped" => Self::Gabled,
            "hipped" | "pyramidal" | "cone" => Self::Hipped,
            _ => Self::Flat,
        }
    }
}

fn stated_rise_m(
    tags: &Tags,
    sides_m: [f64; 2],
    options: &OsmOptions,
    source: Source,
    doubts: &mut Doubts,
) -> Option<f64> {
    let stated_m = doubts.read(tags, &ROOF_HEIGHT, source);
    if tags.readable(&ROOF_HEIGHT).is_some() {
        return stated_m;
    }
    let storeys = doubts.read(tags, &ROOF_STOREYS, source).filter(|storeys| *storeys > 0.0);
    if let Some(storeys) = storeys {
        return Some(storeys * options.storey_height_m);
    }
    let angle_deg = doubts.read(tags, &ROOF_ANGLE, source)?;
    Some(0.5 * sides_m[1] * real::tan(angle_deg.to_radians()))
}

/// Direction of the ridge in the world (x towards y), where the tags state it.
fn ridge_yaw_rad(tags: &Tags, longer_yaw_rad: f64, source: Source, doubts: &mut Doubts) -> Option<f64> {
    if tags.is("roof:orientation", &["across"]) {
        return Some(longer_yaw_rad + real::FRAC_PI_2);
    }
    // A roof slopes towards its direction, a bearing clockwise from north; the ridge lies across it. x is east, y south.
    let bearing_deg = doubts.read(tags, &ROOF_DIRECTION, source)?;
    Some(real::wrap_angle_rad(bearing_deg.to_radians()))
}

/// A bearing clockwise from north, degrees, of a number or the name of a point of the compass.
pub fn bearing_deg(text: &str) -> Option<f64> {
    const POINTS: [&str; 16] =
        ["N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE", "S", "SSW", "SW", "WSW", "W", "WNW", "NW", "NNW"];
    if let Some(index) = POINTS.iter().position(|point| *point == text) {
        return Some(22.5 * index as f64);
    }
    text.parse().ok().filter(|degrees: &f64| degrees.abs() <= 360.0)
}

/// The longer and the shorter side of the smallest rectangle around an outline, metres, and the direction of the longer.
pub fn rectangle_around(outline: &[DVec2]) -> ([f64; 2], f64) {
    /// Sides whose directions are tried; the longest come first.
    const MOST_SIDES: usize = 16;
    let mut sides: Vec<DVec2> =
        (0..outline.len()).map(|index| outline[(index + 1) % outline.len()] - outline[index]).collect();
    sides.sort_by(|a, b| b.length_squared().total_cmp(&a.length_squared()));
    let sizes = sides.iter().take(MOST_SIDES).filter_map(|side| {
        let along = side.try_normalize()?;
        let range = |axis: DVec2| {
            let (low, high) = outline
                .iter()
                .map(|point| point.dot(axis))
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
            high - low
        };
        Some((DVec2::new(range(along), range(along.perp())), real::atan2(along.y, along.x)))
    });
    let smallest = sizes.min_by(|(a, _), (b, _)| a.element_product().total_cmp(&b.element_product()));
    let (size, yaw_rad) = smallest.unwrap_or_default();
    if size.x >= size.y { (size.to_array(), yaw_rad) } else { ([size.y, size.x], yaw_rad + real::FRAC_PI_2) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(pairs: &[(&str, &str)]) -> Heights {
        told_of(pairs).0
    }

    fn told_of(pairs: &[(&str, &str)]) -> (Heights, Vec<String>) {
        let (mut tags, mut doubts) = (Tags::default(), Doubts::default());
        pairs.iter().for_each(|(key, value)| tags.add(key, value));
        let sides = ([20.0, 10.0], 0.3);
        let found = heights(&tags, sides, &OsmOptions::default(), Source::Way(7), &mut doubts);
        (found, doubts.warnings().collect())
    }

    fn check(pairs: &[(&str, &str)], base_m: f64, eaves_m: f64, roof: Roof) {
        let found = of(pairs);
        assert_eq!((found.base_m, found.eaves_m, found.roof), (base_m, eaves_m, roof), "{pairs:?}");
    }

    #[test]
    fn a_stated_height_counts_with_the_roof_and_storeys_without() {
        check(&[("building", "yes"), ("height", "12 m"), ("building:levels", "9")], 0.0, 12.0, Roof::Flat);
        check(&[("building", "yes"), ("building:levels", "4")], 0.0, 12.0, Roof::Flat);
        let gabled = Roof::Gabled { rise_m: 4.0, ridge_yaw_rad: None };
        let roof = [("roof:shape", "gabled"), ("roof:height", "4")];
        check(&[&roof[..], &[("height", "12")]].concat(), 0.0, 8.0, gabled);
        check(&[&roof[..], &[("building:levels", "2")]].concat(), 0.0, 6.0, gabled);
        check(&[("roof:shape", "hipped"), ("height", "40 ft")], 0.0, 12.192 - 3.5, Roof::Hipped { rise_m: 3.5 });
        assert!(of(&[("roof:shape", "hipped"), ("height", "9")]).is_rise_guessed);
    }

    #[test]
    fn a_building_without_heights_gets_the_default_and_says_so() {
        check(&[("building", "yes")], 0.0, 8.0, Roof::Flat);
        check(&[("building", "garage")], 0.0, 3.0, Roof::Flat);
        check(&[("building", "roof")], 2.5, 3.0, Roof::Flat);
        assert!(of(&[("building", "yes"), ("height", "tall")]).is_default);
        assert!(!of(&[("building", "yes"), ("height", "7")]).is_default);
    }

    #[test]
    fn parts_begin_at_their_lower_edge() {
        check(&[("building:part", "yes"), ("height", "60"), ("min_height", "12,5")], 12.5, 60.0, Roof::Flat);
        check(&[("building:levels", "6"), ("building:min_level", "2")], 6.0, 18.0, Roof::Flat);
        check(&[("building:part", "yes"), ("building:levels", "6"), ("min_level", "2")], 6.0, 18.0, Roof::Flat);
        check(&[("height", "10"), ("min_height", "30")], 0.0, 10.0, Roof::Flat);
    }

    #[test]
    fn heights_that_no_building_has_count_as_unreadable() {
        for value in ["1e23", "99999999999999999999", "-12", "0", "tall", "12 parsecs", "NaN"] {
            let (found, warnings) = told_of(&[("building", "yes"), ("height", value)]);
            assert!(found.is_default && found.eaves_m == 8.0, "{value}: {found:?}");
            let line =
                format!("`height` that is no length of 0.5 to 1000 m, such as `{value}`; it counts as missing (way 7)");
            assert_eq!(warnings, [format!("1 buildings state a {line}")]);
        }
        for (value, metres) in [("12 ft", 3.6576), ("5'6\"", 1.6764), ("1234 cm", 12.34)] {
            let (found, warnings) = told_of(&[("building", "yes"), ("height", value)]);
            assert!(warnings.is_empty() && (found.eaves_m - metres).abs() < 1e-9, "{value}: {found:?}");
        }
    }

    #[test]
    fn other_heights_that_are_not_believed_are_told_of() {
        let building = [("building", "yes"), ("height", "9"), ("roof:shape", "gabled")];
        for (key, value, told) in [
            ("min_height", "-1", "is no length of 0 to 1000 m, such as `-1`; they begin at the ground"),
            ("min_height", "9", "is no height below their upper end, such as `9`; they begin at the ground"),
            ("min_level", "five", "is no number of 0 to 200, such as `five`; they begin at the ground"),
            ("roof:height", "flat", "is no length of 0 to 1000 m, such as `flat`; it counts as missing"),
            ("roof:levels", "-1", "is no number of 0 to 1000, such as `-1`; it counts as missing"),
            ("roof:angle", "90", "is no slope of 1 to 79.99 degrees, such as `90`; it counts as missing"),
            ("roof:direction", "up", "is no bearing of -360 to 360 degrees, such as `up`; their ridge is along"),
        ] {
            let (found, warnings) = told_of(&[&building[..], &[(key, value)]].concat());
            assert_eq!((found.base_m, found.eaves_m), (0.0, 5.5), "{key}={value}");
            assert!(warnings.len() == 1 && warnings[0].contains(&format!("`{key}` that {told}")), "{warnings:?}");
        }
        let (found, warnings) = told_of(&[("building", "yes"), ("building:levels", "three")]);
        assert!(found.is_default && warnings[0].contains("`building:levels` that is no number of 0 to 200"));
        for (key, value) in [("building:levels", "three"), ("roof:levels", "0"), ("roof:angle", "0")] {
            assert!(told_of(&[&building[..], &[(key, value)]].concat()).1.is_empty(), "{key}={value} is not asked for");
        }
    }

    #[test]
    fn ridges_lie_across_the_stated_direction() {
        let yaw =
            |pairs: &[(&str, &str)]| match of(&[&[("roof:shape", "gabled"), ("height", "9")], pairs].concat()).roof {
                Roof::Gabled { ridge_yaw_rad, .. } => ridge_yaw_rad,
                other => panic!("{other:?}"),
            };
        assert_eq!(yaw(&[("roof:direction", "N")]), Some(0.0));
        assert!((yaw(&[("roof:direction", "90")]).unwrap() - real::FRAC_PI_2).abs() < 1e-12);
        assert_eq!(yaw(&[("roof:orientation", "across")]), Some(0.3 + real::FRAC_PI_2));
        assert_eq!(yaw(&[("roof:orientation", "along")]), None);
    }

    #[test]
    fn the_rectangle_around_an_outline_is_the_smallest() {
        let turned = [(0.0, 0.0), (8.0, 6.0), (5.0, 10.0), (-3.0, 4.0)].map(|(x, y)| DVec2::new(x, y));
        let ([longer, shorter], yaw_rad) = rectangle_around(&turned);
        assert!((longer - 10.0).abs() < 1e-9 && (shorter - 5.0).abs() < 1e-9);
        assert!((real::tan(yaw_rad) - 0.75).abs() < 1e-9);
        assert_eq!(rectangle_around(&[]), ([0.0, 0.0], 0.0));
    }
}
