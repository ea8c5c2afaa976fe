//! `caption`: instructions in Chinese and English, checked against the facts of the trajectory.

mod pictures;

use crate::ports::{self, CAPTIONS, FRAMES, TRAJECTORY};
use crate::{single, traffic};
use cosfly_blobs::OutputSink;
use cosfly_captions::{Caption as Text, CaptionConfig, Facts, Wear, Writer, captions, check, facts};
use cosfly_diagnose::{Diagnostic, Fault, ParameterError, Result};
use cosfly_domain::{BodyKind, PlanOutcome};
use cosfly_experts::artifacts;
use cosfly_figures::Clothes;
use cosfly_film::looks::walk_seed;
use cosfly_frames::Seed;
use cosfly_schema::record::captions_to_bytes;
use cosfly_stage::parameters;
use cosfly_stage::{
    Asks, InputPort, Inputs, ItemRule, Produced, Resources, Stage, StageKind, StagePart, StageProperties, StageRole,
    TaskContext,
};
use cosfly_teacher::{Teacher, TeacherConfig, TeacherFrames, TextRequest, record_of, told};

/// Table of a teacher's parameters.
const TEACHER: &str = "teacher";
/// Estimated tokens of a question without pictures, of a picture, of an answer.
const QUESTION_TOKENS: u64 = 500;
const PICTURE_TOKENS: u64 = 150;
const ANSWER_TOKENS: u64 = 80;

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
        parameters::joined_schema::<CaptionConfig, TeacherConfig>(TEACHER)
    }

    fn ports(&self) -> Vec<InputPort> {
        vec![
            ports::each("trajectories", TRAJECTORY, true, "The trajectories to put into words."),
            InputPort {
                optional: true,
                ..ports::each(
                    "frames",
                    FRAMES,
                    false,
                    "Pictures for a teacher with `frames`: those of all trajectories.",
                )
            },
        ]
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let (config, teacher): (CaptionConfig, TeacherConfig) = parameters::read_joined(given, TEACHER)?;
        let mut inputs = self.ports();
        let is_taught = config.writer == Writer::Teacher;
        if is_taught && teacher.frames != TeacherFrames::None {
            inputs[1].optional = false;
        } else {
            inputs.truncate(1);
        }
        let mut canonical = parameters::canonical(&config);
        if is_taught {
            teacher.check().map_err(|mut refusal| {
                refusal.path.insert(0, TEACHER.to_owned());
                refusal
            })?;
            canonical[TEACHER] = parameters::without(parameters::canonical(&teacher), TeacherConfig::NOT_IN_KEY);
        }
        let properties = StageProperties {
            version: 17,
            parameters: canonical,
            inputs,
            items: ItemRule::PerInput("trajectories"),
            bytes_per_item: 2_000,
            asks: is_taught.then(|| asks(&config, &teacher)),
            resources: Resources { memory_mib: 256, batch: 64 },
            ..StageProperties::new(self.name(), StageRole::Speaks, CAPTIONS)
        };
        let teacher = is_taught.then(|| Teacher::new(teacher));
        Ok(single(CaptionStage { config, teacher, properties }))
    }
}

/// Questions of a flight to a teacher.
fn asks(config: &CaptionConfig, teacher: &TeacherConfig) -> Asks {
    let questions = 2 * config.styles.len() as u64 * u64::from(config.variants_per_style);
    Asks {
        questions,
        most_questions: questions * u64::from(teacher.attempts),
        input_tokens: QUESTION_TOKENS + PICTURE_TOKENS * teacher.frames.count(),
        output_tokens: ANSWER_TOKENS,
        prices: [teacher.budget.input_price, teacher.budget.output_price],
    }
}

struct CaptionStage {
    config: CaptionConfig,
    teacher: Option<Teacher>,
    properties: StageProperties,
}

impl Stage for CaptionStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        let outcome = artifacts::FLIGHT.read(inputs, inputs.one("trajectories")?)?;
        let trajectory = match outcome {
            PlanOutcome::Planned(trajectory) => trajectory,
            PlanOutcome::Rejected { reason, .. } => {
                outputs.put("captions", &captions_to_bytes(&[]))?;
                return Ok(Produced::rejected(reason));
            }
        };
        let followed = traffic::followed(inputs, inputs.one("trajectories")?)?;
        let kind = followed.as_ref().map_or(BodyKind::Pedestrian, |followed| followed.plan.kind);
        if trajectory.track.radius_m == 0.0 || !kind.is_on_foot() {
            // The texts are about people on foot only.
            outputs.put("captions", &captions_to_bytes(&[]))?;
            return Ok(Produced::default());
        }
        let looks = followed.map_or_else(|| walk_seed(&trajectory.track), |followed| Ok(followed.plan.looks))?;
        let outfit = Clothes::draw(&looks).outfit;
        let facts = facts(&trajectory).wearing(self.config.clothes.then(|| Wear::from(&outfit))).of_kind(kind);
        let texts: Vec<Text> = captions(&facts, &self.config, Seed(context.seed));
        texts.iter().try_for_each(|text| check_own(text, &facts))?;
        let Some(teacher) = &self.teacher else {
            outputs.put("captions", &captions_to_bytes(&texts.iter().map(record_of).collect::<Vec<_>>()))?;
            return Ok(Produced::default());
        };
        let pictures = pictures::of(inputs, teacher.config().frames)?;
        let request = TextRequest { teacher, facts: &facts, pictures: &pictures, answers: inputs.answers, context };
        let records = request.texts(&texts)?;
        outputs.put("captions", &captions_to_bytes(&records))?;
        Ok(told(&records))
    }
}

/// The templates' texts say what the trajectory does.
fn check_own(text: &Text, facts: &Facts) -> Result<()> {
    check(&text.text, text.language, facts).map_err(|mismatches| {
        let refusal = Diagnostic::new(
            "caption-mismatch",
            Fault::Bug,
            format!("the text `{}` does not say what the trajectory does", text.text),
        );
        mismatches.iter().fold(refusal, |refusal, mismatch| refusal.because(mismatch))
    })
}
