//! Parts `trials` and `orders` of a `plan` stage whose recipe orders losses in a share of the flights: every flight is planned
//! with its loss once, and the orders go to flights that succeeded, so that the shares are filled.

use crate::ports::{self, LOSSES, ORDERS};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::Result;
use cosfly_experts::{RecipeExpert, artifacts, codec};
use cosfly_flight::losses::{Trial, assigned, said};
use cosfly_planner::config::OcclusionConfig;
use cosfly_stage::{
    Fan, InputPort, Inputs, Produced, Resources, Sees, Stage, StagePart, StageProperties, StageRole, TaskContext,
};

/// Version of the trials, which is theirs and not that of the flights.
pub const TRIALS_VERSION: u32 = 9;
/// Part with the trial of every flight.
pub const TRIALS: &str = "trials";
/// Part with the orders of all flights.
pub const ORDERS_PART: &str = "orders";

/// The part that gives the orders of `config`.
pub fn orders_part(config: &OcclusionConfig) -> StagePart {
    let trials = ports::sibling(TRIALS, LOSSES, Fan::Gather, "The trials of all flights.");
    let properties = StageProperties {
        version: 3,
        parameters: serde_json::json!({ "share": config.share, "beside_look_alike": config.beside_look_alike }),
        inputs: vec![trials],
        bytes_per_item: 1_000,
        resources: Resources { memory_mib: 512, batch: 4 },
        ..StageProperties::new("plan", StageRole::Serves, ORDERS)
    };
    StagePart { suffix: ORDERS_PART, stage: Box::new(OrdersStage { config: config.clone(), properties }) }
}

/// Port through which a flight reads its own order.
pub fn port() -> InputPort {
    let doc = "Whether the flight loses its target: the part of the same stage.";
    InputPort { sees: Sees::Own, ..ports::sibling(ORDERS_PART, ORDERS, Fan::Broadcast, doc) }
}

/// The expert of a flight, which keeps its target unless it got an order.
pub fn ordered(expert: &RecipeExpert, inputs: &Inputs<'_>, context: &TaskContext) -> Result<RecipeExpert> {
    let mut expert = expert.clone();
    if let Some(artifact) = inputs.all(ORDERS_PART).first() {
        let is_ordered: bool = codec::decode(ORDERS, &inputs.read(artifact, &context.id.item.to_string())?)?;
        if !is_ordered {
            expert.expert.config.occlusion = expert.expert.config.occlusion.without_losses();
        }
    }
    Ok(expert)
}

struct OrdersStage {
    config: OcclusionConfig,
    properties: StageProperties,
}

impl Stage for OrdersStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, _: &TaskContext) -> Result<Produced> {
        let read = |artifact| artifacts::LOSSES.read(inputs, artifact);
        let trials: Vec<Trial> = inputs.all(TRIALS).iter().map(read).collect::<Result<_>>()?;
        let assigned = assigned(&trials, self.config.share, self.config.beside_look_alike);
        for (artifact, goes) in inputs.all(TRIALS).iter().zip(&assigned) {
            outputs.put(&artifact.id.item.to_string(), &codec::encode(ORDERS, goes)?)?;
        }
        let (notes, warnings) = said(&self.config, &trials, &assigned);
        Ok(Produced { notes: [("losses".to_owned(), notes)].into(), warnings, ..Produced::default() })
    }
}
