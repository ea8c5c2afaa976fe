//! `dataset`: one MCAP log per trajectory (part `logs`) and a comparison of planners (part `planners`), then tables, manifest
//! and card over all of them.

use crate::plugins::stage::EXTRA;
use crate::ports::{self, CAPTIONS, DATASET, EXTRAS, FRAMES, LOG};
use crate::published_towns::PublishedTowns;
use crate::rejections::rejection;
use crate::{codec, logs, parameters, planners};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, ParameterError, Result};
use cosfly_fingerprint::Digest;
use cosfly_report::PlannerRow;
use cosfly_schema::extras::Extra;
use cosfly_schema::tables::ObjectRecord;
use cosfly_schema::{CaptionRecord, DatasetConfig, LogRecord, PreviewStrip, Rejection, RenderedTrajectory, TownLayout};
use cosfly_stage::{
    Artifact, Fan, InputPort, Inputs, ItemName, ItemRule, Produced, Stage, StageKind, StagePart, StageProperties,
    Takes, TaskContext,
};
use cosfly_write::{DatasetSource, PublishedLog, write_dataset};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Stage kind `dataset`.
pub struct Dataset;

impl StageKind for Dataset {
    fn name(&self) -> &'static str {
        "dataset"
    }

    fn doc(&self) -> &'static str {
        "Packs everything as a dataset: Parquet tables, an MCAP log per trajectory, a Croissant manifest, a card."
    }

    fn schema(&self) -> serde_json::Value {
        parameters::schema_of::<DatasetConfig>()
    }

    fn ports(&self) -> Vec<InputPort> {
        vec![towns(), frames(Fan::Gather), captions(Fan::Gather), extras()]
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let config: DatasetConfig = parameters::read(given)?;
        config.check()?;
        let mut inputs: Vec<InputPort> = self.ports();
        inputs.push(logs::port());
        inputs.push(planners::port());
        let mut parameters = parameters::canonical(&config);
        // A new column or table makes the dataset anew without a raised version.
        parameters["tables"] = Digest::of(cosfly_schema::reference().as_bytes()).short().into();
        let gather = StageProperties {
            kind: self.name().into(),
            version: 8,
            parameters,
            sources: vec![],
            inputs,
            artifact: DATASET,
            items: ItemRule::One,
            bytes_per_item: 10_000_000,
        };
        Ok(vec![
            logs::part(frames(Fan::Each), captions(Fan::Each)),
            planners::part(frames(Fan::Gather)),
            StagePart { suffix: "", stage: Box::new(DatasetStage { config, properties: gather }) },
        ])
    }
}

fn towns() -> InputPort {
    InputPort { fan: Fan::Gather, takes: Takes::Named, doc: "The towns that the pictures show.", ..ports::town() }
}

/// Port of pictures of several towns; each flight is named after the stage that it comes from.
fn frames(fan: Fan) -> InputPort {
    let doc = "The rendered trajectories, of one town or of several.";
    InputPort { fan, takes: Takes::Distinct, ..ports::each("frames", FRAMES, false, doc) }
}

fn captions(fan: Fan) -> InputPort {
    let port = ports::each("captions", CAPTIONS, false, "Their captions.");
    InputPort { fan, takes: Takes::Distinct, optional: true, ..port }
}

fn extras() -> InputPort {
    let doc = "What plugins made of the same frames (`makes = \"extras\"`): annotations, tables, files.";
    InputPort { optional: true, ..ports::gather("extras", EXTRAS, true, doc) }
}

struct DatasetStage {
    config: DatasetConfig,
    properties: StageProperties,
}

impl Stage for DatasetStage {
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
        let mut gathered = Gathered { inputs, towns: PublishedTowns::of(inputs)?, flights: vec![] };
        let (mut published, mut rejections): (Vec<PublishedLog>, Vec<Rejection>) = (vec![], vec![]);
        for (frames, log) in inputs.all("frames").iter().zip(inputs.all("logs")) {
            if let Some(rejection) = rejection(inputs, log)? {
                rejections.push(rejection);
                continue;
            }
            let record: Option<LogRecord> = codec::decode(LOG, &inputs.read(log, "log")?)?;
            let record = record.ok_or_else(|| {
                Diagnostic::new("dataset-log", Fault::Bug, format!("the log of `{}` has no record", log.name))
            })?;
            let channels = logs::channels_of(inputs, log)?;
            published.push(PublishedLog { record, blob: log.blobs["mcap"], channels });
            // One weather of a paired rendering has the captions of its flight.
            let of_flight = || captions.get(&frames.name.without_variant()?);
            let captions = captions.get(&frames.name).or_else(of_flight).copied();
            let extras = extras.remove(&frames.name).unwrap_or_default();
            gathered.flights.push(Flight { frames, log, captions, extras });
        }
        if published.is_empty() {
            return Err(nothing_left(&rejections));
        }
        let summary =
            write_dataset(outputs, &self.config, &published, &gathered, &rejections, &|| context.check_cancelled())?;
        let flights = summary.experts + summary.perturbed;
        let notes = BTreeMap::from([
            ("flights".to_owned(), format!("{} expert, {} perturbed", summary.experts, summary.perturbed)),
            ("frames".to_owned(), summary.frames.to_string()),
            ("rejected".to_owned(), summary.rejected.to_string()),
            ("mean visibility".to_owned(), format!("{:.3}", summary.visibility_sum / flights.max(1) as f64)),
        ]);
        Ok(Produced { notes, ..Produced::default() })
    }
}

/// Refusal of a dataset without a flight, with the first reasons.
fn nothing_left(rejections: &[Rejection]) -> Box<Diagnostic> {
    let refusal =
        Diagnostic::new("dataset-empty", Fault::Input, "every trajectory was rejected: there is nothing to publish");
    let refusal = rejections
        .iter()
        .take(3)
        .fold(refusal, |refusal, rejection| {
            refusal.because(format!("`{}`: {}", rejection.trajectory_id, rejection.reason))
        })
        .hint("the planner found no safe view of any target: look at the reasons, loosen the limits of the `muco` stage, or choose other walks (another `seed`) or another town");
    if rejections.iter().any(|rejection| ["m/s^2", "m/s^3"].iter().any(|unit| rejection.reason.contains(unit))) {
        return refusal.hint("flights of a planner that bounds no acceleration or jerk (`paper.make_flyable = false`, say) are published with `limits.require_kinematics = false`");
    }
    refusal
}

/// Artifacts of one flight.
struct Flight<'a> {
    frames: &'a Artifact,
    log: &'a Artifact,
    captions: Option<&'a Artifact>,
    extras: Vec<&'a Artifact>,
}

/// Inputs of a dataset, read one flight at a time.
struct Gathered<'a> {
    inputs: &'a Inputs<'a>,
    towns: PublishedTowns,
    flights: Vec<Flight<'a>>,
}

impl DatasetSource for Gathered<'_> {
    fn trajectory(&self, index: usize) -> Result<RenderedTrajectory> {
        RenderedTrajectory::from_bytes(&self.inputs.read(self.flights[index].frames, "index")?)
    }

    fn captions(&self, index: usize) -> Result<Vec<CaptionRecord>> {
        logs::captions_of(self.inputs, self.flights[index].captions)
    }

    fn extras(&self, index: usize) -> Result<Vec<Extra>> {
        let read = |artifact: &&Artifact| codec::decode(EXTRAS, &self.inputs.read(artifact, EXTRA)?);
        self.flights[index].extras.iter().map(read).collect()
    }

    fn objects(&self) -> Result<Vec<ObjectRecord>> {
        self.towns.objects(self.inputs)
    }

    fn layout(&self, index: usize) -> Result<Arc<TownLayout>> {
        self.towns.layout(self.flights[index].frames)
    }

    fn planners(&self) -> Result<Vec<PlannerRow>> {
        planners::read(self.inputs)
    }

    fn previews(&self, index: usize) -> Result<PreviewStrip> {
        PreviewStrip::from_bytes(&self.inputs.read(self.flights[index].log, "previews")?)
    }
}
