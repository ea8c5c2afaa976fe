//! Arguments about a policy: how it is asked, and what its card says.

use crate::arguments::count;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::{Channel, ChannelSet, channels};
use cosfly_env::pictures::PictureFormat;
use cosfly_fly::pilot::{ActionKind, FARTHEST_M, Manners, Place, source_of};
use cosfly_fly::results::{PicturesCard, PolicyCard};
use cosfly_render::PictureLook;
use cosfly_sensors::{Sensor, SensorSet};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Environment variable with the key of a server.
const KEY_VARIABLE: &str = "COSFLY_API_KEY";

/// How a policy is asked.
#[derive(Args, Debug)]
pub struct PolicyArguments {
    /// Version of the policy, for the card
    #[arg(long = "policy-version", value_name = "TEXT")]
    version: Option<String>,
    /// Kind of the actions that a policy answers with
    #[arg(long, value_enum, default_value_t = ActionChoice::Velocity)]
    actions: ActionChoice,
    /// Steps after which a policy is asked again; rows of its last answer are flown meanwhile
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = count())]
    every: usize,
    /// Pictures and readings of sensors in observations, for policies behind a socket or in Python (repeatable)
    #[arg(long, value_name = "NAME", value_parser = observed(), value_delimiter = ',')]
    obs: Vec<Observed>,
    /// Width and height of pictures in observations, pixels
    #[arg(long, value_name = "PX", default_value_t = 84, value_parser = clap::value_parser!(u32).range(16..=512))]
    size_px: u32,
    /// Look of colours in observations: plain (`simple`) or with shadows, textures and smooth edges (`full`); in the weather of the
    /// recipe's pictures
    #[arg(long, value_name = "LOOK", default_value = "simple", value_parser = look)]
    look: PictureLook,
    /// Text of the task in observations
    #[arg(long, value_name = "TEXT", default_value = "Follow the target and keep it in view.")]
    prompt: String,
    /// Time within which an answer must come, seconds; an episode without one ends, and one before the first answer is not scored
    #[arg(long, value_name = "SECONDS", default_value_t = 10.0, value_parser = seconds)]
    timeout_s: f64,
    /// Time for which a policy that is absent, or a module that is being loaded, is waited for, seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0, value_parser = seconds)]
    wait_s: f64,
    /// File with the key that a server gets as `Authorization: Api-Key KEY` [default: the environment variable COSFLY_API_KEY]
    #[arg(long, value_name = "FILE")]
    api_key_file: Option<PathBuf>,
    /// Command of Python, for policies in Python
    #[arg(long, value_name = "COMMAND", default_value = "python3")]
    python: PathBuf,
}

/// A part of observations.
#[derive(Clone, Copy, Debug)]
pub enum Observed {
    Channel(&'static Channel),
    Sensor(&'static Sensor),
}

/// Kind of actions.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum ActionChoice {
    /// Five numbers a step: velocity ahead, right, up (m/s), pitch and yaw rate (degrees/s)
    Velocity,
    /// Six numbers a step, for quadrotors: thrust (multiples of the weight), roll, pitch, yaw rate of the body, pitch and yaw
    /// rate of the camera (degrees/s)
    ThrustRates,
    /// Six numbers a step, for quadrotors: speeds of the rotors (rev/min), pitch and yaw rate of the camera (degrees/s)
    Rotors,
    /// Six numbers a frame of the dataset: dx, dy, dz (m), dpitch, dyaw, droll (degrees), along the world's axes
    DeltasWorld,
    /// Six numbers as for `deltas-world`, along the axes of the body that moves
    DeltasBody,
}

impl From<ActionChoice> for ActionKind {
    fn from(choice: ActionChoice) -> Self {
        match choice {
            ActionChoice::Velocity => Self::Velocity,
            ActionChoice::ThrustRates => Self::ThrustAndRates,
            ActionChoice::Rotors => Self::Rotors,
            ActionChoice::DeltasWorld => Self::DeltasInWorld,
            ActionChoice::DeltasBody => Self::DeltasInBody,
        }
    }
}

impl PolicyArguments {
    /// Kind of the actions of the policy at a place.
    pub fn actions(&self, place: &Place) -> ActionKind {
        match place {
            Place::Onnx(policy) => policy.description().actions,
            _ => self.actions.into(),
        }
    }

    /// Refuses options about what a network in ONNX says itself.
    ///
    /// # Errors
    /// `fly-policy`, with the option.
    pub fn check(&self, place: &Place) -> Result<()> {
        let Place::Onnx(policy) = place else { return Ok(()) };
        let given = [
            ("--actions", !matches!(self.actions, ActionChoice::Velocity)),
            ("--every", self.every != 1),
            ("--obs", !self.obs.is_empty()),
            ("--look", self.look != PictureLook::Simple),
        ];
        match given.iter().find(|it| it.1) {
            None => Ok(()),
            Some((option, _)) => {
                let message = format!("`{option}` says how `{}` is asked, which its file says itself", policy.name());
                Err(Diagnostic::new("fly-policy", Fault::Recipe, message).hint("leave the option out"))
            }
        }
    }

    /// How the policy is asked.
    ///
    /// # Errors
    /// A file without a key.
    pub fn manners(&self) -> Result<Manners> {
        let api_key = match &self.api_key_file {
            Some(file) => Some(key_of(file)?),
            None => std::env::var(KEY_VARIABLE).ok().filter(|key| !key.is_empty()),
        };
        Ok(Manners { api_key, ..self.without_key() })
    }

    fn without_key(&self) -> Manners {
        Manners {
            actions: self.actions.into(),
            every: u32::try_from(self.every).unwrap_or(u32::MAX),
            pictures: self.pictures(),
            sensors: sensors_of(&self.obs),
            prompt: self.prompt.clone(),
            timeout: Duration::from_secs_f64(self.timeout_s),
            wait: Duration::from_secs_f64(self.wait_s),
            api_key: None,
            python: self.python.clone(),
        }
    }

    fn pictures(&self) -> Option<PictureFormat> {
        self.pictures_of(&self.obs)
    }

    /// Pictures among parts of observations, in the size and look that are asked for; none without a channel.
    pub fn pictures_of(&self, observed: &[Observed]) -> Option<PictureFormat> {
        let is_asked =
            |channel: &Channel| observed.iter().any(|it| matches!(it, Observed::Channel(own) if *own == channel));
        let channels = ChannelSet::of(is_asked);
        let (width, height) = (self.size_px, self.size_px);
        let look = self.look;
        (!channels.is_empty()).then_some(PictureFormat {
            width,
            height,
            channels,
            farthest_m: FARTHEST_M,
            weather: None,
            look,
        })
    }

    /// Sensors whose readings observations of the policy at a place carry.
    pub fn sensors(&self, place: &Place) -> SensorSet {
        if let Place::Onnx(policy) = place {
            return SensorSet::of(|sensor| policy.sees().contains(&sensor.name));
        }
        sensors_of(&self.obs)
    }

    /// Card of the policy at a place.
    pub fn card(&self, place: &Place, name: &str) -> PolicyCard {
        let manners = self.without_key();
        let sensors = self.sensors(place).iter().map(|sensor| sensor.name.to_owned()).collect();
        let kind = match place {
            Place::Onnx(policy) => return PolicyCard::of_onnx(policy, name, self.version.clone()),
            Place::Baseline { .. } => {
                let own = PolicyCard::of_baseline(place.name(), name, self.version.clone());
                return PolicyCard { prompt: manners.prompt, sensors, ..own };
            }
            Place::Socket(_) => "socket",
            Place::Python { .. } => "python",
        };
        PolicyCard {
            name: name.to_owned(),
            version: self.version.clone(),
            kind: kind.to_owned(),
            source: source_of(place, &manners),
            timeout_s: Some(self.timeout_s),
            actions: manners.actions.name().to_owned(),
            every: manners.every,
            prompt: manners.prompt,
            pictures: manners.pictures.map(|format| PicturesCard::of(&format)),
            observations: vec![],
            sensors,
            baseline: None,
        }
    }
}

/// The key in a file: its only line.
fn key_of(file: &Path) -> Result<String> {
    let text = std::fs::read_to_string(file)
        .map_err(|error| Diagnostic::unread(format!("the key in `{}`", file.display()), &error))?;
    let key = text.trim();
    if key.is_empty() || key.lines().count() > 1 {
        let message = format!("`{}` is not a file with a key", file.display());
        return Err(Diagnostic::new("fly-policy", Fault::Input, message).hint(
            "put the key into it, on one line and alone, or give it in the environment variable COSFLY_API_KEY",
        ));
    }
    Ok(key.to_owned())
}

/// Sensors among parts of observations.
pub fn sensors_of(observed: &[Observed]) -> SensorSet {
    let is = |it: &Observed, sensor: &Sensor| matches!(it, Observed::Sensor(own) if own.name == sensor.name);
    SensorSet::of(|sensor| observed.iter().any(|it| is(it, sensor)))
}

/// A channel or a sensor of the lists, by its name.
pub fn observed() -> impl TypedValueParser<Value = Observed> {
    let channels = channels::of_moments().map(|channel| PossibleValue::new(channel.name).help(channel.doc));
    let sensors = cosfly_sensors::ALL.iter().map(|sensor| PossibleValue::new(sensor.name).help(sensor.doc));
    PossibleValuesParser::new(channels.chain(sensors)).try_map(|name| {
        let sensor = || cosfly_sensors::called(&name).map(Observed::Sensor);
        channels::called(&name).map(Observed::Channel).or_else(sensor).ok_or("there is no such channel or sensor")
    })
}

fn look(text: &str) -> std::result::Result<PictureLook, String> {
    let names = PictureLook::ALL.map(|(name, _)| name);
    PictureLook::named(text).ok_or_else(|| format!("allowed are {}", names.join(", ")))
}

fn seconds(text: &str) -> std::result::Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| "it is not a number".to_owned())?;
    if (0.001..=86_400.0).contains(&number) { Ok(number) } else { Err("it must be 0.001 to 86400".to_owned()) }
}
