//! A kind of place: its name, the numbers that it takes, and the function that builds it.

use crate::net::write::write_opendrive;
use crate::prune::prune;
use crate::site::Site;
use cosfly_frames::Seed;
use std::collections::BTreeMap;

/// A kind of place.
pub struct PlaceKind {
    /// Its name in files and commands.
    pub name: &'static str,
    /// Description, in a line.
    pub doc: &'static str,
    /// The numbers that it takes.
    pub keys: &'static [Key],
    /// Builds it.
    pub build: fn(&PlaceSettings, Seed) -> Site,
}

/// A number that a kind takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Its name.
    pub name: &'static str,
    /// Description, in a line, with its unit.
    pub doc: &'static str,
    /// Smallest and largest value.
    pub range: [f64; 2],
    /// The value where none is given.
    pub default: f64,
}

/// Values of all keys of a kind, each within its range.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaceSettings(BTreeMap<&'static str, f64>);

impl PlaceSettings {
    /// The value of a key of the kind.
    pub fn get(&self, key: &str) -> f64 {
        self.0.get(key).copied().unwrap_or_default()
    }
}

/// A refused number, with what is allowed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RefusedSetting {
    /// Fault, in words.
    pub message: String,
    /// Allowed values.
    pub hint: String,
}

impl PlaceKind {
    /// The values that the kind is built with.
    ///
    /// # Errors
    /// A key that the kind does not have, or a value out of its range.
    pub fn settings(&self, given: &BTreeMap<String, f64>) -> Result<PlaceSettings, RefusedSetting> {
        let mut values: BTreeMap<&'static str, f64> = self.keys.iter().map(|key| (key.name, key.default)).collect();
        for (name, value) in given {
            let Some(key) = self.keys.iter().find(|key| key.name == name) else {
                let names: Vec<String> = self.keys.iter().map(|key| format!("`{}`", key.name)).collect();
                let message = format!("`town.{name}` is no key of the place `{}`", self.name);
                return Err(RefusedSetting { message, hint: format!("its keys are {}", names.join(", ")) });
            };
            let [low, high] = key.range;
            if !(low..=high).contains(value) {
                let message = format!("`town.{name}` of the place `{}` is {value}, out of its range", self.name);
                return Err(RefusedSetting { message, hint: format!("it must be {low} to {high}: {}", key.doc) });
            }
            values.insert(key.name, *value);
        }
        Ok(PlaceSettings(values))
    }

    /// OpenDRIVE 1.6 text of a place; the same settings and seed give the same bytes.
    pub fn open_drive(&self, settings: &PlaceSettings, seed: u64) -> String {
        let mut site = (self.build)(settings, Seed::of_item(seed, "place", self.name));
        prune(&mut site.things);
        let comment = format!(
            "A place made by cosfly ({}, seed {seed}); no survey, nobody else's data. Lengths in metres. Our own userData: \
             crown_radius and crown_base of trees, whose radius is the trunk's; roof and roof_rise, above the height of the \
             walls; surface and walkable of patches of ground; open_ground of all other land.",
            self.name
        );
        write_opendrive(&site.network, &site.ways, &site.things, [self.name, &comment])
    }
}
