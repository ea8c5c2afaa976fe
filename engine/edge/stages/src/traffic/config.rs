//! [`TrafficConfig`]: the parameters of traffic in a recipe.

use cosfly_domain::{BodyKind, Traffic};
use cosfly_pedestrians::{CrowdConfig, PedestrianConfigRule, RecordedConfig, ScriptedPerson};
use cosfly_stage::{Source, parameters};
use cosfly_vehicles::VehicleConfig;
use cosfly_vehicles::fcd::FcdConfig;
use cosfly_world::{Clock, LookAlikeConfig, LooksConfig};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Longest step of the simulation, seconds.
const STEP_S: f64 = 0.1;

/// People and vehicles who move together: numbers, manners, length, and which of them are followed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TrafficConfig {
    /// Frames of all tracks. Default 200.
    #[schemars(range(min = 2, max = 100_000))]
    pub frames: u32,
    /// Time between frames, seconds. Default 0.5.
    #[schemars(range(min = 0.01, max = 10.0))]
    pub dt_s: f64,
    /// Bodies that flights follow.
    pub follow: Follow,
    /// People on foot.
    pub people: CrowdConfig,
    /// Vehicles on the town's lanes; in a town without lanes there are none, with a note.
    pub vehicles: VehicleConfig,
    /// People of recorded tracks: GPX and GeoJSON with times, ETH/UCY `obsmat`, CSV.
    pub recorded: Vec<RecordedSource>,
    /// People on routes of their own.
    pub scripted: Vec<ScriptedPerson>,
    /// Vehicles and people that SUMO simulated.
    pub sumo: Option<SumoSource>,
    /// Shares of the people by bag, build and gait.
    pub looks: LooksConfig,
    /// People who are dressed like a followed person.
    pub look_alikes: LookAlikeConfig,
}

impl Default for TrafficConfig {
    fn default() -> Self {
        Self {
            frames: 200,
            dt_s: 0.5,
            follow: Follow::default(),
            people: CrowdConfig::default(),
            vehicles: VehicleConfig::default(),
            recorded: vec![],
            scripted: vec![],
            sumo: None,
            looks: LooksConfig::default(),
            look_alikes: LookAlikeConfig::default(),
        }
    }
}

/// A file of recorded tracks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RecordedSource {
    /// Path of the file, absolute or relative to the recipe.
    pub source: String,
    /// Format, clock and place of the tracks.
    #[serde(default)]
    pub options: RecordedConfig,
}

/// Traffic that SUMO simulated.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SumoSource {
    /// Path of the file of `sumo --fcd-output`, absolute or relative to the recipe.
    pub source: String,
    /// Path of the net that SUMO used.
    pub net: String,
    /// Time and kinds.
    #[serde(default)]
    pub options: FcdConfig,
}

/// Bodies that flights follow: the first ones, by number, of the named kinds that are there in all frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Follow {
    /// Number of followed bodies; a higher number changes none of the first. Default 4.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub count: u64,
    /// Names of those who are followed first: scripted and recorded people, vehicles and people of SUMO. They count among `count`.
    /// Default `[]`.
    pub named: Vec<String>,
    /// Kinds of the other followed bodies, in turn. Default `["pedestrian"]`.
    #[schemars(length(min = 1))]
    pub kinds: Vec<BodyKind>,
    /// Least distance that a followed body covers, metres. Default 20.
    #[schemars(range(min = 0.0, max = 100_000.0))]
    pub min_length_m: f64,
}

impl Default for Follow {
    fn default() -> Self {
        Self { count: 4, named: vec![], kinds: vec![BodyKind::Pedestrian], min_length_m: 20.0 }
    }
}

impl Follow {
    /// Parameters that no single followed body depends on; not in its key.
    pub const NOT_IN_KEY: &[&str] = &["count"];

    /// Numbers of all bodies that may be followed, in the order in which they are: those with names, then the first of each
    /// kind, the second of each kind and so on, so that further ones change nothing.
    ///
    /// # Errors
    /// A name that nobody has who is there all the time.
    pub fn eligible<'a>(&'a self, traffic: &Traffic) -> Result<Vec<u32>, &'a str> {
        let is_there = |number: &u32| traffic.track(*number).is_some();
        let numbers = || 0..traffic.bodies.len() as u32;
        let of_name = |name: &'a String| {
            let mut called = numbers().filter(|number| traffic.bodies[*number as usize].plan.source == *name);
            called.find(is_there).ok_or(name.as_str())
        };
        let named: Vec<u32> = self.named.iter().map(of_name).collect::<Result<_, _>>()?;
        let of_kind = |kind: &BodyKind| -> Vec<u32> {
            let may = |number: &u32| {
                let body = &traffic.bodies[*number as usize];
                body.plan.kind == *kind
                    && !named.contains(number)
                    && is_there(number)
                    && body.length_m() >= self.min_length_m
            };
            numbers().filter(may).collect()
        };
        let lists: Vec<Vec<u32>> = self.kinds.iter().map(of_kind).collect();
        let longest = lists.iter().map(Vec::len).max().unwrap_or(0);
        let others = (0..longest).flat_map(|place| lists.iter().filter_map(move |list| list.get(place))).copied();
        Ok(named.iter().copied().chain(others).collect())
    }

    /// Names of the kinds, for messages.
    pub fn names(&self) -> String {
        let names: Vec<String> = self.kinds.iter().map(|kind| format!("`{}`", kind.name())).collect();
        names.join(", ")
    }
}

/// Whether sides, metres, are none of a body.
fn is_no_size(size_m: &[f64; 3]) -> bool {
    !size_m.iter().all(|side_m| (0.1..=50.0).contains(side_m))
}

impl TrafficConfig {
    /// Parameters that the bodies depend on only where others are dressed like the followed ones; otherwise not in their key.
    pub const NOT_IN_KEY_OF_BODIES: &[&str] = &["follow"];

    /// Checks what the schema cannot say.
    pub fn check(&self) -> Result<(), PedestrianConfigRule> {
        let duration_s = f64::from(self.frames) * self.dt_s;
        if duration_s > 86_400.0 {
            let message = format!("`frames` x `dt_s` is `{duration_s}` s; it must not be more than a day, `86400` s");
            return Err(PedestrianConfigRule { path: vec!["frames"], message });
        }
        if let Some(at) =
            (1..self.follow.kinds.len()).find(|at| self.follow.kinds[..*at].contains(&self.follow.kinds[*at]))
        {
            let message = format!("`{}` is listed twice", self.follow.kinds[at].name());
            return Err(PedestrianConfigRule { path: vec!["follow", "kinds"], message });
        }
        let named = &self.follow.named;
        if let Some(at) = (1..named.len()).find(|at| named[..*at].contains(&named[*at])) {
            let message = format!("`{}` is listed twice", named[at]);
            return Err(PedestrianConfigRule { path: vec!["follow", "named"], message });
        }
        if named.len() as u64 > self.follow.count {
            let message = format!(
                "`follow.named` has {} names, but `follow.count` is `{}`; it must be at least as many",
                named.len(),
                self.follow.count
            );
            return Err(PedestrianConfigRule { path: vec!["follow", "named"], message });
        }
        let mut types = self.sumo.iter().flat_map(|sumo| &sumo.options.types);
        if let Some((name, _)) = types.find(|(_, it)| it.kind == BodyKind::Drone) {
            let known =
                BodyKind::ON_THE_GROUND.iter().map(|kind| format!("`{}`", kind.name())).collect::<Vec<_>>().join(", ");
            let message = format!("type `{name}` is a `drone`, which no traffic has; its kind must be one of {known}");
            return Err(PedestrianConfigRule { path: vec!["sumo", "options", "types"], message });
        }
        let mut types = self.sumo.iter().flat_map(|sumo| &sumo.options.types);
        if let Some((name, size_m)) = types.find_map(|(name, it)| Some((name, it.size_m.filter(is_no_size)?))) {
            let message = format!("`size_m` of type `{name}` is `{size_m:?}`; each side must be from 0.1 to 50 m long");
            return Err(PedestrianConfigRule { path: vec!["sumo", "options", "types"], message });
        }
        if let Err((table, message)) = self.looks.check() {
            return Err(PedestrianConfigRule { path: vec!["looks", table], message });
        }
        let shares = |message| PedestrianConfigRule { path: vec!["look_alikes", "shares"], message };
        self.look_alikes.check().map_err(shares)?;
        for person in &self.scripted {
            let below = |rule: PedestrianConfigRule| PedestrianConfigRule { path: vec!["scripted"], ..rule };
            person.check().map_err(below)?;
        }
        for recorded in &self.recorded {
            let below = |rule: PedestrianConfigRule| PedestrianConfigRule { path: vec!["recorded"], ..rule };
            recorded.options.check().map_err(below)?;
        }
        let below = |rule: cosfly_vehicles::VehicleConfigRule| {
            PedestrianConfigRule { path: rule.path.to_vec(), message: rule.message }.within_table("vehicles")
        };
        self.vehicles.validate().map_err(below)?;
        self.people.check().map_err(|rule| rule.within_table("people"))
    }

    /// Frames and steps.
    pub fn clock(&self) -> Clock {
        Clock::new(self.frames, self.dt_s, STEP_S)
    }

    /// Files of recorded tracks, then the two of SUMO. Their names are left out of the parameters: contents count.
    pub fn take_sources(&mut self) -> Vec<Source> {
        let mut sources = vec![];
        for (number, recorded) in self.recorded.iter_mut().enumerate() {
            sources.push(Source::new(format!("recorded.{number}.source"), std::mem::take(&mut recorded.source)));
        }
        if let Some(sumo) = &mut self.sumo {
            sources.push(Source::new("sumo.source", std::mem::take(&mut sumo.source)));
            sources.push(Source::new("sumo.net", std::mem::take(&mut sumo.net)));
        }
        sources
    }

    /// Parameters that the bodies depend on, for keys: those who are followed as far as others are dressed like them.
    pub fn canonical_of_bodies(&self) -> serde_json::Value {
        let all = parameters::canonical(self);
        if self.look_alikes.shares.is_empty() { parameters::without(all, Self::NOT_IN_KEY_OF_BODIES) } else { all }
    }

    /// Parameters that one walk depends on beside the tracks, for keys: not how many there are.
    pub fn canonical_of_walks(&self) -> serde_json::Value {
        parameters::without(parameters::canonical(&self.follow), Follow::NOT_IN_KEY)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_broken_rule_is_found_at_its_own_key() {
        let refused = |change: fn(&mut TrafficConfig)| {
            let mut config = TrafficConfig::default();
            change(&mut config);
            config.check().unwrap_err().path.join(".")
        };
        assert_eq!(refused(|it| it.people.groups.sizes = vec![0.0, 0.0]), "people.groups.sizes");
        assert_eq!(refused(|it| it.people.stops.median_s = 500.0), "people.stops.median_s");
        assert_eq!(refused(|it| it.vehicles.parked_share = 2.0), "vehicles.parked_share");
        assert_eq!(refused(|it| it.follow.kinds = vec![BodyKind::Car, BodyKind::Car]), "follow.kinds");
    }
}
