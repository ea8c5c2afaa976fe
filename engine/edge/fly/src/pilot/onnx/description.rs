//! [`Description`]: what a file says of its inputs and outputs.

use super::observation::{Observation, Order};
use crate::pilot::answer::ActionKind;
use cosfly_domain::ChannelSet;
use cosfly_env::pictures::PictureFormat;
use cosfly_onnx::{Kind, OnnxModel, Port};
use cosfly_render::PictureLook;
use serde::Deserialize;
use std::collections::BTreeMap;

/// Key of the file's metadata.
const KEY: &str = "cosfly";
/// Version of descriptions.
const VERSION: u32 = 1;
/// Most observations that an input is fed with, and most steps of an answer.
const MOST_STEPS: u32 = 1000;
/// Greatest depth in pictures, metres.
pub const FARTHEST_M: f32 = 200.0;

/// The text under [`KEY`]: JSON.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Stated {
    version: u32,
    inputs: BTreeMap<String, StatedInput>,
    output: StatedOutput,
    /// Memory: inputs, each with the output that is its value in the next call.
    #[serde(default)]
    states: BTreeMap<String, String>,
    #[serde(default = "one")]
    every: u32,
    #[serde(default = "simple")]
    look: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StatedInput {
    observation: String,
    unit: String,
    #[serde(default = "one")]
    history: u32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StatedOutput {
    name: String,
    actions: String,
    unit: String,
}

fn one() -> u32 {
    1
}

fn simple() -> String {
    "simple".to_owned()
}

/// An input of a network that is fed with observations.
#[derive(Clone, Copy, Debug)]
pub struct Fed {
    /// Observations or memory that it is fed with.
    pub observation: Observation,
    /// Whether colours are 0 to 1 instead of 0 to 255.
    pub is_share: bool,
    /// Observations that it gets, the last ones, the oldest first.
    pub history: usize,
    /// Order of the numbers of pictures.
    pub order: Order,
}

/// Where an input's numbers come from.
#[derive(Clone, Copy, Debug)]
pub enum Source {
    /// Observations.
    Fed(Fed),
    /// The output of this number, in the call before; zeros at first.
    Memory(usize),
}

/// Description of a file's inputs and outputs.
#[derive(Clone, Debug)]
pub struct Description {
    /// Sources of the inputs, in their order.
    pub sources: Vec<Source>,
    /// Number of the output with the actions.
    pub output: usize,
    /// Kind of the actions.
    pub actions: ActionKind,
    /// Steps after which it is asked again.
    pub every: u32,
    /// Pictures that it sees.
    pub pictures: Option<PictureFormat>,
}

impl Description {
    /// The description in a file's metadata.
    ///
    /// # Errors
    /// The fault, and what is allowed, in words.
    pub fn of(model: &OnnxModel) -> Result<Self, String> {
        let text = model.metadata(KEY).ok_or_else(|| {
            format!("its metadata has no entry `{KEY}`, which describes inputs and outputs; `cosfly.onnx.describe` writes it")
        })?;
        let stated: Stated =
            serde_json::from_str(text).map_err(|error| format!("the entry `{KEY}` of its metadata: {error}"))?;
        if stated.version != VERSION {
            return Err(format!("its description has the version {}; this cosfly reads {VERSION}", stated.version));
        }
        within("every", stated.every)?;
        let actions = actions(&stated.output)?;
        let output = place_of(model.outputs(), &stated.output.name, "output")?;
        let of =
            |port: &Port| source(port, &stated, model).map_err(|what| format!("its input `{}`: {what}", port.name));
        let sources = model.inputs().iter().map(of).collect::<Result<Vec<_>, _>>()?;
        let described = stated.inputs.keys().chain(stated.states.keys());
        described.into_iter().try_for_each(|name| place_of(model.inputs(), name, "input").map(drop))?;
        if !sources.iter().any(|source| matches!(source, Source::Fed(_))) {
            return Err("it sees nothing: none of its inputs is fed with an observation".to_owned());
        }
        let pictures = pictures(model, &sources, &stated.look)?;
        Ok(Self { sources, output, actions, every: stated.every, pictures })
    }

    /// Observations that it is fed with, each once.
    pub fn observations(&self) -> Vec<Observation> {
        let mut all: Vec<Observation> = vec![];
        for source in &self.sources {
            if let Source::Fed(Fed { observation, .. }) = source
                && all.iter().all(|known| known.name() != observation.name())
            {
                all.push(*observation);
            }
        }
        all
    }
}

fn within(key: &str, value: u32) -> Result<(), String> {
    match (1..=MOST_STEPS).contains(&value) {
        true => Ok(()),
        false => Err(format!("`{key}` is {value}; it must be 1 to {MOST_STEPS}")),
    }
}

/// Number of an input or output.
fn place_of(ports: &[Port], name: &str, what: &str) -> Result<usize, String> {
    ports.iter().position(|port| port.name == name).ok_or_else(|| {
        let names: Vec<&str> = ports.iter().map(|port| port.name.as_str()).collect();
        format!("its description names the {what} `{name}`; the network has {}", names.join(", "))
    })
}

/// Kind of the actions of an output.
fn actions(output: &StatedOutput) -> Result<ActionKind, String> {
    let kind = ActionKind::ALL.into_iter().find(|kind| kind.name() == output.actions).ok_or_else(|| {
        let names = ActionKind::ALL.map(ActionKind::name).join(", ");
        format!("its output gives `{}`; allowed actions are {names}", output.actions)
    })?;
    match output.unit == kind.unit() {
        true => Ok(kind),
        false => Err(format!(
            "the unit of its output is \"{}\"; that of {} is \"{}\"",
            output.unit,
            kind.name(),
            kind.unit()
        )),
    }
}

fn source(port: &Port, stated: &Stated, model: &OnnxModel) -> Result<Source, String> {
    match (stated.inputs.get(&port.name), stated.states.get(&port.name)) {
        (Some(_), Some(_)) => Err("it stands among `inputs` and among `states`".to_owned()),
        (None, None) => Err("its description names it neither among `inputs` nor among `states`".to_owned()),
        (None, Some(_)) if port.kind != Kind::Float => Err("a memory must be of floats".to_owned()),
        (None, Some(output)) => place_of(model.outputs(), output, "output").map(Source::Memory),
        (Some(input), None) => {
            let observation = Observation::called(&input.observation)?;
            observation.check(&input.unit, port.kind)?;
            within("history", input.history)?;
            let history = input.history as usize;
            let (_, order) = observation.fit(port, history)?;
            Ok(Source::Fed(Fed { observation, is_share: input.unit == "0..1", history, order }))
        }
    }
}

/// The pictures that all inputs together need.
fn pictures(model: &OnnxModel, sources: &[Source], look: &str) -> Result<Option<PictureFormat>, String> {
    let names = PictureLook::ALL.map(|(name, _)| name);
    let look =
        PictureLook::named(look).ok_or_else(|| format!("`look` is `{look}`; allowed are {}", names.join(", ")))?;
    let (mut sizes, mut channels) = (vec![], vec![]);
    for (port, source) in model.inputs().iter().zip(sources) {
        if let Source::Fed(Fed { observation: observation @ Observation::Channel(channel), history, .. }) = source {
            sizes.extend(observation.fit(port, *history)?.0);
            channels.push(channel.name);
        }
    }
    let Some([height, width]) = sizes.first().copied() else { return Ok(None) };
    if sizes.iter().any(|size| *size != [height, width]) {
        return Err(format!("its pictures have the sizes {sizes:?} (rows, columns); all must have one"));
    }
    let channels = ChannelSet::of(|channel| channels.contains(&channel.name));
    let [width, height] = [width as u32, height as u32];
    Ok(Some(PictureFormat { width, height, channels, farthest_m: FARTHEST_M, weather: None, look }))
}
