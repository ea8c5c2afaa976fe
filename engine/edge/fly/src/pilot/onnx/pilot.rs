//! [`OnnxPilot`]: a network in an episode.

use super::description::{Fed, Source};
use super::observation::{Observation, Order};
use super::policy::OnnxPolicy;
use crate::pilot::answer::PolicyAnswer;
use crate::pilot::seam::{Pilot, PilotFailure};
use cosfly_env::pictures::{PictureBatch, Pictures, Pixels};
use cosfly_env::policies::Knowledge;
use cosfly_env::{Action, Environment, readings};
use cosfly_onnx::{Kind, Tensor, TensorValues};

/// Most letters of what a failed answer says.
const MOST_LETTERS: usize = 300;

/// A network in an episode.
pub struct OnnxPilot {
    policy: OnnxPolicy,
    pictures: Option<(Pictures, PictureBatch)>,
    /// Observations that each input was fed with, or its memory; empty at the beginning of an episode.
    kept: Vec<Vec<f32>>,
    answer: Option<PolicyAnswer>,
}

impl OnnxPilot {
    /// A policy, for one thread.
    pub fn new(policy: &OnnxPolicy) -> Self {
        let pictures = policy.description().pictures.clone().map(|format| {
            let batch = PictureBatch::new(&format, 1);
            (Pictures::new(format, 1), batch)
        });
        let kept = vec![vec![]; policy.description().sources.len()];
        Self { policy: policy.clone(), pictures, kept, answer: None }
    }

    /// The answer to the present observation.
    fn ask(&mut self, environment: &Environment) -> Result<PolicyAnswer, String> {
        if let Some((pictures, batch)) = &mut self.pictures {
            pictures.draw(&[environment], batch, 0);
        }
        let batch = self.pictures.as_ref().map(|it| &it.1);
        let (model, description) = (self.policy.model(), self.policy.description());
        for ((source, kept), port) in description.sources.iter().zip(&mut self.kept).zip(model.inputs()) {
            let count = port.shape.iter().product::<usize>();
            match source {
                Source::Fed(fed) => {
                    let numbers = numbers(fed, environment, batch);
                    // At first the history is the first observation, again and again.
                    kept.drain(..kept.len().min(numbers.len()));
                    while kept.len() < count && !numbers.is_empty() {
                        kept.extend_from_slice(&numbers);
                    }
                }
                Source::Memory(_) => {}
            }
            kept.resize(count, 0.0);
        }
        let inputs = model.inputs().iter().zip(&self.kept).map(|(port, kept)| match port.kind {
            Kind::Float => Tensor::floats(&port.shape, kept.clone()),
            Kind::Whole => Tensor::wholes(&port.shape, kept.iter().map(|number| *number as i64).collect()),
        });
        let outputs = self.policy.run(inputs.collect())?;
        for (source, kept) in description.sources.iter().zip(&mut self.kept) {
            if let Source::Memory(output) = source {
                kept.copy_from_slice(floats(&outputs[*output]));
            }
        }
        let rows = floats(&outputs[description.output]).iter().map(|number| f64::from(*number)).collect();
        PolicyAnswer::of_rows(rows, environment, description.actions)
    }
}

/// Numbers of a tensor of floats; none of another.
fn floats(tensor: &Tensor) -> &[f32] {
    match &tensor.values {
        TensorValues::Floats(values) => values,
        TensorValues::Wholes(_) => &[],
    }
}

/// The present observation, as an input takes it.
fn numbers(fed: &Fed, environment: &Environment, batch: Option<&PictureBatch>) -> Vec<f32> {
    let channel = match fed.observation {
        Observation::State => return environment.observation().features().map(|number| number as f32).to_vec(),
        Observation::Sensor(sensor) => {
            let reading = readings(environment).into_iter().find(|(own, _)| own.name == sensor.name);
            return reading.map_or(vec![], |(_, values)| values.iter().map(|value| *value as f32).collect());
        }
        Observation::Channel(channel) => channel,
    };
    let numbers: Vec<f32> = match batch.and_then(|batch| batch.of(channel)) {
        Some(Pixels::Bytes(bytes)) if fed.is_share => bytes.iter().map(|byte| f32::from(*byte) / 255.0).collect(),
        Some(Pixels::Bytes(bytes)) => bytes.iter().map(|byte| f32::from(*byte)).collect(),
        Some(Pixels::Floats(floats)) => floats.clone(),
        Some(Pixels::Ids(ids)) => ids.iter().map(|id| *id as f32).collect(),
        None => vec![],
    };
    let parts = channel.element().parts();
    match fed.order {
        Order::PartsApart if parts > 1 => {
            (0..parts).flat_map(|part| numbers.iter().skip(part).step_by(parts).copied()).collect()
        }
        _ => numbers,
    }
}

impl Pilot for OnnxPilot {
    fn begin(&mut self, _: &Environment, _: &Knowledge) -> Result<(), String> {
        self.answer = None;
        self.kept.iter_mut().for_each(Vec::clear);
        Ok(())
    }

    fn act(&mut self, environment: &Environment) -> Result<Action, PilotFailure> {
        let every = self.policy.description().every;
        if let Some(action) = self.answer.as_ref().and_then(|answer| answer.action(environment, every)) {
            return Ok(action);
        }
        let answer =
            self.ask(environment).map_err(|rule| PilotFailure::Answer(rule.chars().take(MOST_LETTERS).collect()))?;
        let action = answer.action(environment, every);
        self.answer = Some(answer);
        action.ok_or_else(|| PilotFailure::Answer("the answer is too short for one step".to_owned()))
    }
}
