//! `wasm`: a plugin as a stage, `use = "wasm:FILE"`: it judges or labels finished flights.

use super::config::StagePlugin;
use super::{Effect, Plugins, Role, source};
use crate::muco::produced;
use crate::ports::{self, TRAJECTORY};
use crate::world::{check_same_town, link_town, world};
use crate::{codec, parameters, single};
use cosfly_dataset::flight_labels::{self, FlightLabel};
use cosfly_dataset::flight_table;
use cosfly_diagnose::Result;
use cosfly_planner::{PlanOutcome, Trajectory};
use cosfly_stage::{
    InputPort, Inputs, ItemRule, OutputSink, ParameterError, Produced, Stage, StageKind, StagePart, StageProperties,
    TaskContext,
};

/// The kind.
pub struct Wasm;

impl StageKind for Wasm {
    fn name(&self) -> &'static str {
        "wasm"
    }

    fn doc(&self) -> &'static str {
        "A plugin of your own as a stage, `use = \"wasm:FILE\"`: rejects flights by its rule, or labels their frames."
    }

    fn schema(&self) -> serde_json::Value {
        parameters::schema_of::<StagePlugin>()
    }

    fn ports(&self) -> Vec<InputPort> {
        let doc = "The flights that it judges or labels, one item each.";
        vec![ports::town(), ports::each("trajectories", TRAJECTORY, false, doc)]
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let config: StagePlugin = parameters::read(given)?;
        let properties = StageProperties {
            kind: self.name().into(),
            version: 2,
            parameters: parameters::canonical(&config.canonical()),
            sources: vec![source("", Role::Stage, &config.setting())],
            inputs: self.ports(),
            artifact: TRAJECTORY,
            items: ItemRule::PerInput("trajectories"),
            bytes_per_item: 60_000,
        };
        Ok(single(WasmStage { config, properties }))
    }
}

struct WasmStage {
    config: StagePlugin,
    properties: StageProperties,
}

impl Stage for WasmStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        check_same_town(inputs, "trajectories")?;
        let world = world(inputs)?;
        let artifact = inputs.one("trajectories")?;
        let given: PlanOutcome = codec::decode(TRAJECTORY, &inputs.read(artifact, "trajectory")?)?;
        let mut warnings = vec![];
        let outcome = match given {
            PlanOutcome::Planned(flight) => {
                let plugins = Plugins::of_stage(&self.config.setting(), &context.sources)?;
                let plugins = plugins.for_item(format!("{}/{}", context.stage, context.item));
                let transformed = plugins.transform(&world, flight_table::encode(&flight, &context.item)?)?;
                warnings = transformed.warnings;
                let refuse = |message: String| plugins.wrong_answer(message);
                match transformed.effect {
                    Effect::Filter => judged(*flight, &transformed.answer).map_err(refuse)?,
                    Effect::Label => {
                        labelled(*flight, &transformed.answer, plugins.name_and_version()).map_err(refuse)?
                    }
                }
            }
            rejected @ PlanOutcome::Rejected { .. } => rejected,
        };
        outputs.put("trajectory", &codec::encode(TRAJECTORY, &outcome)?)?;
        link_town(inputs, outputs)?;
        Ok(Produced { warnings, ..produced(&outcome) })
    }
}

fn judged(flight: Trajectory, answer: &[u8]) -> Result<PlanOutcome, String> {
    let verdict = flight_table::verdict(answer)?;
    Ok(if verdict.keep {
        PlanOutcome::Planned(Box::new(flight))
    } else {
        PlanOutcome::Rejected { track: flight.track, reason: verdict.reason }
    })
}

fn labelled(mut flight: Trajectory, answer: &[u8], (plugin, version): (&str, &str)) -> Result<PlanOutcome, String> {
    for (name, per_frame) in flight_table::labels(answer, flight.track.len())? {
        flight_labels::add(&mut flight, FlightLabel { name: &name, plugin, version, per_frame: &per_frame })?;
    }
    Ok(PlanOutcome::Planned(Box::new(flight)))
}
