//! Part `splits` of a `dataset` stage: the splits of all flights at once, in a blob of its own for each group of walks, so
//! that a group whose splits stay keeps its tables.

use crate::group_notes::{self, GroupNotes};
use crate::ports::{self, SPLITS};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_experts::codec;
use cosfly_experts::published_towns::PublishedTowns;
use cosfly_fingerprint::canonical_json;
use cosfly_schema::DatasetConfig;
use cosfly_schema::config::SplitShares;
use cosfly_stage::parameters;
use cosfly_stage::{
    Fan, InputPort, Inputs, ItemName, Produced, Resources, Sees, Stage, StagePart, StageProperties, StageRole,
    TaskContext,
};
use cosfly_write::{GroupPlan, nothing_left, plan_groups};
use std::collections::BTreeMap;

/// Name of the part and of the port that reads it.
const NAME: &str = "splits";
/// Blob with the policy, JSON; all other blobs are called like the groups.
const POLICY: &str = "policy";

/// Rejections that the refusal of a dataset without a flight looks at.
const MOST_REASONS: usize = 1000;

/// The part of a stage that gathers towns at the port `town`.
pub fn part(config: &DatasetConfig, towns: InputPort) -> StagePart {
    let config = DatasetConfig { splits: config.splits.clone(), windows: config.windows, ..DatasetConfig::default() };
    let parameters = parameters::canonical(&config);
    let properties = StageProperties {
        version: 2,
        parameters: serde_json::json!({ "splits": parameters["splits"], "windows": parameters["windows"] }),
        inputs: vec![towns, group_notes::port()],
        bytes_per_item: 100_000,
        files_per_item: 2,
        resources: Resources { memory_mib: 2048, batch: 1 },
        ..StageProperties::new("dataset", StageRole::Serves, SPLITS)
    };
    StagePart { suffix: NAME, stage: Box::new(SplitsStage { config, properties }) }
}

/// Port through which an item of the stage reads the plan of its own group.
pub fn port() -> InputPort {
    let doc = "The splits of the flights of the group: the part of the same stage.";
    InputPort { sees: Sees::Own, ..ports::sibling(NAME, SPLITS, Fan::Broadcast, doc) }
}

/// Port through which the stage reads the policy of all splits.
pub fn policy_port() -> InputPort {
    let doc = "The policy of the splits: the part of the same stage.";
    InputPort { sees: Sees::Only(&[POLICY]), ..ports::sibling(NAME, SPLITS, Fan::Broadcast, doc) }
}

/// Policy at the port of [`policy_port`], with the areas of all towns.
pub fn policy(inputs: &Inputs<'_>) -> Result<SplitShares> {
    serde_json::from_slice(&inputs.read(inputs.one(NAME)?, POLICY)?).map_err(|error| {
        Diagnostic::new("artifact-decode", Fault::Input, "could not decode the policy of the splits").because(error)
    })
}

/// Plan of the group `item` at the port of [`port`].
pub fn read(inputs: &Inputs<'_>, item: &ItemName) -> Result<GroupPlan> {
    codec::decode(SPLITS, &inputs.read(inputs.one(NAME)?, &item.to_string())?)
}

struct SplitsStage {
    config: DatasetConfig,
    properties: StageProperties,
}

impl Stage for SplitsStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        let towns = PublishedTowns::of(inputs)?;
        let items: Vec<&ItemName> = inputs.all(group_notes::NAME).iter().map(|artifact| &artifact.id.item).collect();
        let (mut groups, mut rejections, mut pictures) = (vec![], vec![], BTreeMap::new());
        for (item, group) in items.iter().zip(group_notes::read(inputs)) {
            context.check_cancelled()?;
            let GroupNotes { flights, rejections: more, pictures: shown } = group?;
            groups.push((group_notes::group_name(item), flights));
            rejections.extend(more.into_iter().take(MOST_REASONS.saturating_sub(rejections.len())));
            // One picture of each town is enough for the check.
            for (picture, town) in shown {
                pictures.entry(town).or_insert(picture);
            }
        }
        towns.check_pictures(&pictures)?;
        if groups.iter().all(|(_, flights)| flights.is_empty()) {
            return Err(nothing_left(&rejections));
        }
        let plan = plan_groups(&self.config, groups, &|note| towns.layout(&note.town_digest))?;
        for (item, group) in items.iter().zip(&plan.groups) {
            outputs.put(&item.to_string(), &codec::encode(SPLITS, group)?)?;
        }
        outputs.put(POLICY, canonical_json(&plan.splits).as_bytes())?;
        Ok(Produced { warnings: plan.warnings, ..Produced::default() })
    }
}
