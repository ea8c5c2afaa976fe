//! `inspect`: examines rendered flights and leaves out what is damaged, more imperfect than allowed, or beyond a quota.

use crate::ports::{self, FRAMES, PACK};
use crate::rejections::{handed_on, reject};
use crate::verdict;
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{ParameterError, Result};
use cosfly_doctor::verdict::InspectConfig;
use cosfly_experts::world::link_town;
use cosfly_schema::{Rejection, RenderedTrajectory};
use cosfly_stage::parameters;
use cosfly_stage::{
    InputPort, Inputs, ItemRule, Produced, Stage, StageKind, StagePart, StageProperties, StageRole, TaskContext,
};

/// Stage kind `inspect`.
pub struct Inspect;

impl StageKind for Inspect {
    fn name(&self) -> &'static str {
        "inspect"
    }

    fn doc(&self) -> &'static str {
        "Examines rendered flights and leaves out what is damaged, more imperfect than allowed, or beyond a quota; twins \
         stay together."
    }

    fn schema(&self) -> serde_json::Value {
        parameters::schema_of::<InspectConfig>()
    }

    fn ports(&self) -> Vec<InputPort> {
        vec![ports::town(), ports::each("frames", FRAMES, false, "The rendered flights.")]
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let config: InspectConfig = parameters::read(given)?;
        if let Some(at) = config.quotas.iter().position(|quota| quota.min_s > quota.max_s) {
            return Err(parameters::refused_at(&format!("quotas[{at}]"), "`min_s` is more than `max_s`"));
        }
        let mut inputs = self.ports();
        inputs.push(verdict::port());
        let kept = StageProperties {
            version: 1,
            // Only the verdict reads parameters.
            parameters: serde_json::json!({}),
            inputs,
            items: ItemRule::PerInput("frames"),
            files_per_item: 0,
            intermediate: &[PACK],
            ..StageProperties::new(self.name(), StageRole::Changes, FRAMES)
        };
        Ok(vec![verdict::part(config), StagePart { suffix: "", stage: Box::new(KeepStage { properties: kept }) }])
    }
}

struct KeepStage {
    properties: StageProperties,
}

impl Stage for KeepStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        let frames = inputs.one("frames")?;
        if let Some(rejected) = handed_on(inputs, outputs, frames)? {
            link_town(inputs, outputs)?;
            return Ok(rejected);
        }
        let verdict = verdict::read(inputs)?;
        let Some(reason) = verdict.get(&frames.name.to_string()) else {
            frames.blobs.iter().try_for_each(|(name, blob)| outputs.link(name, *blob))?;
            return Ok(Produced::default());
        };
        let record = RenderedTrajectory::from_bytes(&inputs.read(frames, "index")?)?;
        let rejection = Rejection {
            trajectory_id: record.trajectory_id,
            stage: context.id.stage.to_string(),
            pedestrian_id: record.pedestrian_id,
            town: record.town.name,
            reason: reason.clone(),
        };
        link_town(inputs, outputs)?;
        reject(outputs, rejection)
    }
}
