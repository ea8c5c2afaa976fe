//! The experts of a recipe's finished run, to be asked again: towns, walks and parameters out of the store.

use cosfly_diagnose::{Diagnostic, Fault, Result, nearest_name};
use cosfly_domain::PlanOutcome;
use cosfly_experts::plugins::Plugins;
use cosfly_experts::{Kind, RecipeExpert, artifacts};
use cosfly_flight::{Flight, MovingBodies, NamedTrack, World};
use cosfly_frames::{DVec3, Seed};
use cosfly_recipe::{Arrival, Recipe, RecipeStage};
use cosfly_runner::Plan;
use cosfly_stage::{BlobSource, Blobs, StageRole};
use cosfly_store::Store;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// Shorter horizons are planned as far as this and cut off, so that no way ends in a dead end, seconds.
pub const LOOK_AHEAD_S: f64 = 15.0;

/// Experts by the ids of their published trajectories; each town and each flight is made ready once.
pub struct Experts<'a> {
    plan: Arc<Plan<'a>>,
    store: &'a Store,
    /// By the index of the stage that made the town.
    worlds: BTreeMap<usize, Arc<World>>,
    flights: BTreeMap<String, Arc<KnownFlight>>,
    /// Stage and item of each flight by the ids that it can be asked for with; made with the first question.
    ids: Option<BTreeMap<String, (usize, usize)>>,
}

/// A flight that can be planned again in its town.
pub struct KnownFlight {
    /// The town.
    pub world: Arc<World>,
    /// Planned flights.
    pub flight: Flight,
    /// Position of the drone in every frame of the published flight; empty where there is none. World frame, metres.
    pub flown: Vec<DVec3>,
}

impl<'a> Experts<'a> {
    /// The experts of `plan`, whose artifacts are in `store`.
    pub fn new(plan: impl Into<Arc<Plan<'a>>>, store: &'a Store) -> Self {
        Self { plan: plan.into(), store, worlds: BTreeMap::new(), flights: BTreeMap::new(), ids: None }
    }

    /// The flight of a trajectory: `<stage>-<item>` as it is published, or `<stage>/<item>`; of a twin, its expert's.
    ///
    /// # Errors
    /// `ask-expert-unknown`, `ask-expert-unfinished`, or what is wrong with the store.
    pub fn flight(&mut self, trajectory: &str) -> Result<Arc<KnownFlight>> {
        if let Some(known) = self.flights.get(trajectory) {
            return Ok(Arc::clone(known));
        }
        let (stage, item) = self.expert_of(trajectory)?;
        let known = Arc::new(self.make_ready(stage, item)?);
        self.flights.insert(trajectory.to_owned(), Arc::clone(&known));
        Ok(known)
    }

    /// Stage and item of the expert of a trajectory.
    fn expert_of(&mut self, trajectory: &str) -> Result<(usize, usize)> {
        let (mut stage, mut item) = self.named(trajectory)?;
        loop {
            let found = &self.plan.recipe.stages[stage];
            if found.has_role(StageRole::Plans) {
                return Ok((stage, item));
            }
            let arrival = found.changed().and_then(|connection| connection.arrivals.get(item));
            let arrival = arrival.ok_or_else(|| unknown(trajectory, &[]))?;
            (stage, item) = (arrival.stage, arrival.item);
        }
    }

    /// Stage and item of a flight, by the id of a trajectory or of a film of it.
    fn named(&mut self, trajectory: &str) -> Result<(usize, usize)> {
        let recipe = self.plan.recipe;
        let ids = self.ids.get_or_insert_with(|| ids(recipe));
        ids.get(trajectory).copied().ok_or_else(|| unknown(trajectory, &first_ids(recipe)))
    }

    fn make_ready(&mut self, stage: usize, item: usize) -> Result<KnownFlight> {
        let described = &self.plan.recipe.stages[stage];
        let name = described.items[item].of_stage(&described.name).to_string();
        let broken = |rule: String| Diagnostic::new("ask-expert-parameters", Fault::Bug, rule);
        let mut expert =
            RecipeExpert::read(described.stage.properties().parameters.clone()).map_err(|it| broken(it.message))?;
        let town = described.connection("town").and_then(|connection| connection.arrivals.first().cloned());
        let world = self.world(&town.ok_or_else(|| broken(format!("`{name}` has no town")))?)?;
        let blobs = self.blobs(stage, item)?;
        let outcome = artifacts::FLIGHT.decode(&self.store.read(&blobs[artifacts::FLIGHT.blob])?)?;
        let published_without_loss =
            matches!(&outcome, PlanOutcome::Planned(it) if it.certificate.occlusion_ordered_s == 0.0);
        let (track, flown) = match outcome {
            PlanOutcome::Planned(flight) => {
                let flown = flight.poses_in_world.iter().map(|pose| pose.position_in_world).collect();
                (flight.track, flown)
            }
            PlanOutcome::Rejected { track, .. } => (track, vec![]),
        };
        if published_without_loss {
            expert.expert.config.occlusion = expert.expert.config.occlusion.without_losses();
        }
        let around = self.find(blobs, &artifacts::AROUND)?;
        let movers = around.map_or_else(Vec::new, |around| around.boxes());
        let drones = self.find(blobs, &artifacts::DRONES)?;
        let companions = self.companions(stage, item)?;
        let bodies = MovingBodies { walk: Some(track), companions, movers };
        let seed = Seed::of_item(self.plan.recipe.seed, described.name.as_str(), &described.items[item].to_string());
        let paths: Vec<PathBuf> = described.sources.iter().map(|source| source.path.clone()).collect();
        let plugins = Plugins::of_expert(&expert.plugins, &paths)?.for_item(name.clone());
        let mut flight = expert.expert.flight(&world, bodies, seed, Arc::new(plugins))?.map_err(|reason| {
            Diagnostic::new("ask-expert-nothing", Fault::Recipe, format!("`{name}` has no flight to go on from"))
                .because(reason)
        })?;
        drones.iter().flat_map(|drones| drones.before()).for_each(|places| flight.beside(places));
        Ok(KnownFlight { world, flight, flown })
    }

    fn world(&mut self, town: &Arrival) -> Result<Arc<World>> {
        if let Some(world) = self.worlds.get(&town.stage) {
            return Ok(Arc::clone(world));
        }
        let blobs = self.blobs(town.stage, town.item)?;
        let world = Arc::new(World::new(artifacts::TOWN.decode(&self.store.read(&blobs[artifacts::TOWN.blob])?)?));
        self.worlds.insert(town.stage, Arc::clone(&world));
        Ok(world)
    }

    fn companions(&self, stage: usize, item: usize) -> Result<Vec<NamedTrack>> {
        let part = self.plan.recipe.stages[stage].connection(artifacts::COMPANIONS.blob);
        let Some(chosen) = part.and_then(|part| part.arrivals.get(item)) else { return Ok(vec![]) };
        let blobs = self.blobs(chosen.stage, chosen.item)?;
        artifacts::COMPANIONS.decode(&self.store.read(&blobs[artifacts::COMPANIONS.blob])?)
    }

    /// Value in a blob of a flight; `None` where there is no such blob.
    fn find<T: DeserializeOwned>(&self, blobs: &Blobs, kind: &Kind<T>) -> Result<Option<T>> {
        blobs.get(kind.blob).map(|blob| kind.decode(&self.store.read(blob)?)).transpose()
    }

    fn blobs(&self, stage: usize, item: usize) -> Result<&Blobs> {
        let recipe = self.plan.recipe;
        let finished = self.plan.stages[stage].finished[item].as_ref();
        finished.map(|finished| &*finished.record.outputs).ok_or_else(|| {
            let (id, path) = (recipe.id(stage, item), recipe.path.display());
            let message = format!("`{id}` is not in the store as the recipe now asks for it");
            Diagnostic::new("ask-expert-unfinished", Fault::Recipe, message)
                .hint(format!("make it first: `cosfly run {path}`, with the same `--set` and `--store`"))
                .hint(format!("`cosfly why {path} {id}` says what changed since"))
        })
    }
}

/// Stages of flights: those that plan and those that change them.
fn flying(recipe: &Recipe) -> impl Iterator<Item = (usize, &RecipeStage)> {
    let changes_flights = |stage: &RecipeStage| {
        stage.has_role(StageRole::Changes) && stage.stage.properties().artifact == artifacts::FLIGHT.artifact
    };
    let stages = recipe.stages.iter().enumerate();
    stages.filter(move |(_, stage)| stage.has_role(StageRole::Plans) || changes_flights(stage))
}

/// Stage and item of each flight: by `<stage>-<item>` and `<stage>/<item>`, and by the ids of its films, which may name a
/// weather as well.
fn ids(recipe: &Recipe) -> BTreeMap<String, (usize, usize)> {
    let mut ids = BTreeMap::new();
    for (index, stage) in flying(recipe) {
        for (place, item) in stage.items.iter().enumerate() {
            ids.entry(item.of_stage(&stage.name).to_string()).or_insert((index, place));
            ids.entry(recipe.id(index, place).to_string()).or_insert((index, place));
        }
    }
    for film in recipe.stages.iter().filter(|stage| stage.has_role(StageRole::Films)) {
        let Some(flown) = film.connections.iter().find(|it| it.port.artifact == artifacts::FLIGHT.artifact) else {
            continue;
        };
        for (item, flight) in film.items.iter().zip(flown.arrivals.iter()) {
            ids.entry(item.to_string()).or_insert((flight.stage, flight.item));
        }
    }
    ids
}

/// Ids of the first flights of each stage.
fn first_ids(recipe: &Recipe) -> Vec<String> {
    let first = |(_, stage): (usize, &RecipeStage)| {
        stage.items.iter().take(1000).map(|item| item.of_stage(&stage.name).to_string()).collect::<Vec<_>>()
    };
    flying(recipe).flat_map(first).collect()
}

fn unknown(trajectory: &str, names: &[String]) -> Box<Diagnostic> {
    let message = format!("the recipe has no trajectory `{trajectory}`");
    let diagnostic = Diagnostic::new("ask-expert-unknown", Fault::Input, message);
    let known = || names.iter().map(String::as_str);
    match (nearest_name(trajectory, known()), names) {
        (Some(near), _) => diagnostic.hint(format!("did you mean `{near}`?")),
        (None, [first, .., last]) => diagnostic.hint(format!("its trajectories are `{first}` ... `{last}`")),
        (None, [only]) => diagnostic.hint(format!("its only trajectory is `{only}`")),
        (None, []) => diagnostic.hint("trajectories come from stages that plan flights, such as `use = \"plan\"`"),
    }
}
