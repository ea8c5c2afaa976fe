//! Part `logs` of a `dataset` stage: one MCAP log per trajectory.

use crate::ports::{self, EXTRAS, LOG, PACK};
use crate::rejections::handed_on;
use crate::sense::READINGS;
use cosfly_blobs::{BlobPart, OutputSink, PassingFile};
use cosfly_diagnose::Result;
use cosfly_domain::ChannelSet;
use cosfly_experts::codec;
use cosfly_experts::world::world_of;
use cosfly_schema::extras::Extra;
use cosfly_schema::record::captions_from_bytes;
use cosfly_schema::{CaptionRecord, PreviewStrip, RenderedTrajectory};
use cosfly_stage::{
    Artifact, InputPort, Inputs, ItemRule, PortSource, Produced, Resources, Sees, Stage, StagePart, StageProperties,
    StageRole, TaskContext,
};
use cosfly_write::{FramePackReader, check_clothes, write_log};
use std::io::BufReader;

/// Name of the part and of the port that reads it.
const NAME: &str = "logs";

/// Blob of a log's channels, where there are more than those of every frame.
const CHANNELS_BLOB: &str = "channels";
/// Kind of the blob.
const CHANNELS: &str = "channels/1";

/// Blob with the log itself.
pub const LOG_BLOB: &str = "mcap";
/// Blob with the places of the colour previews in the log, which has every picture once.
pub const PREVIEWS_BLOB: &str = "previews";
/// Kind of the blob.
const PREVIEWS: &str = "preview-places/1";

/// The part of a stage that meets pictures at `frames`, their captions at `captions` and all that was made of them at `extras`, item by
/// item.
pub fn part(frames: InputPort, captions: InputPort, extras: InputPort) -> StagePart {
    // What plugins made is in no log: another version of a plugin writes no log anew.
    let extras = InputPort { sees: Sees::Only(&[READINGS]), ..ports::group(extras) };
    let properties = StageProperties {
        version: 10,
        // Logs read no parameter: another title or split rewrites no log.
        parameters: serde_json::json!({}),
        inputs: vec![frames, captions, extras],
        items: ItemRule::PerInput("frames"),
        files_per_item: 3,
        resources: Resources { memory_mib: 2048, batch: 1 },
        ..StageProperties::new("dataset", StageRole::Serves, LOG)
    };
    StagePart { suffix: NAME, stage: Box::new(LogStage { properties }) }
}

/// Port through which the stage reads its part.
pub fn port() -> InputPort {
    InputPort {
        source: PortSource::Sibling(NAME),
        ..ports::gather(NAME, LOG, false, "The logs: the part of the same stage.")
    }
}

/// Captions in an artifact; none where there is no artifact.
pub fn captions_of(inputs: &Inputs<'_>, artifact: Option<&Artifact>) -> Result<Vec<CaptionRecord>> {
    artifact.map_or(Ok(vec![]), |artifact| captions_from_bytes(&inputs.read(artifact, "captions")?))
}

/// Channels of a log.
pub fn channels_of(inputs: &Inputs<'_>, log: &Artifact) -> Result<ChannelSet> {
    match log.blobs.contains_key(CHANNELS_BLOB) {
        true => codec::decode(CHANNELS, &inputs.read(log, CHANNELS_BLOB)?),
        false => Ok(ChannelSet::default()),
    }
}

/// Colour previews of a log, by frame; none where previews are off.
pub fn previews(inputs: &Inputs<'_>, log: &Artifact) -> Result<PreviewStrip> {
    let places: Vec<BlobPart> = codec::decode(PREVIEWS, &inputs.read(log, PREVIEWS_BLOB)?)?;
    let jpegs = places.iter().map(|place| inputs.read_part(log, LOG_BLOB, place));
    Ok(PreviewStrip { jpegs: jpegs.collect::<Result<_>>()? })
}

/// Colour preview of one frame of a log.
pub fn preview(inputs: &Inputs<'_>, log: &Artifact, frame: usize) -> Result<Option<Vec<u8>>> {
    let places: Vec<BlobPart> = codec::decode(PREVIEWS, &inputs.read(log, PREVIEWS_BLOB)?)?;
    places.get(frame).map(|place| inputs.read_part(log, LOG_BLOB, place)).transpose()
}

struct LogStage {
    properties: StageProperties,
}

impl Stage for LogStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        let frames = inputs.one("frames")?;
        if let Some(rejected) = handed_on(inputs, outputs, frames)? {
            return Ok(rejected);
        }
        let record = RenderedTrajectory::from_bytes(&inputs.read(frames, "index")?)?;
        let captions = captions_of(inputs, inputs.all("captions").first())?;
        check_clothes(&record, &captions)?;
        let readings = inputs.all("extras").iter().filter(|artifact| artifact.blobs.contains_key(READINGS));
        let readings: Vec<Extra> =
            readings.map(|artifact| codec::decode(EXTRAS, &inputs.read(artifact, READINGS)?)).collect::<Result<_>>()?;
        let world = world_of(inputs, frames)?;
        let mut pack = FramePackReader::new(BufReader::new(PassingFile::new(inputs.open(frames, PACK)?)))?;
        let mut log = None;
        outputs.stream(LOG_BLOB, &mut |file| {
            let keep_going = || context.check_cancelled();
            log = Some(write_log(&mut *file, &record, &mut pack, &captions, &readings, &world.town, &keep_going)?);
            Ok(())
        })?;
        let (log, previews) = log.map(|log| (log.record, log.previews)).unzip();
        outputs.put("log", &codec::encode(LOG, &log)?)?;
        let channels = &pack.header().channels;
        if !channels.is_default() {
            outputs.put(CHANNELS_BLOB, &codec::encode(CHANNELS, channels)?)?;
        }
        outputs.put(PREVIEWS_BLOB, &codec::encode(PREVIEWS, &previews.unwrap_or_default())?)?;
        Ok(Produced::default())
    }
}
