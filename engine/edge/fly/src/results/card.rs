//! [`Card`]: what was evaluated, and how.

use super::differences::differences;
use crate::flight::Latency;
use crate::settings::FlySettings;
use crate::suite::Suite;
use cosfly_domain::channels::rgb;
use cosfly_drone::models;
use cosfly_env::pictures::PictureFormat;
use cosfly_env::{Blackouts, DroneSettings, EnvironmentSettings, RewardWeights};
use cosfly_render::PictureLook;
use serde::{Deserialize, Serialize};

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
    /// Kind: `baseline`, `socket`, `python`.
    pub kind: String,
    /// Digest of the file of a module in Python.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// Time within which an answer must come, seconds; none for baselines.
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
    /// The settings that the card is of, flown on a suite with these settings.
    ///
    /// # Errors
    /// What differs, in words, where no options of this cosfly give such a card.
    pub fn settings(&self, suite: &FlySettings) -> Result<EnvironmentSettings, String> {
        let plain = suite.environment();
        let model = models::model(&self.drone)?;
        let drone = DroneSettings { model, wind_mps: self.wind_mps, gusts: self.gusts, ..plain.drone };
        let settings = EnvironmentSettings { step_s: self.step_s, latency_s: self.latency_s, drone, ..plain };
        let latency = if self.latency_is_measured { Latency::Measured } else { Latency::Simulated };
        let value = |card: &Self| serde_json::to_value(card).unwrap_or_default();
        let differ = differences("environment", &value(self), &value(&Self::new(&settings, latency)));
        if differ.is_empty() { Ok(settings) } else { Err(differ.join("; ")) }
    }
}

impl Card {
    /// Whether latencies are measured: then rows and logs differ from run to run.
    pub fn is_measured(&self) -> bool {
        self.environment.latency_is_measured
    }

    /// Difference that keeps rows of two results from being compared, in words.
    pub fn incomparable(&self, other: &Self) -> Option<String> {
        let (ours, theirs) = (&self.suite.hash, &other.suite.hash);
        if ours != theirs {
            return Some(format!("their suites differ: `{ours}` and `{theirs}`"));
        }
        // Latencies may differ.
        let settings = |card: &Self| {
            serde_json::to_value(EnvironmentCard {
                latency_s: 0.0,
                latency_is_measured: false,
                ..card.environment.clone()
            })
            .unwrap_or_default()
        };
        let (ours, theirs) = (settings(self), settings(other));
        let names = ours.as_object()?.keys().filter(|name| ours[name.as_str()] != theirs[name.as_str()]);
        let differ: Vec<String> =
            names.map(|name| format!("{name} is {} and {}", ours[name.as_str()], theirs[name.as_str()])).collect();
        (!differ.is_empty()).then(|| format!("their environments differ: {}", differ.join(", ")))
    }
}
