//! `caption`: instructions in Chinese and English, checked against the facts of the trajectory.

use crate::ports::{self, CAPTIONS, TRAJECTORY};
use crate::walks::walk_seed;
use crate::{codec, parameters, single, traffic};
use cosfly_blobs::OutputSink;
use cosfly_captions::{Caption as Text, CaptionConfig, Wear, captions, check, facts};
use cosfly_diagnose::{Diagnostic, Fault, ParameterError, Result};
use cosfly_frames::Seed;
use cosfly_planner::PlanOutcome;
use cosfly_render::Clothes;
use cosfly_schema::CaptionRecord;
use cosfly_schema::record::captions_to_bytes;
use cosfly_stage::{InputPort, Inputs, ItemRule, Produced, Stage, StageKind, StagePart, StageProperties, TaskContext};

/// Stage kind `caption`.
pub struct Caption;

impl StageKind for Caption {
    fn name(&self) -> &'static str {
        "caption"
    }

    fn doc(&self) -> &'static str {
        "Writes instructions in Chinese and English from facts of the trajectory, every number and direction checked."
    }

    fn schema(&self) -> serde_json::Value {
        parameters::schema_of::<CaptionConfig>()
    }

    fn ports(&self) -> Vec<InputPort> {
        vec![ports::each("trajectories", TRAJECTORY, true, "The trajectories to put into words.")]
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let config: CaptionConfig = parameters::read(given)?;
        let properties = StageProperties {
            kind: self.name().into(),
            version: 3,
            parameters: parameters::canonical(&config),
            sources: vec![],
            inputs: self.ports(),
            artifact: CAPTIONS,
            items: ItemRule::PerInput("trajectories"),
            bytes_per_item: 2_000,
            intermediate: &[],
        };
        Ok(single(CaptionStage { config, properties }))
    }
}

struct CaptionStage {
    config: CaptionConfig,
    properties: StageProperties,
}

impl Stage for CaptionStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        let outcome: PlanOutcome = codec::decode(TRAJECTORY, &inputs.read(inputs.one("trajectories")?, "trajectory")?)?;
        let trajectory = match outcome {
            PlanOutcome::Planned(trajectory) => trajectory,
            PlanOutcome::Rejected { reason, .. } => {
                outputs.put("captions", &captions_to_bytes(&[]))?;
                return Ok(Produced::rejected(reason));
            }
        };
        let followed = traffic::followed(inputs, inputs.one("trajectories")?)?;
        let is_person = followed.as_ref().is_none_or(|followed| followed.plan.kind.is_person());
        if trajectory.track.radius_m == 0.0 || !is_person {
            // The texts are about walkers only.
            outputs.put("captions", &captions_to_bytes(&[]))?;
            return Ok(Produced::default());
        }
        let looks = followed.map_or_else(|| walk_seed(&trajectory.track), |followed| Ok(followed.plan.looks))?;
        let outfit = Clothes::draw(&looks).outfit;
        let facts = facts(&trajectory).wearing(self.config.clothes.then(|| Wear::from(&outfit)));
        let texts: Vec<Text> = captions(&facts, &self.config, Seed(context.seed));
        let mut records = Vec::with_capacity(texts.len());
        for text in texts {
            check(&text.text, text.language, &facts).map_err(|mismatches| {
                let refusal = Diagnostic::new(
                    "caption-mismatch",
                    Fault::Bug,
                    format!("the text `{}` does not say what the trajectory does", text.text),
                );
                mismatches.iter().fold(refusal, |refusal, mismatch| refusal.because(mismatch))
            })?;
            records.push(CaptionRecord {
                language: text.language.code().to_owned(),
                style: text.style.name().to_owned(),
                text: text.text,
            });
        }
        outputs.put("captions", &captions_to_bytes(&records))?;
        Ok(Produced::default())
    }
}
