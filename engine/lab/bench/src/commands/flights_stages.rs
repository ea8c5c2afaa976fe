//! Toy stages for `flights`: a plain, walks, and films of a few tiny frames as the render stage would leave them.

use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, ParameterError, Result};
use cosfly_experts::{artifacts, codec};
use cosfly_sample::ManyFlights;
use cosfly_schema::Role;
use cosfly_stage::{
    Fan, InputPort, Inputs, ItemRule, PortSource, Produced, Registry, Sees, Stage, StageKind, StagePart,
    StageProperties, StageRole, Takes, TaskContext,
};
use serde_json::{Value, json};
use std::sync::Arc;

/// Artifact of a walk of these toys.
const WALK: &str = "toy_walk/1";

/// Product of a toy.
#[derive(Clone, Copy, PartialEq)]
enum Makes {
    Town,
    Walks,
    Twins,
    Films,
}

/// A kind of toy stage.
struct Toy {
    name: &'static str,
    makes: Makes,
    samples: Arc<ManyFlights>,
}

struct ToyStage {
    makes: Makes,
    samples: Arc<ManyFlights>,
    properties: StageProperties,
}

/// All built-in stages and the toys.
///
/// # Errors
/// None, as the sample is sound.
pub fn registry() -> Result<Registry> {
    let samples = Arc::new(ManyFlights::default());
    let toy = |name, makes| -> Box<dyn StageKind> { Box::new(Toy { name, makes, samples: Arc::clone(&samples) }) };
    let toys = vec![
        toy("toy_town", Makes::Town),
        toy("toy_walks", Makes::Walks),
        toy("toy_twins", Makes::Twins),
        toy("toy_films", Makes::Films),
    ];
    Ok(cosfly_stages::registry_with(toys))
}

fn port(name: &'static str, artifact: &'static str, fan: Fan, takes: Takes) -> InputPort {
    InputPort {
        name,
        artifact,
        fan,
        takes,
        optional: false,
        source: PortSource::Recipe,
        sees: Sees::All,
        doc: "An input.",
    }
}

impl StageKind for Toy {
    fn name(&self) -> &'static str {
        self.name
    }

    fn doc(&self) -> &'static str {
        "A toy."
    }

    fn schema(&self) -> Value {
        match self.makes {
            Makes::Walks => json!({
                "type": "object",
                "properties": { "count": { "type": "integer", "minimum": 1 } },
                "required": ["count"],
                "additionalProperties": false,
            }),
            _ => json!({ "type": "object", "additionalProperties": false }),
        }
    }

    fn ports(&self) -> Vec<InputPort> {
        match self.makes {
            Makes::Films => {
                vec![port("town", "town/1", Fan::Broadcast, Takes::One), port("walks", WALK, Fan::Each, Takes::Named)]
            }
            Makes::Twins => vec![port("walks", WALK, Fan::Each, Takes::One)],
            Makes::Town | Makes::Walks => vec![],
        }
    }

    fn build(&self, parameters: Value) -> Result<Vec<StagePart>, ParameterError> {
        let count = parameters["count"].as_u64().unwrap_or(0);
        let (artifact, items, role) = match self.makes {
            Makes::Town => ("town/1", ItemRule::One, StageRole::World),
            Makes::Walks => (WALK, ItemRule::Count { prefix: "p", count }, StageRole::World),
            Makes::Twins => (WALK, ItemRule::PerInput("walks"), StageRole::Changes),
            Makes::Films => ("frames/4", ItemRule::PerInput("walks"), StageRole::Films),
        };
        let properties = StageProperties {
            // As in `pedestrians`, a higher count makes no old walk again.
            parameters: json!({}),
            inputs: self.ports(),
            items,
            bytes_per_item: 10_000,
            files_per_item: 2,
            intermediate: if self.makes == Makes::Films { &["pack"] } else { &[] },
            ..StageProperties::new(self.name, role, artifact)
        };
        let stage = ToyStage { makes: self.makes, samples: Arc::clone(&self.samples), properties };
        Ok(vec![StagePart { suffix: "", stage: Box::new(stage) }])
    }
}

impl Stage for ToyStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        match self.makes {
            Makes::Town => outputs.put(artifacts::TOWN.blob, &codec::encode("town/1", &cosfly_sample::town())?)?,
            Makes::Walks | Makes::Twins => outputs.put("walk", context.id.item.to_string().as_bytes())?,
            Makes::Films => self.film(inputs, outputs, context)?,
        }
        Ok(Produced::default())
    }
}

impl ToyStage {
    fn film(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<()> {
        let (_, walk) = context.id.item.origin();
        let number = walk
            .number()
            .ok_or_else(|| Diagnostic::new("bench-walk", Fault::Bug, format!("`{walk}` is not the name of a walk")))?;
        let is_expert = context.id.item.stage().is_some_and(|stage| stage.as_str() == Role::Expert.name());
        let index = 2 * number as usize + usize::from(!is_expert);
        let mut record = self.samples.record(index);
        record.trajectory_id = context.id.item.to_string();
        record.flight_id.clone_from(&record.trajectory_id);
        record.pedestrian_id = walk.to_string();
        if let Some(pair) = &mut record.pair {
            pair.expert_id = format!("{}-{walk}", Role::Expert.name());
        }
        outputs.link(artifacts::TOWN.blob, inputs.one("town")?.blobs[artifacts::TOWN.blob])?;
        outputs.put("index", &record.to_bytes())?;
        outputs.put("pack", self.samples.pack(index))
    }
}
