//! `dataset`: an MCAP log per trajectory (part `logs`), notes per group of walks (`notes`), splits of all flights (`splits`),
//! tables per group (`tables`), a comparison of planners (`planners`), then manifest, card and page over all of them.

use crate::ports::{self, CAPTIONS, DATASET, EXTRAS, FRAMES};
use crate::{group_notes, group_splits, logs, planners, shards};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{ParameterError, Result};
use cosfly_experts::published_towns::PublishedTowns;
use cosfly_fingerprint::Digest;
use cosfly_report::PlannerRow;
use cosfly_schema::DatasetConfig;
use cosfly_schema::tables::ObjectRecord;
use cosfly_stage::parameters;
use cosfly_stage::{
    Artifact, Fan, InputPort, Inputs, Produced, Resources, Sees, Stage, StageKind, StagePart, StageProperties,
    StageRole, Takes, TaskContext,
};
use cosfly_write::{DatasetSource, Shards, write_dataset};
use std::collections::BTreeMap;

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
        vec![towns(), ports::without_pictures(frames(Fan::Gather)), captions(Fan::Gather), extras()]
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let config: DatasetConfig = parameters::read(given)?;
        config.check()?;
        let mut parameters = parameters::without(parameters::canonical(&config), DatasetConfig::NOT_IN_KEY);
        // A new column or table makes manifest and card anew without a raised version.
        parameters["tables"] = Digest::of(cosfly_schema::reference().as_bytes()).short().into();
        let whole = StageProperties {
            version: 21,
            parameters,
            inputs: vec![
                towns(),
                group_splits::policy_port(),
                shards::port(),
                InputPort {
                    fan: Fan::Gather,
                    sees: Sees::Only(&[logs::LOG_BLOB, logs::PREVIEWS_BLOB]),
                    ..logs::port()
                },
                planners::port(),
            ],
            bytes_per_item: 1_000_000,
            files_per_item: 14,
            resources: Resources { memory_mib: 2048, batch: 1 },
            ..StageProperties::new(self.name(), StageRole::Publishes, DATASET)
        };
        let records = |fan| ports::without_pictures(frames(fan));
        Ok(vec![
            logs::part(frames(Fan::Each), captions(Fan::Each), extras()),
            group_notes::part(&config, records(Fan::Group)),
            group_splits::part(&config, towns()),
            shards::part(&config, [records(Fan::Group), captions(Fan::Group), extras()]),
            planners::part(records(Fan::Gather)),
            StagePart { suffix: "", stage: Box::new(DatasetStage { config, properties: whole }) },
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
    let doc =
        "Extras of the same frames: what plugins made (`makes = \"extras\"`), readings of sensors (`use = \"sense\"`).";
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
        // One group after the other: figures of many groups at once would be the most of the memory.
        let mut shards = Shards::default();
        for shard in shards::read(inputs) {
            let (shard, files) = shard?;
            files.iter().try_for_each(|(path, blob)| outputs.link(path, *blob))?;
            shards.add(shard)?;
            context.check_cancelled()?;
        }
        let whole = Whole { inputs, towns: PublishedTowns::of(inputs)?, logs: LogIndex::of(inputs.all("logs")) };
        let config = DatasetConfig { splits: group_splits::policy(inputs)?, ..self.config.clone() };
        let summary = write_dataset(outputs, &config, shards, &whole)?;
        let notes = BTreeMap::from([
            ("flights".to_owned(), format!("{} expert, {} perturbed", summary.experts, summary.perturbed)),
            ("frames".to_owned(), summary.frames.to_string()),
            ("rejected".to_owned(), summary.rejected.to_string()),
            ("mean visibility".to_owned(), summary.mean_visibility()),
        ]);
        Ok(Produced { notes, warnings: summary.warnings, ..Produced::default() })
    }
}

/// Parts that belong to the dataset as a whole.
struct Whole<'a> {
    inputs: &'a Inputs<'a>,
    towns: PublishedTowns,
    logs: LogIndex<'a>,
}

impl DatasetSource for Whole<'_> {
    fn objects(&self) -> Result<Vec<ObjectRecord>> {
        self.towns.objects(self.inputs)
    }

    fn planners(&self) -> Result<Vec<PlannerRow>> {
        planners::read(self.inputs)
    }

    fn picture(&self, trajectory_id: &str, frame: usize) -> Result<Option<Vec<u8>>> {
        self.logs.find(trajectory_id).map_or(Ok(None), |log| logs::preview(self.inputs, log, frame))
    }
}

/// Logs by the ids of their flights: sixteen bytes a log.
struct LogIndex<'a> {
    logs: &'a [Artifact],
    /// First bytes of the digests of names, sorted, and places.
    places: Vec<(u64, u32)>,
}

impl<'a> LogIndex<'a> {
    fn of(logs: &'a [Artifact]) -> Self {
        let place = |(place, log): (usize, &Artifact)| (head(&log.name.to_string()), place as u32);
        let mut places: Vec<_> = logs.iter().enumerate().map(place).collect();
        places.sort_unstable();
        Self { logs, places }
    }

    /// Log of a flight, which is called like its item.
    fn find(&self, trajectory_id: &str) -> Option<&'a Artifact> {
        let wanted = head(trajectory_id);
        let first = self.places.partition_point(|(head, _)| *head < wanted);
        let alike = self.places[first..].iter().take_while(|(head, _)| *head == wanted);
        alike.map(|(_, place)| &self.logs[*place as usize]).find(|log| log.name.to_string() == trajectory_id)
    }
}

fn head(name: &str) -> u64 {
    let digest = Digest::of(name.as_bytes());
    let (heads, _) = digest.0.as_chunks::<8>();
    u64::from_le_bytes(heads[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_stage::{Blobs, ItemId, ItemName, StageName};
    use std::sync::Arc;

    #[test]
    fn a_log_is_found_by_the_id_of_its_flight() {
        let log = |number: u64| {
            let name = ItemName::numbered("p", number).of_stage(&StageName::new("expert", ""));
            let id = ItemId { stage: StageName::new("dataset", "logs"), item: name.clone() };
            Artifact { id, name, blobs: Arc::new(Blobs::default()) }
        };
        let logs: Vec<Artifact> = (0..50).map(log).collect();
        let index = LogIndex::of(&logs);
        for log in &logs {
            assert_eq!(index.find(&log.name.to_string()), Some(log));
        }
        assert_eq!(index.find("expert-p00050"), None);
    }
}
