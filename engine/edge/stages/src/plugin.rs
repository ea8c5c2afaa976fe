//! `wasm`: a plugin as a stage, `use = "wasm:FILE"`: it judges or labels finished flights, or makes extras of rendered ones.

use crate::planning::produced;
use crate::ports::{self, CAPTIONS, EXTRAS, FRAMES, TRAJECTORY};
use crate::rejections::handed_on;
use crate::single;
use crate::traffic::link_moving;
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{ParameterError, Result};
use cosfly_domain::{FlightLabel, PlanOutcome, Trajectory};
use cosfly_experts::plugins::config::{Makes, StagePlugin};
use cosfly_experts::plugins::{Declaration, Effect, PluginRole, Plugins, source, tables};
use cosfly_experts::world::{check_same_town, link_town, world};
use cosfly_experts::{artifacts, codec};
use cosfly_schema::RenderedTrajectory;
use cosfly_schema::extras::{Extra, ExtraShape};
use cosfly_schema::flight_table::{self, FlightColumns, MOST_FILES, MOST_ROWS};
use cosfly_schema::record::captions_from_bytes;
use cosfly_stage::parameters;
use cosfly_stage::{
    InputPort, Inputs, ItemRule, Produced, Stage, StageKind, StagePart, StageProperties, StageRole, TaskContext,
};
use std::collections::BTreeMap;

/// Blob of extras.
pub const EXTRA: &str = "extra";

/// Stage kind `wasm`.
pub struct Wasm;

impl StageKind for Wasm {
    fn name(&self) -> &'static str {
        "wasm"
    }

    fn doc(&self) -> &'static str {
        "A plugin of your own as a stage, `use = \"wasm:FILE\"`: rejects or labels flights, or makes tables and files of them."
    }

    fn schema(&self) -> serde_json::Value {
        parameters::schema_of::<StagePlugin>()
    }

    fn ports(&self) -> Vec<InputPort> {
        let mut ports = ports_of(Makes::Flights);
        ports.extend(ports_of(Makes::Extras).into_iter().skip(1));
        // Which of them are needed depends on the kind of output.
        ports.into_iter().map(|port| InputPort { optional: port.name != "town", ..port }).collect()
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let config: StagePlugin = parameters::read(given)?;
        let (artifact, items, bytes_per_frame, role) = match config.makes {
            Makes::Flights => (TRAJECTORY, "trajectories", 300, StageRole::Changes),
            Makes::Extras => (EXTRAS, "frames", 100, StageRole::Speaks),
        };
        let properties = StageProperties {
            version: 4,
            parameters: parameters::canonical(&config.canonical()),
            sources: vec![source("", PluginRole::Stage(config.makes), &config.setting())],
            inputs: ports_of(config.makes),
            items: ItemRule::PerInput(items),
            bytes_per_frame,
            ..StageProperties::new(self.name(), role, artifact)
        };
        Ok(single(WasmStage { config, properties }))
    }
}

fn ports_of(makes: Makes) -> Vec<InputPort> {
    let judged = "The flights that it judges or labels, one item each.";
    let rendered = "The rendered flights of which it makes extras, one item each.";
    let captions = "Their captions, for those that make extras.";
    match makes {
        Makes::Flights => vec![ports::town(), ports::each("trajectories", TRAJECTORY, false, judged)],
        Makes::Extras => vec![
            ports::town(),
            ports::without_pictures(ports::each("frames", FRAMES, false, rendered)),
            InputPort { optional: true, ..ports::each("captions", CAPTIONS, false, captions) },
        ],
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
        let plugins = Plugins::of_stage(&self.config.setting(), &context.sources)?;
        let plugins = plugins.for_item(context.id.to_string());
        match self.config.makes {
            Makes::Flights => flights(&plugins, inputs, outputs, context),
            Makes::Extras => extras(&plugins, inputs, outputs),
        }
    }
}

/// Judges or labels a flight.
fn flights(
    plugins: &Plugins,
    inputs: &Inputs<'_>,
    outputs: &mut dyn OutputSink,
    context: &TaskContext,
) -> Result<Produced> {
    check_same_town(inputs, "trajectories")?;
    let world = world(inputs)?;
    let artifact = inputs.one("trajectories")?;
    let given = artifacts::FLIGHT.read(inputs, artifact)?;
    let mut warnings = vec![];
    let outcome = match given {
        PlanOutcome::Planned(flight) => {
            let columns = FlightColumns::of_flight(&flight, &context.id.item.to_string());
            let (declared, answered) = plugins.answer(&world, Makes::Flights, &columns)?;
            warnings = answered.warnings;
            let outcome = match declared.effect {
                Effect::Filter => judged(*flight, &declared, &answered.answer),
                _ => labelled(*flight, &declared, &answered.answer, plugins.told()),
            };
            outcome.map_err(|message| plugins.wrong_answer(message))?
        }
        rejected @ PlanOutcome::Rejected { .. } => rejected,
    };
    artifacts::FLIGHT.put(outputs, &outcome)?;
    link_town(inputs, outputs)?;
    link_moving(artifact, outputs)?;
    Ok(Produced { warnings, ..produced(&outcome) })
}

fn judged(flight: Trajectory, declared: &Declaration, answer: &[u8]) -> Result<PlanOutcome, String> {
    let verdict = flight_table::verdict(answer, &tables::columns(&declared.gives))?;
    Ok(if verdict.keep {
        PlanOutcome::Planned(Box::new(flight))
    } else {
        PlanOutcome::Rejected { track: flight.track, reason: cosfly_diagnose::visible_text(&verdict.reason) }
    })
}

fn labelled(
    mut flight: Trajectory,
    declared: &Declaration,
    answer: &[u8],
    [plugin, version, _]: [&str; 3],
) -> Result<PlanOutcome, String> {
    for (name, per_frame) in flight_table::labels(answer, &tables::columns(&declared.gives), flight.track.len())? {
        if let Some(earlier) = flight.labels.iter().find(|earlier| earlier.name == name) {
            let plugin = &earlier.plugin;
            return Err(format!("it returned a label `{name}`, but plugin `{plugin}` already gave one of that name"));
        }
        flight.labels.push(FlightLabel { name, plugin: plugin.to_owned(), version: version.to_owned(), per_frame });
    }
    Ok(PlanOutcome::Planned(Box::new(flight)))
}

/// Makes extras of a rendered flight; a rejected one has none.
fn extras(plugins: &Plugins, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink) -> Result<Produced> {
    check_same_town(inputs, "frames")?;
    let frames = inputs.one("frames")?;
    if let Some(rejected) = handed_on(inputs, outputs, frames)? {
        return Ok(rejected);
    }
    let record = RenderedTrajectory::from_bytes(&inputs.read(frames, "index")?)?;
    let captions = match inputs.all("captions").first() {
        Some(artifact) => captions_from_bytes(&inputs.read(artifact, "captions")?)?,
        None => vec![],
    };
    let columns = FlightColumns::of_rendered(&record, &captions);
    let (declared, answered) = plugins.answer(&world(inputs)?, Makes::Extras, &columns)?;
    let wrong = |message: String| plugins.wrong_answer(message);
    let source = tables::source_of(&declared, plugins.told()).ok_or_else(|| wrong("it makes no extras".to_owned()))?;
    let rows = match source.shape {
        ExtraShape::Annotation => 1..=1,
        ExtraShape::Rows | ExtraShape::Readings => 0..=MOST_ROWS,
        ExtraShape::Files => 0..=MOST_FILES,
    };
    let values = flight_table::read_answer(&answered.answer, &source.columns, rows).map_err(wrong)?;
    let count = values.first().map_or(0, flight_table::Values::len).to_string();
    let notes = match source.shape {
        ExtraShape::Annotation => BTreeMap::new(),
        ExtraShape::Rows | ExtraShape::Readings => BTreeMap::from([("rows".to_owned(), count)]),
        ExtraShape::Files => BTreeMap::from([("files".to_owned(), count)]),
    };
    outputs.put(EXTRA, &codec::encode(EXTRAS, &Extra { source, values })?)?;
    Ok(Produced { notes, warnings: answered.warnings, rejected: None })
}
