//! [`Tags`] of an element, cut down to the keys that the reader knows, and what their values say.

/// All keys that are kept, sorted.
const KEYS: &[&str] = &[
    "amenity",
    "area",
    "area:highway",
    "barrier",
    "bridge",
    "building",
    "building:height",
    "building:levels",
    "building:min_height",
    "building:min_level",
    "building:part",
    "covered",
    "crossing",
    "crossing:markings",
    "cycleway",
    "cycleway:both",
    "cycleway:left",
    "cycleway:right",
    "diameter_crown",
    "direction",
    "est_height",
    "foot",
    "footway",
    "height",
    "highway",
    "indoor",
    "junction",
    "landuse",
    "lanes",
    "lanes:backward",
    "lanes:forward",
    "layer",
    "leisure",
    "level",
    "location",
    "man_made",
    "maxheight",
    "maxspeed",
    "min_height",
    "min_level",
    "motorroad",
    "natural",
    "oneway",
    "place",
    "power",
    "public_transport",
    "railway",
    "roof:angle",
    "roof:direction",
    "roof:height",
    "roof:levels",
    "roof:orientation",
    "roof:shape",
    "segregated",
    "service",
    "sidewalk",
    "sidewalk:both",
    "sidewalk:left",
    "sidewalk:right",
    "surface",
    "tunnel",
    "type",
    "waterway",
    "width",
];

/// Highest that is believed of anything, metres.
pub const HIGHEST_M: f64 = 1000.0;
/// Longer values say nothing that is read here, bytes.
const LONGEST_VALUE: usize = 255;

/// Tags of one element, sorted by key.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tags {
    pairs: Vec<(&'static str, Box<str>)>,
    /// Whether a key came again with another value.
    pub has_repeated: bool,
}

impl Tags {
    /// Takes a tag if its key is known; the first of several with one key stays.
    pub fn add(&mut self, key: &str, value: &str) {
        let Ok(known) = KEYS.binary_search(&key) else { return };
        match self.pairs.binary_search_by_key(&KEYS[known], |(key, _)| key) {
            Ok(place) => self.has_repeated |= *self.pairs[place].1 != *value,
            Err(place) if value.len() <= LONGEST_VALUE => self.pairs.insert(place, (KEYS[known], value.into())),
            Err(_) => {}
        }
    }

    /// Whether no known tag is there.
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<&str> {
        debug_assert!(KEYS.contains(&key), "{key}");
        self.pairs.iter().find(|(own, _)| *own == key).map(|(_, value)| &**value)
    }

    /// Whether the value of a key is one of some.
    pub fn is(&self, key: &str, values: &[&str]) -> bool {
        self.get(key).is_some_and(|value| values.contains(&value))
    }

    /// Whether a key is there and its value is not `no`.
    pub fn has(&self, key: &str) -> bool {
        self.get(key).is_some_and(|value| value != "no")
    }

    /// Number under a key.
    pub fn number(&self, key: &str) -> Option<f64> {
        number(self.get(key)?)
    }

    /// Whether the thing lies under the ground or inside a house.
    pub fn is_hidden(&self) -> bool {
        self.is("location", &["underground", "indoor"])
            || self.has("indoor")
            || self
                .get("tunnel")
                .is_some_and(|tunnel| !["no", "building_passage", "avalanche_protector"].contains(&tunnel))
            || self.is_below()
    }

    /// Whether all storeys or layers that are stated lie under the ground.
    pub fn is_below(&self) -> bool {
        ["layer", "level"].iter().any(|key| self.range(key).is_some_and(|(_, highest)| highest < 0.0))
    }

    /// Whether the thing stands or lies on a roof or an upper storey. Ways that people or vehicles take lie on one level, as
    /// bridges and what they carry do, whatever their `level`.
    pub fn is_upstairs(&self) -> bool {
        let is_high = self.range("level").is_some_and(|(lowest, _)| lowest > 0.0);
        let is_way = ["bridge", "highway", "railway"].iter().any(|key| self.has(key));
        self.is("location", &["roof", "rooftop"]) || is_high && !is_way
    }

    /// Whether the thing is neither hidden nor upstairs.
    pub fn is_on_the_ground(&self) -> bool {
        !self.is_hidden() && !self.is_upstairs()
    }

    fn range(&self, key: &str) -> Option<(f64, f64)> {
        range(self.get(key)?)
    }
}

/// Least and greatest number of a list or a range (`0;1`, `-2--1`, `3`); `None` where one is unreadable.
pub fn range(text: &str) -> Option<(f64, f64)> {
    let mut range: Option<(f64, f64)> = None;
    for part in text.split(';') {
        let part = part.trim();
        // A minus behind a digit is a hyphen.
        let hyphen =
            part.bytes().enumerate().skip(1).find(|(at, byte)| *byte == b'-' && part.as_bytes()[at - 1] != b'-');
        let ends = hyphen.map_or((part, part), |(at, _)| (&part[..at], &part[at + 1..]));
        let (first, last) = (number(ends.0)?, number(ends.1)?);
        let (low, high) = range.unwrap_or((first, first));
        range = Some((low.min(first).min(last), high.max(first).max(last)));
    }
    range
}

/// Number of storeys: of a list or a range (`3;4`, `2-3`) the larger one.
pub fn storeys(text: &str) -> Option<f64> {
    text.split([';', '-']).map(number).reduce(|a, b| Some(a?.max(b?)))?
}

/// A decimal number; a comma may stand for the point.
pub fn number(text: &str) -> Option<f64> {
    let text = text.trim();
    let plain = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit() || b"+-.,".contains(&byte));
    let value: f64 = plain.then(|| text.replace(',', ".").parse().ok())??;
    value.is_finite().then_some(value)
}

/// A length as the map's users write it, in metres: `12`, `12.5 m`, `12,5m`, `40'`, `40 ft`, `12'6"`, `0.5 km`; of a list
/// or a range (`12;15`, `12-15`) the larger one.
pub fn length_m(text: &str) -> Option<f64> {
    const FOOT_M: f64 = 0.3048;
    let text = text.trim().trim_start_matches(['~', '<', '>', '≈']).trim();
    if let Some((first, second)) = text.split_once(';').or_else(|| text.split_once('-').filter(|(a, _)| !a.is_empty()))
    {
        return Some(length_m(first)?.max(length_m(second)?));
    }
    if let Some((feet, inches)) = text.split_once(['\'', '′', '’']) {
        let inches = inches.trim().trim_end_matches(['"', '″', '”', '\'', '′', '’']).trim();
        let inches = if inches.is_empty() { 0.0 } else { number(inches)? };
        return Some(FOOT_M * (number(feet.trim())? + inches / 12.0));
    }
    if let Some((feet, inches)) = text.split_once("ft").filter(|(_, inches)| inches.contains("in")) {
        let inches = inches.trim_end_matches(|c: char| !c.is_ascii_digit());
        return Some(FOOT_M * (number(feet.trim())? + number(inches.trim())? / 12.0));
    }
    let split = text.find(|c: char| !(c.is_ascii_digit() || "+-.,".contains(c))).unwrap_or(text.len());
    let (value, unit) = text.split_at(split);
    let metres = match unit.trim().to_lowercase().as_str() {
        "" | "m" | "m." | "meter" | "meters" | "metre" | "metres" | "mtr" => 1.0,
        "ft" | "ft." | "feet" | "foot" => FOOT_M,
        "in" | "inch" | "inches" | "\"" | "″" => FOOT_M / 12.0,
        "cm" => 0.01,
        "km" => 1000.0,
        "yd" | "yard" | "yards" => 3.0 * FOOT_M,
        _ => return None,
    };
    Some(number(value)? * metres)
}

/// A speed limit as the map's users write it, m/s: `50`, `30 mph`, `walk`; the first of several.
pub fn speed_mps(text: &str) -> Option<f64> {
    let first = text.split([';', '|']).next()?.trim();
    if first == "walk" {
        return Some(7.0 / 3.6);
    }
    let (value, unit_mps) = match first.strip_suffix("mph") {
        Some(value) => (value, 0.44704),
        None => (first.trim_end_matches("km/h"), 1.0 / 3.6),
    };
    Some(number(value.trim())? * unit_mps).filter(|limit| (1.0..=100.0).contains(limit))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_read_in_every_unit_in_use() {
        for (text, metres) in [
            ("12", 12.0),
            ("12.5 m", 12.5),
            ("12,5m", 12.5),
            (" 3 metres", 3.0),
            ("40'", 12.192),
            ("40 ft", 12.192),
            ("12'6\"", 3.81),
            ("12′ 6″", 3.81),
            ("12ft 6in", 3.81),
            ("12 ft 6 inches", 3.81),
            ("0.5 km", 500.0),
            ("250 cm", 2.5),
            ("~7", 7.0),
            ("12;15", 15.0),
            ("12-15 m", 15.0),
            ("-2", -2.0),
        ] {
            let read = length_m(text).unwrap_or_else(|| panic!("{text}"));
            assert!((read - metres).abs() < 1e-9, "{text}: {read}");
        }
        for text in ["", "high", "NaN", "inf", "1e9", "3 storeys", "m", "'", "--", "1.2.3"] {
            assert_eq!(length_m(text), None, "{text}");
        }
    }

    #[test]
    fn storeys_are_the_larger_end_of_a_range_or_list() {
        for (text, storeys) in
            [("3", Some(3.0)), ("3.5", Some(3.5)), ("3;4", Some(4.0)), ("2-3", Some(3.0)), ("five", None), ("-1", None)]
        {
            assert_eq!(super::storeys(text), storeys, "{text}");
        }
    }

    #[test]
    fn speed_limits_are_read_in_both_units() {
        for (text, mps) in [("50", 50.0 / 3.6), ("30 mph", 13.4112), ("20km/h", 20.0 / 3.6), ("walk", 7.0 / 3.6)] {
            assert!((speed_mps(text).unwrap() - mps).abs() < 1e-9, "{text}");
        }
        assert!(["none", "signals", "DE:urban", "", "1e9"].iter().all(|text| speed_mps(text).is_none()));
    }

    #[test]
    fn known_tags_are_kept_and_the_first_of_two_stays() {
        assert!(KEYS.is_sorted());
        let mut tags = Tags::default();
        for (key, value) in [("name", "x"), ("height", "3 m"), ("building", "yes"), ("area", "no"), ("height", "3 m")] {
            tags.add(key, value);
        }
        assert!(!tags.has_repeated, "the same again is nothing to speak of");
        tags.add("height", "9");
        assert!(tags.has_repeated);
        assert_eq!((tags.get("height"), tags.get("building")), (Some("3 m"), Some("yes")));
        assert!(tags.has("building") && !tags.has("area") && !tags.has("layer"));
    }

    #[test]
    fn tunnels_and_cellars_are_hidden_and_passages_through_houses_are_not() {
        for (key, value, hidden) in [
            ("tunnel", "yes", true),
            ("tunnel", "building_passage", false),
            ("layer", "-1", true),
            ("layer", "1", false),
            ("level", "-2;-1", true),
            ("level", "-1;0", false),
            ("level", "-2--1", true),
            ("level", "-1-0", false),
            ("level", "G", false),
            ("location", "underground", true),
        ] {
            let mut tags = Tags::default();
            tags.add(key, value);
            assert_eq!(tags.is_hidden(), hidden, "{key}={value}");
        }
    }

    #[test]
    fn what_is_on_a_roof_or_an_upper_storey_is_upstairs_and_a_bridge_is_not() {
        let is_upstairs = |pairs: &[(&str, &str)]| {
            let mut tags = Tags::default();
            pairs.iter().for_each(|(key, value)| tags.add(key, value));
            tags.is_upstairs()
        };
        for value in ["1", "2;3", "1-4", "12"] {
            assert!(is_upstairs(&[("level", value)]), "{value}");
            assert!(!is_upstairs(&[("level", value), ("bridge", "yes")]), "{value}");
            assert!(!is_upstairs(&[("level", value), ("highway", "footway")]), "{value}");
        }
        for value in ["0", "0;1", "-1;3", "0-5", "first", ""] {
            assert!(!is_upstairs(&[("level", value)]), "{value}");
        }
        assert!(is_upstairs(&[("location", "roof")]) && is_upstairs(&[("location", "rooftop")]));
        assert!(!is_upstairs(&[("layer", "1")]) && !is_upstairs(&[("location", "outdoor")]));
    }
}
