//! [`Card`]: what was evaluated, and how.

use super::differences::differences;
use crate::flight::Latency;
use crate::pilot::{ActionKind, OnnxPolicy};
use crate::settings::FlySettings;
use crate::suite::{Suite, SuitePart};
use cosfly_domain::Channel;
use cosfly_domain::channels::{self, rgb};
use cosfly_drone::models;
use cosfly_env::pictures::PictureFormat;
use cosfly_env::{
    Blackouts, DroneSettings, EnvironmentSettings, MOST_BLACKOUTS, MOST_LATENCY_MS, MOST_WIND_MPS, RewardWeights,
};
use cosfly_render::PictureLook;
use cosfly_sensors::SensorSet;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::collections::{BTreeMap, BTreeSet};

/// Task and settings of an evaluation. Rows of two results are comparable if `suite`, `episodes` and `environment` are
/// equal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Card {
    /// Suite.
    pub suite: SuiteCard,
    /// Policy.
    pub policy: PolicyCard,
    /// Settings of the environment.
    pub environment: EnvironmentCard,
    /// Those of the recipes of a tier that have others, by their names.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub environments: BTreeMap<String, EnvironmentCard>,
    /// Files that are kept beside rows and tables.
    pub kept: KeptCard,
    /// Version of cosfly.
    pub cosfly: String,
}

/// The suite on a card.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SuiteCard {
    /// Name of the recipe.
    pub name: String,
    /// Digest of all towns and flights, and of the version of the environment.
    pub hash: String,
    /// Episodes.
    pub episodes: u64,
    /// Walks that have no episode because the expert found no flight behind them.
    pub rejected: u64,
}

impl SuiteCard {
    /// The card of a suite.
    pub fn of(suite: &Suite) -> Self {
        Self {
            name: suite.name.clone(),
            hash: suite.digest.to_string(),
            episodes: suite.tasks.len() as u64,
            rejected: suite.rejected,
        }
    }
}

/// The policy on a card.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PolicyCard {
    /// Name.
    pub name: String,
    /// Version, as given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub version: Option<String>,
    /// Kind: `baseline`, `onnx`, `python`, `socket`.
    pub kind: String,
    /// Digest of the file of a network in ONNX, or of a module in Python.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// Time within which an answer must come, seconds; none for baselines and networks in ONNX, which are not timed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub timeout_s: Option<f64>,
    /// Kind of its actions.
    pub actions: String,
    /// Steps after which it is asked again.
    pub every: u32,
    /// Text of the task.
    pub prompt: String,
    /// Pictures in its observations.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pictures: Option<PicturesCard>,
    /// Sensors whose readings are in its observations.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sensors: Vec<String>,
    /// Observations that the inputs of a network in ONNX are fed with.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub observations: Vec<String>,
    /// The baseline that it is, with its variation, such as `follow-gain0.5-delay0-noise0`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub baseline: Option<String>,
}

impl PolicyCard {
    /// Names of what the policy was sent: the state, pictures, readings of sensors.
    pub fn sent(&self) -> Vec<&str> {
        if !self.observations.is_empty() {
            return self.observations.iter().map(String::as_str).collect();
        }
        let pictures = self.pictures.iter().flat_map(|pictures| &pictures.channels);
        std::iter::once("state").chain(pictures.chain(&self.sensors).map(String::as_str)).collect()
    }

    /// The card of a network in ONNX, whose file says all of it but name and version.
    pub fn of_onnx(policy: &OnnxPolicy, name: &str, version: Option<String>) -> Self {
        let description = policy.description();
        let is_sensor = |name: &&str| cosfly_sensors::called(name).is_some();
        let sees = policy.sees();
        Self {
            name: name.to_owned(),
            version,
            kind: "onnx".to_owned(),
            source: Some(policy.digest().to_string()),
            timeout_s: None,
            actions: description.actions.name().to_owned(),
            every: description.every,
            prompt: String::new(),
            pictures: description.pictures.as_ref().map(PicturesCard::of),
            sensors: sees.iter().copied().filter(is_sensor).map(str::to_owned).collect(),
            observations: sees.into_iter().map(str::to_owned).collect(),
            baseline: None,
        }
    }

    /// The card of a baseline, which is sent no pictures and answers each step.
    pub fn of_baseline(baseline: String, name: &str, version: Option<String>) -> Self {
        Self {
            name: name.to_owned(),
            version,
            kind: "baseline".to_owned(),
            source: None,
            timeout_s: None,
            actions: ActionKind::Velocity.name().to_owned(),
            every: 1,
            prompt: String::new(),
            pictures: None,
            sensors: vec![],
            observations: vec![],
            baseline: Some(baseline),
        }
    }

    /// The sensors.
    ///
    /// # Errors
    /// A name that no sensor has, in words.
    fn sensors(&self) -> Result<SensorSet, String> {
        match self.sensors.iter().find(|name| cosfly_sensors::called(name).is_none()) {
            Some(unknown) => Err(format!("there is no sensor `{unknown}`")),
            None => Ok(SensorSet::of(|sensor| self.sensors.iter().any(|name| name == sensor.name))),
        }
    }
}

/// Pictures in observations on a card.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PicturesCard {
    channels: Vec<String>,
    width: u32,
    height: u32,
    farthest_m: f32,
    /// Look of the colours, where there are any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    look: Option<PictureLook>,
}

impl PicturesCard {
    /// The card of a format.
    pub fn of(format: &PictureFormat) -> Self {
        Self {
            channels: format.channels.iter().map(|channel| channel.name.to_owned()).collect(),
            width: format.width,
            height: format.height,
            farthest_m: format.farthest_m,
            look: format.channels.contains(&rgb::CHANNEL).then_some(format.look),
        }
    }

    /// Channels.
    pub fn channels(&self) -> impl Iterator<Item = &'static Channel> {
        self.channels.iter().filter_map(|name| channels::called(name))
    }

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        [self.width as usize, self.height as usize]
    }
}

/// Files that are kept beside rows and tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeptCard {
    /// Episodes with logs that play.
    pub logs: LogChoice,
    /// Number of the worst episodes that have clips.
    pub clips: u32,
}

/// Episodes with logs that play (MCAP).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LogChoice {
    /// All.
    All,
    /// Those that have clips.
    Worst,
    /// None.
    None,
}

/// Settings of the environment on a card: metres, seconds, degrees.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EnvironmentCard {
    step_s: f64,
    latency_s: f64,
    /// Whether latencies are measured: then rows and logs differ from run to run.
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    latency_is_measured: bool,
    drone: String,
    wind_mps: f64,
    gusts: bool,
    blackouts: Blackouts,
    radius_m: f64,
    speed_mps: f64,
    acceleration_mps2: f64,
    jerk_mps3: f64,
    view_rate_deg_s: [f64; 2],
    pitch_deg: [f64; 2],
    horizontal_field_deg: f64,
    aspect: f64,
    least_visible: f64,
    farthest_m: f64,
    band_m: [f64; 2],
    give_up_s: f64,
    reward_weights: RewardWeights,
}

impl EnvironmentCard {
    /// The card of settings.
    pub fn new(settings: &EnvironmentSettings, latency: Latency) -> Self {
        let gimbal = &settings.gimbal;
        Self {
            step_s: settings.step_s,
            latency_s: settings.latency_s,
            latency_is_measured: latency == Latency::Measured,
            drone: settings.drone.model.name.to_owned(),
            wind_mps: settings.drone.wind_mps,
            gusts: settings.drone.gusts,
            blackouts: settings.blackouts,
            radius_m: settings.radius_m,
            speed_mps: settings.motion.speed_mps,
            acceleration_mps2: settings.motion.acceleration_mps2,
            jerk_mps3: settings.motion.jerk_mps3,
            view_rate_deg_s: [gimbal.pitch_rate_rad_s, gimbal.yaw_rate_rad_s].map(f64::to_degrees),
            pitch_deg: [gimbal.lowest_pitch_rad, gimbal.highest_pitch_rad].map(f64::to_degrees),
            horizontal_field_deg: settings.lens.horizontal_deg,
            aspect: settings.lens.aspect,
            least_visible: settings.least_visible,
            farthest_m: settings.farthest_m,
            band_m: [settings.band_m.0, settings.band_m.1],
            give_up_s: settings.give_up_s,
            reward_weights: settings.weights,
        }
    }
}

impl EnvironmentCard {
    /// The card of the settings of the first part of a suite, and those of other parts that differ from it.
    pub fn of_parts(
        parts: &[SuitePart],
        settings: &[EnvironmentSettings],
        latency: Latency,
    ) -> (Self, BTreeMap<String, Self>) {
        let mut cards = parts.iter().zip(settings).map(|(part, settings)| (&part.name, Self::new(settings, latency)));
        let first = cards.next().map_or_else(|| Self::new(&EnvironmentSettings::default(), latency), |it| it.1);
        let others = cards.filter(|(_, card)| *card != first).map(|(name, card)| (name.clone(), card)).collect();
        (first, others)
    }

    /// The settings that the card is of, flown on a suite with these settings.
    ///
    /// # Errors
    /// The difference, in words, where no options of this cosfly give such a card.
    fn settings(&self, suite: &FlySettings) -> Result<EnvironmentSettings, String> {
        // A step of a year would be flown for a year.
        within("step_s", self.step_s, 0.01, 1.0)?;
        within("latency_s", self.latency_s, 0.0, f64::from(MOST_LATENCY_MS) / 1000.0)?;
        within("wind_mps", self.wind_mps, 0.0, MOST_WIND_MPS)?;
        within("blackouts.count", f64::from(self.blackouts.count), 0.0, f64::from(MOST_BLACKOUTS))?;
        let plain = FlySettings { blackouts: self.blackouts.count, ..*suite }.environment();
        let model = models::model(&self.drone)?;
        let drone = DroneSettings { model, wind_mps: self.wind_mps, gusts: self.gusts, ..plain.drone };
        let settings = EnvironmentSettings { step_s: self.step_s, latency_s: self.latency_s, drone, ..plain };
        let latency = if self.latency_is_measured { Latency::Measured } else { Latency::Simulated };
        let value = |card: &Self| serde_json::to_value(card).unwrap_or_default();
        let differ = differences("environment", &value(self), &value(&Self::new(&settings, latency)));
        if differ.is_empty() { Ok(settings) } else { Err(differ.join("; ")) }
    }
}

fn within(name: &str, value: f64, low: f64, high: f64) -> Result<(), String> {
    match (low..=high).contains(&value) {
        true => Ok(()),
        false => Err(format!("`{name}` is {value}; it must be {low} to {high}")),
    }
}

impl Card {
    /// Whether latencies are measured: then rows and logs differ from run to run.
    pub fn is_measured(&self) -> bool {
        self.environment.latency_is_measured
    }

    /// Settings of each part of a suite that the card is of.
    ///
    /// # Errors
    /// The difference, in words, where no options of this cosfly give such a card.
    pub fn settings(&self, parts: &[SuitePart]) -> Result<Vec<EnvironmentSettings>, String> {
        if let Some(name) = self.environments.keys().find(|name| parts.iter().all(|part| part.name != **name)) {
            return Err(format!("it has settings for `{name}`, which is no part of the suite"));
        }
        let sensors = self.policy.sensors()?;
        let of = |part: &SuitePart| {
            let card = self.environments.get(&part.name).unwrap_or(&self.environment);
            card.settings(&part.settings).map(|settings| EnvironmentSettings { sensors, ..settings })
        };
        let settings: Vec<EnvironmentSettings> = parts.iter().map(of).collect::<Result<_, _>>()?;
        let latency = if self.is_measured() { Latency::Measured } else { Latency::Simulated };
        // Else the card could say one thing and be flown as another.
        match EnvironmentCard::of_parts(parts, &settings, latency)
            == (self.environment.clone(), self.environments.clone())
        {
            true => Ok(settings),
            false => Err("`environment` and `environments` are not as cosfly writes them".to_owned()),
        }
    }

    /// Settings that rows of two results must have in common: all but latencies.
    pub fn ground(&self) -> Value {
        let without =
            |card: &EnvironmentCard| EnvironmentCard { latency_s: 0.0, latency_is_measured: false, ..card.clone() };
        let others: BTreeMap<&String, EnvironmentCard> =
            self.environments.iter().map(|(name, card)| (name, without(card))).collect();
        let mut ground = serde_json::to_value(without(&self.environment)).unwrap_or_default();
        if !others.is_empty() {
            ground["environments"] = serde_json::to_value(others).unwrap_or_default();
        }
        ground
    }

    /// Latency, in words.
    pub fn latency(&self) -> String {
        if self.is_measured() {
            return "measured".to_owned();
        }
        let all = std::iter::once(&self.environment).chain(self.environments.values());
        let mut all: Vec<String> = all.map(|card| format!("{} s", card.latency_s)).collect();
        all.dedup();
        all.join(", ")
    }

    /// Difference that keeps rows of two results from being compared, in words.
    pub fn incomparable(&self, other: &Self) -> Option<String> {
        let (ours, theirs) = (&self.suite.hash, &other.suite.hash);
        if ours != theirs {
            return Some(format!("their suites differ: `{ours}` and `{theirs}`"));
        }
        let (ours, theirs) = (self.ground(), other.ground());
        let names: BTreeSet<&String> =
            [&ours, &theirs].into_iter().filter_map(Value::as_object).flat_map(Map::keys).collect();
        let names = names.into_iter().filter(|name| ours[name.as_str()] != theirs[name.as_str()]);
        let differ: Vec<String> =
            names.map(|name| format!("{name} is {} and {}", ours[name.as_str()], theirs[name.as_str()])).collect();
        (!differ.is_empty()).then(|| format!("their environments differ: {}", differ.join(", ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_those_that_options_can_give() {
        let (suite, latency) = (FlySettings::default(), Latency::Simulated);
        let card =
            EnvironmentCard::new(&EnvironmentSettings { step_s: 0.2, latency_s: 0.3, ..suite.environment() }, latency);
        let settings = card.settings(&suite).expect("settings");
        assert_eq!((settings.step_s, settings.latency_s), (0.2, 0.3));
        for (wrong, words) in [
            (EnvironmentCard { step_s: 1e9, ..card.clone() }, "`step_s` is 1000000000"),
            (EnvironmentCard { step_s: 0.0, ..card.clone() }, "`step_s` is 0"),
            (EnvironmentCard { latency_s: -1.0, ..card.clone() }, "`latency_s` is -1"),
            (EnvironmentCard { wind_mps: 31.0, ..card.clone() }, "`wind_mps` is 31"),
            (EnvironmentCard { radius_m: 0.0, ..card.clone() }, "`environment.radius_m`"),
        ] {
            let found = wrong.settings(&suite).expect_err(words);
            assert!(found.contains(words), "{found}");
        }
    }
}
