//! Part `tables` of a `dataset` stage: tables and logs of each group of walks.

use crate::plugin::EXTRA;
use crate::ports::{self, EXTRAS, LOG, SHARD};
use crate::rejections::rejection;
use crate::{group_notes, group_splits, logs};
use cosfly_blobs::OutputSink;
use cosfly_captions::sight::Landmarks;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::Town;
use cosfly_experts::{artifacts, codec};
use cosfly_fingerprint::Digest;
use cosfly_schema::extras::Extra;
use cosfly_schema::{CaptionRecord, DatasetConfig, LogRecord, PreviewStrip, Rejection, RenderedTrajectory};
use cosfly_stage::parameters;
use cosfly_stage::{
    Artifact, Blobs, Fan, InputPort, Inputs, ItemName, Produced, Resources, Stage, StagePart, StageProperties,
    StageRole, TaskContext,
};
use cosfly_write::{GroupFlights, GroupSource, PublishedLog, Shard, write_shard};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Name of the part and of the port that reads it.
const NAME: &str = "tables";
/// Blob with the figures of the group; all other blobs are files of the dataset.
const FIGURES: &str = "shard";

/// The part of a stage that meets pictures, captions and extras at `inputs`.
pub fn part(config: &DatasetConfig, inputs: [InputPort; 3]) -> StagePart {
    let config = DatasetConfig {
        windows: config.windows,
        frames_per_file: config.frames_per_file,
        walks_per_file: config.walks_per_file,
        ..DatasetConfig::default()
    };
    let canonical = parameters::canonical(&config);
    let mut inputs: Vec<InputPort> = inputs.map(ports::group).into();
    inputs.extend([ports::group(logs::port()), group_splits::port()]);
    let properties = StageProperties {
        version: 18,
        parameters: serde_json::json!({
            "windows": canonical["windows"],
            "frames_per_file": canonical["frames_per_file"],
            // A new column or table makes the tables anew without a raised version.
            "tables": Digest::of(cosfly_schema::reference().as_bytes()).short(),
        }),
        inputs,
        items: group_notes::items(&config),
        bytes_per_item: 300_000,
        bytes_per_frame: 2_000,
        files_per_item: 24,
        resources: Resources { memory_mib: 2048, batch: 1 },
        ..StageProperties::new("dataset", StageRole::Serves, SHARD)
    };
    StagePart { suffix: NAME, stage: Box::new(TablesStage { config, properties }) }
}

/// Port through which the stage reads its part.
pub fn port() -> InputPort {
    ports::sibling(NAME, SHARD, Fan::Gather, "Tables and logs of all groups: the part of the same stage.")
}

/// Figures and files of the groups at the port of [`port`], each read when it is its turn.
pub fn read(inputs: &Inputs<'_>) -> impl Iterator<Item = Result<(Shard, Blobs)>> {
    let read = |artifact: &Artifact| -> Result<(Shard, Blobs)> {
        let shard = codec::decode(SHARD, &inputs.read(artifact, FIGURES)?)?;
        let files = artifact.blobs.iter().filter(|(name, _)| *name != FIGURES);
        Ok((shard, files.map(|(name, blob)| (name.clone(), *blob)).collect()))
    };
    inputs.all(NAME).iter().map(read)
}

struct TablesStage {
    config: DatasetConfig,
    properties: StageProperties,
}

impl Stage for TablesStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        let captions: BTreeMap<&ItemName, &Artifact> =
            inputs.all("captions").iter().map(|artifact| (&artifact.name, artifact)).collect();
        // Extras are items of the same names as the frames that they were made of.
        let mut extras: BTreeMap<&ItemName, Vec<&Artifact>> = BTreeMap::new();
        for artifact in inputs.all("extras").iter().filter(|artifact| artifact.blobs.contains_key(EXTRA)) {
            extras.entry(&artifact.id.item).or_default().push(artifact);
        }
        let plan = group_splits::read(inputs, &context.id.item)?;
        let left_out: BTreeMap<&str, &Rejection> =
            plan.left_out.iter().map(|it| (it.trajectory_id.as_str(), it)).collect();
        let mut gathered = Gathered { inputs, flights: vec![] };
        let (mut published, mut rejections) = (vec![], vec![]);
        for (frames, log) in inputs.all("frames").iter().zip(inputs.all("logs")) {
            if let Some(rejection) = rejection(inputs, log)? {
                rejections.push(rejection);
                continue;
            }
            let record: Option<LogRecord> = codec::decode(LOG, &inputs.read(log, "log")?)?;
            let record = record.ok_or_else(|| {
                Diagnostic::new("dataset-log", Fault::Bug, format!("the log of `{}` has no record", log.name))
            })?;
            if let Some(left_out) = left_out.get(record.trajectory_id.as_str()) {
                rejections.push((*left_out).clone());
                continue;
            }
            let channels = logs::channels_of(inputs, log)?;
            published.push(PublishedLog { record, blob: log.blobs[logs::LOG_BLOB], channels });
            // One weather of a paired rendering has the captions of its flight.
            let of_flight = || captions.get(&frames.name.without_variant()?);
            let captions = captions.get(&frames.name).or_else(of_flight).copied();
            let extras = extras.remove(&frames.name).unwrap_or_default();
            gathered.flights.push(Flight { frames, log, captions, extras });
        }
        let keep_going = || context.check_cancelled();
        let flights = GroupFlights::new(&self.config, &plan, &published, &gathered, &keep_going)?;
        let shard = write_shard(outputs, &self.config, &flights, rejections)?;
        outputs.put(FIGURES, &codec::encode(SHARD, &shard)?)?;
        Ok(Produced::default())
    }
}

/// Artifacts of one flight.
struct Flight<'a> {
    frames: &'a Artifact,
    log: &'a Artifact,
    captions: Option<&'a Artifact>,
    extras: Vec<&'a Artifact>,
}

/// Inputs of a group, read one flight at a time.
struct Gathered<'a> {
    inputs: &'a Inputs<'a>,
    flights: Vec<Flight<'a>>,
}

impl GroupSource for Gathered<'_> {
    fn trajectory(&self, index: usize) -> Result<RenderedTrajectory> {
        RenderedTrajectory::from_bytes(&self.inputs.read(self.flights[index].frames, "index")?)
    }

    fn captions(&self, index: usize) -> Result<Vec<CaptionRecord>> {
        logs::captions_of(self.inputs, self.flights[index].captions)
    }

    fn landmarks(&self, index: usize) -> Result<Arc<Landmarks>> {
        self.inputs.decoded(self.flights[index].frames, artifacts::TOWN.blob, |bytes| {
            artifacts::TOWN.decode(bytes).map(|town: Town| Landmarks::of(&town))
        })
    }

    fn extras(&self, index: usize) -> Result<Vec<Extra>> {
        let read = |artifact: &&Artifact| codec::decode(EXTRAS, &self.inputs.read(artifact, EXTRA)?);
        self.flights[index].extras.iter().map(read).collect()
    }

    fn previews(&self, index: usize) -> Result<PreviewStrip> {
        logs::previews(self.inputs, self.flights[index].log)
    }
}
