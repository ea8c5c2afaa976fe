//! Several drones behind one walk: part `formation` of a `plan` stage plans them one after the other, each beside those before
//! it; the stage itself gives every drone its flight and its aim.

use crate::planning::{Setting, produced};
use crate::ports::{self, FORMATION};
use crate::{quotas, traffic};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::Result;
use cosfly_domain::PlanOutcome;
use cosfly_experts::world::link_town;
use cosfly_experts::{RecipeExpert, artifacts, codec};
use cosfly_flight::Flown;
use cosfly_flight::formation::{Drone, Formation};
use cosfly_flight::losses::Trial;
use cosfly_frames::Seed;
use cosfly_stage::{
    Fan, InputPort, Inputs, ItemName, ItemRule, Produced, Stage, StagePart, StageProperties, StageRole, TaskContext,
};

/// Name of the part and of the port that reads it.
const NAME: &str = "formation";

/// The parts of a stage whose recipe asks for several drones: `inputs` are those of the planning, `properties` those of the
/// stage itself, and `losses` the parts that order losses.
pub fn parts(expert: RecipeExpert, properties: StageProperties) -> Vec<StagePart> {
    let mut planning = StageProperties { items: ItemRule::PerInput("walks"), ..properties.clone() };
    planning.role = StageRole::Serves;
    planning.parameters["drones"]["count"] = expert.expert.config.drones.count.into();
    let mut parts = vec![];
    let occlusion = &expert.expert.config.occlusion;
    if occlusion.has_quota() {
        let trial = StageProperties {
            version: quotas::TRIALS_VERSION,
            artifact: ports::LOSSES,
            bytes_per_item: 100,
            bytes_per_frame: 0,
            ..planning.clone()
        };
        let trial = FormationStage { expert: expert.clone(), properties: trial, is_trial: true };
        parts.push(StagePart { suffix: quotas::TRIALS, stage: Box::new(trial) });
        parts.push(quotas::orders_part(occlusion));
        planning.inputs.push(quotas::port());
    }
    planning.artifact = FORMATION;
    let stage = FormationStage { expert: expert.clone(), properties: planning, is_trial: false };
    parts.push(StagePart { suffix: NAME, stage: Box::new(stage) });
    let mut formed = StageProperties {
        items: ItemRule::PerVariant { port: "walks", variants: expert.expert.drones() },
        ..properties
    };
    formed.inputs.push(port());
    parts.push(StagePart { suffix: "", stage: Box::new(FormedStage { expert, properties: formed }) });
    parts
}

fn port() -> InputPort {
    ports::sibling(NAME, FORMATION, Fan::Each, "The flights of all drones behind the walk: the part of the same stage.")
}

struct FormationStage {
    expert: RecipeExpert,
    properties: StageProperties,
    /// Whether the flights are planned only to learn whether they can lose their targets.
    is_trial: bool,
}

impl Stage for FormationStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        // All drones behind a walk have the order of the walk.
        let expert = quotas::ordered(&self.expert, inputs, context)?;
        let Setting { world, around, bodies } = Setting::read(inputs, &expert)?;
        let flown = expert.expert.formation(&world, bodies, Seed(context.seed))?;
        let walk = inputs.one("walks")?;
        if self.is_trial {
            let followed = traffic::followed(inputs, walk)?;
            let trial = |flown: &Flown| {
                Trial::of(&flown.outcome, &expert.expert.config.occlusion, &world.exact, &around, followed.as_ref())
            };
            artifacts::LOSSES.put(outputs, &Trial::of_all(flown.iter().map(trial)))?;
            return Ok(Produced::default());
        }
        for (variant, flown) in expert.expert.drones().iter().zip(&flown) {
            outputs.put(variant, &codec::encode(FORMATION, flown)?)?;
        }
        traffic::put_around(walk, &around, outputs)?;
        Ok(Produced::default())
    }
}

struct FormedStage {
    expert: RecipeExpert,
    properties: StageProperties,
}

impl FormedStage {
    /// Flights of all drones behind the walk of an item, and the place of the item's own among them.
    fn flown(&self, inputs: &Inputs<'_>, item: &ItemName) -> Result<(Vec<Flown>, usize)> {
        let artifact = inputs.one(NAME)?;
        let variants = self.expert.expert.drones();
        let own = variants.iter().position(|variant| item.variant() == Some(variant)).unwrap_or(0);
        let read = |variant: &String| artifacts::FORMATION.decode(&inputs.read(artifact, variant)?);
        Ok((variants.iter().map(read).collect::<Result<_>>()?, own))
    }
}

impl Stage for FormedStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        let (mut flown, own) = self.flown(inputs, &context.id.item)?;
        let walk = context.id.item.without_variant().unwrap_or_else(|| context.id.item.clone());
        let drone = |(variant, flown): (String, &Flown)| match &flown.outcome {
            PlanOutcome::Planned(flight) => Some(Drone {
                flight: walk.with_variant(variant).of_stage(&context.id.stage).to_string(),
                poses_in_world: flight.poses_in_world.clone(),
            }),
            PlanOutcome::Rejected { .. } => None,
        };
        let drones = self.expert.expert.drones().into_iter().zip(&flown).map(drone).collect();
        let separation_m = self.expert.expert.config.drones.separation_m;
        artifacts::DRONES.put(outputs, &Formation { separation_m, own: own as u32, drones })?;
        let Flown { mut outcome, notes, warnings } = flown.swap_remove(own);
        if let PlanOutcome::Planned(flight) = &mut outcome {
            self.expert.expert.aim_of(flight, Seed(context.seed));
        }
        artifacts::FLIGHT.put(outputs, &outcome)?;
        link_town(inputs, outputs)?;
        traffic::link_moving(inputs.one(NAME)?, outputs)?;
        let mut produced = produced(&outcome);
        produced.notes.extend(notes);
        produced.warnings.extend(warnings);
        Ok(produced)
    }
}
