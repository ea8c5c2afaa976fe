//! The mixture of kinds of perturbation, and the kind of each flight.

use super::kinds::{KINDS, Kind};
use cosfly_random::Seed;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::json;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Shares of the kinds of perturbation among the flights, in the order of [`KINDS`]: each flight has one kind, and every kind has its
/// share of the first N flights to within one flight, for any N. The shares are relative to their sum.
#[derive(Clone, Debug, PartialEq)]
pub struct Mixture {
    shares: Vec<f64>,
}

/// Rounding of sums of shares.
const TOLERANCE: f64 = 1e-9;

impl Default for Mixture {
    fn default() -> Self {
        Self::of(&[(KINDS[0].name, 1.0)])
    }
}

impl Mixture {
    /// The mixture of some shares by the names of their kinds; the others have none.
    pub fn of(shares: &[(&str, f64)]) -> Self {
        let share = |kind: &Kind| shares.iter().find(|(name, _)| *name == kind.name).map_or(0.0, |(_, share)| *share);
        Self { shares: KINDS.iter().map(share).collect() }
    }

    /// The kinds and their shares.
    pub fn shares(&self) -> impl Iterator<Item = (&'static Kind, f64)> {
        KINDS.iter().zip(self.shares.iter().copied())
    }

    /// The mixture of flight number `number` (from 0) among those that share this one: its kind alone. Kinds take turns so that
    /// after any number of flights each has been given its share of them to within one flight; further flights change none
    /// before them. `order` decides between kinds whose turn it is alike.
    ///
    /// Tijdeman's chairman assignment (The chairman assignment problem, 1980): of the kinds that are owed enough, the one whose
    /// turn must come first.
    pub fn of_flight(&self, number: u64, order: &Seed) -> Self {
        let sum: f64 = self.shares.iter().sum();
        let kinds: Vec<(&Kind, f64)> =
            self.shares().filter(|it| it.1 > 0.0).map(|(kind, share)| (kind, share / sum)).collect();
        let [.., last] = kinds[..] else { return self.clone() };
        if kinds.len() == 1 {
            return Self::of(&[(last.0.name, 1.0)]);
        }
        let slack = 1.0 / (2 * kinds.len() - 2) as f64;
        let mut given = vec![0.0; kinds.len()];
        let mut ties = order.stream("turns");
        let mut chosen = 0;
        for turn in 0..=number {
            let is_owed = |at: &usize| kinds[*at].1 * (turn + 1) as f64 - given[*at] >= slack - TOLERANCE;
            let latest = |at: usize| (given[at] + 1.0 - slack) / kinds[at].1;
            let owed: Vec<usize> = (0..kinds.len()).filter(is_owed).collect();
            let first = owed.iter().map(|at| latest(*at)).fold(f64::INFINITY, f64::min);
            let alike: Vec<usize> = owed.into_iter().filter(|at| latest(*at) <= first * (1.0 + TOLERANCE)).collect();
            chosen = alike.get(ties.index(alike.len())).copied().unwrap_or(chosen);
            given[chosen] += 1.0;
        }
        Self::of(&[(kinds[chosen].0.name, 1.0)])
    }

    /// The kind of the flight with a seed: of a mixture of several kinds, one by chance.
    pub fn draw(&self, seed: &Seed) -> &'static Kind {
        let mut left = seed.stream("kind").uniform(0.0, self.shares.iter().sum());
        for (kind, share) in self.shares() {
            if left < share {
                return kind;
            }
            left -= share;
        }
        &KINDS[0]
    }
}

impl Serialize for Mixture {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.shares().map(|(kind, share)| (kind.name, share)))
    }
}

impl<'de> Deserialize<'de> for Mixture {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let given = BTreeMap::<String, f64>::deserialize(deserializer)?;
        if let Some(name) = given.keys().find(|name| KINDS.iter().all(|kind| kind.name != **name)) {
            let kinds = KINDS.iter().map(|kind| kind.name).collect::<Vec<_>>().join(", ");
            return Err(D::Error::custom(format!("there is no kind of perturbation `{name}`; the kinds are {kinds}")));
        }
        let defaults = Self::default();
        let share = |(kind, default): (&Kind, f64)| given.get(kind.name).copied().unwrap_or(default);
        Ok(Self { shares: defaults.shares().map(share).collect() })
    }
}

impl JsonSchema for Mixture {
    fn schema_name() -> Cow<'static, str> {
        "Mixture".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let property = |(kind, default): (&'static Kind, f64)| {
            let description = format!("{} Default {default}.", kind.doc);
            let schema = json!({
                "description": description, "type": "number", "format": "double",
                "default": default, "minimum": 0.0, "maximum": 1000.0
            });
            (kind.name.to_owned(), schema)
        };
        let description = "Shares of the kinds of perturbation among the flights: each flight has one kind, and every kind has \
                           its share of the first N flights to within one flight, for any N. The shares are relative to their \
                           sum.\nAll kinds but `jumps` drift away from the expert's way and back, and do what they are named \
                           after besides.";
        let properties: serde_json::Map<String, serde_json::Value> = Self::default().shares().map(property).collect();
        json_schema!({
            "description": description, "type": "object", "properties": properties, "additionalProperties": false
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flights_have_the_shares_that_the_mixture_states() {
        let mixture = Mixture::of(&[("jumps", 2.0), ("drift", 1.0), ("search", 1.0)]);
        let drawn: Vec<&str> =
            (0..4000).map(|number| mixture.draw(&Seed::of_item(1, "perturbed", &format!("p{number}"))).name).collect();
        for (kind, share) in [("jumps", 0.5), ("drift", 0.25), ("search", 0.25), ("gusts", 0.0)] {
            let found = drawn.iter().filter(|it| **it == kind).count() as f64 / 4000.0;
            assert!((found - share).abs() < 0.03, "{kind} {found}");
        }
        assert_eq!(Mixture::default().draw(&Seed([3; 32])).name, "jumps");
    }

    /// Names of the kinds of the first flights.
    fn first(mixture: &Mixture, count: u64, order: &str) -> Vec<&'static str> {
        let order = Seed::of_item(0, "mixture", order);
        (0..count).map(|number| mixture.of_flight(number, &order).draw(&Seed([number as u8; 32])).name).collect()
    }

    #[test]
    fn every_kind_has_its_share_of_any_number_of_first_flights_to_within_one() {
        let mut random = Seed::of_item(1, "test", "mixtures").stream("test");
        for round in 0..60 {
            let share = |random: &mut cosfly_random::RandomStream| {
                if random.chance(0.3) { 0.0 } else { (random.uniform(0.0, 9.0) * 4.0).ceil() / 4.0 }
            };
            let mut mixture = Mixture { shares: KINDS.iter().map(|_| share(&mut random)).collect() };
            mixture.shares[0] += 0.25;
            let kinds = first(&mixture, 120, &round.to_string());
            let sum: f64 = mixture.shares.iter().sum();
            for (kind, share) in mixture.shares() {
                let mut found = 0.0;
                for (at, one) in kinds.iter().enumerate() {
                    found += f64::from(u8::from(*one == kind.name));
                    let due = share / sum * (at + 1) as f64;
                    assert!((found - due).abs() < 1.0, "{mixture:?} {}: {found} of {due} after {}", kind.name, at + 1);
                }
            }
        }
    }

    #[test]
    fn small_sets_miss_no_kind_and_one_more_flight_changes_none() {
        // The mixture of `carla_town.toml`.
        let names = ["jumps", "drift", "gusts", "timing", "aim", "search"];
        let mixture = Mixture::of(&names.map(|name| (name, if name == "jumps" { 2.0 } else { 1.0 })));
        for order in ["perturbed", "perturbed_uptown", "twins"] {
            let kinds = first(&mixture, 14, order);
            for name in names {
                let expected = if name == "jumps" { 2 } else { 1 };
                assert_eq!(kinds[..7].iter().filter(|it| **it == name).count(), expected, "{order} {name}");
            }
            assert_eq!(first(&mixture, 8, order), kinds[..8]);
        }
        assert_ne!(first(&mixture, 14, "perturbed"), first(&mixture, 14, "twins"));
        assert_eq!(first(&Mixture::default(), 3, "perturbed"), ["jumps"; 3]);
    }

    #[test]
    fn recipes_name_kinds_and_leave_the_others_at_their_defaults() {
        let read = |text: &str| serde_json::from_str::<Mixture>(text).map_err(|error| error.to_string());
        assert_eq!(read(r#"{"jumps": 0, "aim": 2}"#), Ok(Mixture::of(&[("aim", 2.0)])));
        assert_eq!(read("{}"), Ok(Mixture::default()));
        assert!(read(r#"{"gust": 1}"#).unwrap_err().contains("the kinds are jumps, drift, gusts"));
    }
}
