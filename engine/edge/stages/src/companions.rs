//! Part `companions` of a `plan` stage: the walks that stay nearest to a followed one. An item of its own per flight, so that
//! one more walker plans no flight anew whose companions stay the same.

use crate::ports::{self, COMPANIONS};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_experts::artifacts;
use cosfly_experts::world::check_same_town;
use cosfly_flight::companions::{NamedTrack, nearest};
use cosfly_frames::TargetTrack;
use cosfly_stage::{
    Artifact, InputPort, Inputs, ItemRule, PortSource, Produced, Resources, Stage, StagePart, StageProperties,
    StageRole, TaskContext,
};

/// Name of the part, of the port that reads it and of its blob.
const NAME: &str = artifacts::COMPANIONS.blob;

/// The part of a stage whose flights have `count` companions each and follow the walks at port `paths`.
pub fn part(count: u32, paths: InputPort, others: InputPort) -> StagePart {
    let properties = StageProperties {
        version: 1,
        parameters: serde_json::json!({ "companions": count }),
        inputs: vec![ports::town(), paths, others],
        items: ItemRule::PerInput("walks"),
        bytes_per_frame: 40 * u64::from(count),
        resources: Resources { memory_mib: 512, batch: 4 },
        ..StageProperties::new("plan", StageRole::Serves, COMPANIONS)
    };
    StagePart { suffix: NAME, stage: Box::new(CompanionsStage { count: count as usize, properties }) }
}

/// Port through which the stage reads its part.
pub fn port(optional: bool) -> InputPort {
    let doc = "The companions of each flight: the part of the same stage.";
    InputPort { optional, source: PortSource::Sibling(NAME), ..ports::each(NAME, COMPANIONS, false, doc) }
}

/// Companions at the port of [`port`]; none where it is not connected.
pub fn read(inputs: &Inputs<'_>) -> Result<Vec<NamedTrack>> {
    let artifact = inputs.all(NAME).first();
    artifact.map_or(Ok(vec![]), |artifact| artifacts::COMPANIONS.read(inputs, artifact))
}

struct CompanionsStage {
    count: usize,
    properties: StageProperties,
}

impl Stage for CompanionsStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, _: &TaskContext) -> Result<Produced> {
        let chosen = if self.count == 0 { vec![] } else { self.choose(inputs)? };
        artifacts::COMPANIONS.put(outputs, &chosen)?;
        Ok(Produced::default())
    }
}

impl CompanionsStage {
    fn choose(&self, inputs: &Inputs<'_>) -> Result<Vec<NamedTrack>> {
        check_same_town(inputs, "walks")?;
        check_same_town(inputs, "others")?;
        let own = inputs.one("walks")?;
        let track = walk(inputs, own)?;
        let mut others = vec![];
        for artifact in inputs.all("others").iter().filter(|it| it.id != own.id) {
            let walk = walk(inputs, artifact)?;
            if (walk.len(), walk.dt_s) != (track.len(), track.dt_s) {
                return Err(differing((own, &track), (artifact, &walk)));
            }
            others.push((artifact.name.to_string(), walk));
        }
        if others.len() < self.count {
            let message = format!(
                "`targets.companions` is {}, but `inputs.others` brings {} walks beside `{}`",
                self.count,
                others.len(),
                own.id
            );
            return Err(Diagnostic::new("companions-few", Fault::Recipe, message)
                .hint("raise the walkers' `count`, or ask for fewer companions"));
        }
        Ok(nearest(&track, others, self.count))
    }
}

fn walk(inputs: &Inputs<'_>, artifact: &Artifact) -> Result<TargetTrack> {
    Ok(artifacts::WALK.shared(inputs, artifact)?.track.clone())
}

/// Refusal of a walk with another number of steps, or another time between them.
fn differing((own, track): (&Artifact, &TargetTrack), (other, walk): (&Artifact, &TargetTrack)) -> Box<Diagnostic> {
    let message = format!(
        "`{}` has {} steps of {} s, `{}` has {} of {} s: they cannot be companions",
        other.id,
        walk.len(),
        walk.dt_s,
        own.id,
        track.len(),
        track.dt_s
    );
    Diagnostic::new("companions-differ", Fault::Recipe, message)
        .hint("connect `inputs.others` to walkers with the same `frames` and `dt_s`")
}
