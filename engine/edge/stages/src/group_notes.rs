//! Part `notes` of a `dataset` stage: notes about the flights of each group of walks, from which the splits are drawn.

use crate::ports::{self, NOTES};
use crate::rejections::rejection;
use cosfly_blobs::OutputSink;
use cosfly_diagnose::Result;
use cosfly_experts::{artifacts, codec};
use cosfly_schema::{DatasetConfig, Rejection, RenderedTrajectory};
use cosfly_stage::{
    Artifact, Fan, InputPort, Inputs, ItemName, ItemRule, Produced, Resources, Stage, StagePart, StageProperties,
    StageRole, TaskContext,
};
use cosfly_write::{FlightNote, GroupName};
use serde::{Deserialize, Serialize};

/// Name of the part, of the port that reads it and of its blob.
pub const NAME: &str = "notes";
/// Letter before the numbers of groups.
const PREFIX: &str = "w";

/// Notes about a group of walks.
#[derive(Serialize, Deserialize)]
pub struct GroupNotes {
    /// Its flights, in the order of the pictures.
    pub flights: Vec<FlightNote>,
    /// Its items without a flight.
    pub rejections: Vec<Rejection>,
    /// All of its pictures, those of rejected items as well: item, and digest of the town.
    pub pictures: Vec<(String, String)>,
}

/// Items of the parts that work group by group: the walks of the port `frames`.
pub fn items(config: &DatasetConfig) -> ItemRule {
    ItemRule::Groups { port: "frames", prefix: PREFIX, size: u64::from(config.walks_per_file) }
}

/// Name of a group in files, from the name of its item.
pub fn group_name(item: &ItemName) -> GroupName {
    let stage = item.stage().map(|stage| stage.recipe_name().to_owned());
    GroupName { stage, number: item.number().unwrap_or_default() }
}

/// The part of a stage that meets pictures at the port `frames`.
pub fn part(config: &DatasetConfig, frames: InputPort) -> StagePart {
    let window = config.windows.shape().size();
    let properties = StageProperties {
        version: 2,
        parameters: serde_json::json!({ "window": window }),
        inputs: vec![ports::group(frames)],
        items: items(config),
        bytes_per_item: 1_000_000,
        resources: Resources { memory_mib: 2048, batch: 1 },
        ..StageProperties::new("dataset", StageRole::Serves, NOTES)
    };
    StagePart { suffix: NAME, stage: Box::new(NotesStage { window, properties }) }
}

/// Port through which the stage and its parts read this part.
pub fn port() -> InputPort {
    ports::sibling(NAME, NOTES, Fan::Gather, "Notes about the flights of all groups: the part of the same stage.")
}

/// Notes at the port of [`port`], group by group, each read when it is its turn.
pub fn read(inputs: &Inputs<'_>) -> impl Iterator<Item = Result<GroupNotes>> {
    inputs.all(NAME).iter().map(|artifact| codec::decode(NOTES, &inputs.read(artifact, NAME)?))
}

struct NotesStage {
    window: usize,
    properties: StageProperties,
}

impl Stage for NotesStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        let mut notes = GroupNotes { flights: vec![], rejections: vec![], pictures: vec![] };
        for frames in inputs.all("frames") {
            context.check_cancelled()?;
            let town_digest = town_digest(frames);
            notes.pictures.push((frames.id.to_string(), town_digest.clone()));
            match rejection(inputs, frames)? {
                Some(rejection) => notes.rejections.push(rejection),
                None => {
                    let record = RenderedTrajectory::from_bytes(&inputs.read(frames, "index")?)?;
                    notes.flights.push(FlightNote::of(&record, self.window, town_digest));
                }
            }
        }
        outputs.put(NAME, &codec::encode(NOTES, &notes)?)?;
        Ok(Produced::default())
    }
}

/// Digest of the town that pictures show, hex digits.
fn town_digest(frames: &Artifact) -> String {
    frames.blobs.get(artifacts::TOWN.blob).map(|blob| blob.digest.to_string()).unwrap_or_default()
}
