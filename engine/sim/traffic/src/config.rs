//! [`TrafficConfig`]: the parameters of traffic in a recipe.

use crate::follow::Follow;
use cosfly_diagnose::counted;
use cosfly_domain::BodyKind;
use cosfly_pedestrians::{CrowdConfig, PedestrianConfigRule, RecordedConfig, ScriptedPerson};
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
                "`follow.named` has {}, but `follow.count` is `{}`; it must be at least as many",
                counted(named.len(), "name"),
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
