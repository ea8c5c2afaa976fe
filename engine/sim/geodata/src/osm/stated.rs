//! [`Quantity`]: a number that tags state, and the values of it that are believed; [`Doubts`] counts the others.

use super::elements::Elements;
use super::tags::{HIGHEST_M, Tags, length_m, number, range, storeys};
use super::tally::Tally;
use core::fmt::Display;
use std::collections::{BTreeMap, BTreeSet};

/// Characters of a value that a warning shows.
const SHOWN: usize = 40;
/// Range of a quantity of which every number is believed.
pub const EVERY: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
/// Height above the ground of a layer or storey: words in its place count as missing.
const LEVELS: [Quantity; 2] = [level(&["layer"]), level(&["level"])];
/// Keys of elements whose layer is read.
const LAYERED: [&str; 10] = [
    "area:highway",
    "barrier",
    "building",
    "building:part",
    "highway",
    "landuse",
    "leisure",
    "man_made",
    "natural",
    "railway",
];

/// A number under a key.
#[derive(Clone, Copy, Debug)]
pub struct Quantity {
    /// Things that state it.
    pub of: &'static str,
    /// Keys; the first one that is readable counts.
    pub keys: &'static [&'static str],
    /// Number of a value, in the unit of `range`.
    pub read: fn(&str) -> Option<f64>,
    /// Least and greatest number that is believed.
    pub range: [f64; 2],
    /// Kind of the number, and its unit with a space before it.
    pub noun: [&'static str; 2],
    /// Values that say something else in a word of the map's users.
    pub is_word: fn(&str) -> bool,
    /// Replacement of a value that is not believed.
    pub instead: &'static str,
}

impl Quantity {
    /// A length, metres.
    pub const fn length(
        of: &'static str,
        keys: &'static [&'static str],
        range: [f64; 2],
        instead: &'static str,
    ) -> Self {
        Self { of, keys, read: length_m, range, noun: ["length", " m"], is_word: |_| false, instead }
    }

    /// A plain number.
    pub const fn number(
        of: &'static str,
        keys: &'static [&'static str],
        range: [f64; 2],
        instead: &'static str,
    ) -> Self {
        Self { of, keys, read: number, range, noun: ["number", ""], is_word: |_| false, instead }
    }

    /// A number of storeys; of a list or a range the larger one.
    pub const fn storeys(of: &'static str, keys: &'static [&'static str], instead: &'static str) -> Self {
        Self { read: storeys, ..Self::number(of, keys, [0.0, 200.0], instead) }
    }

    fn rule(&self) -> String {
        let ([low, high], [noun, unit]) = (self.range, self.noun);
        if low.is_finite() { format!("{noun} of {low} to {high}{unit}") } else { noun.to_owned() }
    }
}

/// Lower end of a thing that does not begin at the ground: stated, else by its lowest storey.
#[derive(Clone, Copy, Debug)]
pub struct Base {
    stated: Quantity,
    storeys: Quantity,
}

impl Base {
    /// Lower ends of things, such as `buildings`.
    pub const fn of(of: &'static str) -> Self {
        const INSTEAD: &str = "they begin at the ground";
        let stated = Quantity::length(of, &["min_height", "building:min_height"], [0.0, HIGHEST_M], INSTEAD);
        let storeys = Quantity::number(of, &["building:min_level", "min_level"], [0.0, 200.0], INSTEAD);
        Self { stated, storeys }
    }

    /// Lower end that the element `name` states, metres above the ground; `storey_m` is the height of a storey.
    pub fn read_m(&self, tags: &Tags, storey_m: f64, name: impl Display + Copy, doubts: &mut Doubts) -> Option<f64> {
        let stated_m = doubts.read(tags, &self.stated, name);
        if tags.readable(&self.stated).is_some() {
            return stated_m;
        }
        let storeys = doubts.read(tags, &self.storeys, name)?;
        Some(storeys * storey_m).filter(|base_m| *base_m <= HIGHEST_M)
    }

    /// Counts the element `name` for a lower end that is not below its upper end.
    pub fn add_as_too_high(&self, tags: &Tags, name: impl Display + Copy, doubts: &mut Doubts) {
        let is_stated = tags.readable(&self.stated).is_some();
        let quantity = if is_stated { &self.stated } else { &self.storeys };
        doubts.add(tags, &Quantity { range: EVERY, noun: ["height below their upper end", ""], ..*quantity }, name);
    }
}

const fn level(keys: &'static [&'static str]) -> Quantity {
    let lowest = |text: &str| range(text).map(|(low, _)| low);
    Quantity { read: lowest, ..Quantity::number("elements", keys, EVERY, "it counts as missing") }
}

impl Tags {
    /// The first readable number of a quantity, believed or not.
    pub fn readable(&self, quantity: &Quantity) -> Option<f64> {
        quantity.keys.iter().find_map(|key| (quantity.read)(self.get(key)?))
    }

    /// The number of a quantity, if it is believed.
    pub fn stated(&self, quantity: &Quantity) -> Option<f64> {
        let [low, high] = quantity.range;
        self.readable(quantity).filter(|number| (low..=high).contains(number))
    }
}

/// Values that are not believed: how often, of which elements, and the first value.
#[derive(Debug, Default)]
pub struct Doubts(BTreeMap<[&'static str; 4], Doubt>);

#[derive(Debug)]
struct Doubt {
    rule: String,
    value: String,
    tally: Tally,
    names: BTreeSet<String>,
}

impl Doubts {
    /// The number of a quantity that the element `name` states; one that is not believed is counted.
    pub fn read(&mut self, tags: &Tags, quantity: &Quantity, name: impl Display) -> Option<f64> {
        let stated = tags.stated(quantity);
        if stated.is_none() {
            self.add(tags, quantity, name);
        }
        stated
    }

    /// Counts the element `name` for its value of a quantity, once; not one that has none, or a word in its place.
    pub fn add(&mut self, tags: &Tags, quantity: &Quantity, name: impl Display) {
        let values = quantity.keys.iter().filter_map(|key| Some((*key, tags.get(key)?)));
        let Some((key, value)) = values.into_iter().find(|(_, value)| !(quantity.is_word)(value.trim())) else {
            return;
        };
        let doubt = self.0.entry([quantity.of, key, quantity.instead, quantity.noun[0]]).or_insert_with(|| Doubt {
            rule: quantity.rule(),
            value: value.chars().take(SHOWN).collect(),
            tally: Tally::default(),
            names: BTreeSet::new(),
        });
        let name = name.to_string();
        if doubt.names.insert(name.clone()) {
            doubt.tally.add(name);
        }
    }

    /// Counts the elements whose layer or storey is not readable.
    pub fn add_levels(&mut self, elements: &Elements) {
        let mut check = |tags: &Tags, name: core::fmt::Arguments<'_>| {
            if LAYERED.iter().any(|key| tags.has(key)) {
                LEVELS.iter().for_each(|level| _ = self.read(tags, level, name));
            }
        };
        elements.node_tags.iter().for_each(|(id, tags)| check(tags, format_args!("node {id}")));
        elements.ways.iter().for_each(|way| check(&way.tags, format_args!("way {}", way.id)));
        elements.relations.iter().for_each(|it| check(&it.tags, format_args!("relation {}", it.id)));
    }

    /// A line for each quantity: count, rule, the first value, what was taken, the first elements.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        self.0.iter().filter_map(|([of, key, instead, _], doubt)| {
            let Doubt { rule, value, tally, .. } = doubt;
            tally.line(&format!("{of} state a `{key}` that is no {rule}, such as `{value}`; {instead}"))
        })
    }
}
