//! The experts of a recipe's finished run, to be asked again: towns, walks and parameters out of the store.

use cosfly_diagnose::{Diagnostic, Fault, Result, nearest_name};
use cosfly_domain::PlanOutcome;
use cosfly_frames::{DVec3, Seed};
use cosfly_recipe::{Arrival, RecipeStage};
use cosfly_runner::Plan;
use cosfly_stage::{BlobSource, Blobs, ItemName};
use cosfly_stages::expert::{Bodies, Companion, Expert, Flight};
use cosfly_stages::plugins::Plugins;
use cosfly_stages::read;
use cosfly_stages::world::World;
use cosfly_store::Store;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// Shorter horizons are planned as far as this and cut off, so that no way ends in a dead end, seconds.
pub const LOOK_AHEAD_S: f64 = 15.0;

/// Experts by the ids of their published trajectories; each town and each flight is made ready once.
pub struct Experts<'a> {
    plan: Plan<'a>,
    store: &'a Store,
    /// By the index of the stage that made the town.
    worlds: BTreeMap<usize, Arc<World>>,
    flights: BTreeMap<String, Arc<KnownFlight>>,
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
    pub fn new(plan: Plan<'a>, store: &'a Store) -> Self {
        Self { plan, store, worlds: BTreeMap::new(), flights: BTreeMap::new() }
    }

    /// The flight of a trajectory: `<stage>-<item>` as it is published, or `<stage>/<item>`; of a twin, its expert's.
    ///
    /// # Errors
    /// `plan-from-unknown`, `plan-from-unfinished`, or what is wrong with the store.
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
    fn expert_of(&self, trajectory: &str) -> Result<(usize, usize)> {
        let (mut stage, mut item) = self.named(trajectory)?;
        loop {
            let found = &self.plan.recipe.stages[stage];
            if found.kind == "muco" {
                return Ok((stage, item));
            }
            let arrival = found.connection("trajectories").and_then(|connection| connection.arrivals.get(item));
            let arrival = arrival.ok_or_else(|| unknown(trajectory, &[]))?;
            (stage, item) = (arrival.stage, arrival.item);
        }
    }

    /// Id of a flight without the weather that paired weathers add: the flight is the same in all of them.
    fn without_weather<'t>(&self, trajectory: &'t str) -> &'t str {
        let Some((flight, end)) = trajectory.rsplit_once('-') else { return trajectory };
        let is_paired = self.plan.recipe.stages.iter().map(|stage| &stage.stage.properties().parameters).any(|it| {
            let weathers = it["weathers"].as_array().into_iter().flatten();
            it["paired_weathers"] == true && weathers.into_iter().any(|weather| weather == end)
        });
        if is_paired { flight } else { trajectory }
    }

    fn named(&self, trajectory: &str) -> Result<(usize, usize)> {
        let trajectory = self.without_weather(trajectory);
        let mut names = Vec::new();
        let stages = self.plan.recipe.stages.iter().enumerate();
        let flies = |stage: &RecipeStage| {
            stage.name.part().is_empty() && matches!(stage.kind.as_str(), "muco" | "perturb" | "wasm")
        };
        for (index, stage) in stages.filter(|(_, stage)| flies(stage)) {
            let published = |item: &ItemName| item.of_stage(&stage.name).to_string() == trajectory;
            let is_meant = |item: &ItemName| published(item) || format!("{}/{item}", stage.name) == trajectory;
            if trajectory.starts_with(stage.name.as_str())
                && let Some(item) = stage.items.iter().position(is_meant)
            {
                return Ok((index, item));
            }
            names.extend(stage.items.iter().take(1000).map(|item| item.of_stage(&stage.name).to_string()));
        }
        Err(unknown(trajectory, &names))
    }

    fn make_ready(&mut self, stage: usize, item: usize) -> Result<KnownFlight> {
        let described = &self.plan.recipe.stages[stage];
        let name = described.items[item].of_stage(&described.name).to_string();
        let broken = |rule: String| Diagnostic::new("plan-from-parameters", Fault::Bug, rule);
        let mut expert =
            Expert::read(described.stage.properties().parameters.clone()).map_err(|it| broken(it.message))?;
        let town = described.connection("town").and_then(|connection| connection.arrivals.first().cloned());
        let world = self.world(&town.ok_or_else(|| broken(format!("`{name}` has no town")))?)?;
        let blobs = self.blobs(stage, item)?;
        let outcome = read::trajectory(&self.store.read(&blobs[read::TRAJECTORY_BLOB])?)?;
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
            expert.config.occlusion = expert.config.occlusion.without_losses();
        }
        let around = blobs.get(read::AROUND_BLOB).map(|blob| read::around(&self.store.read(blob)?)).transpose()?;
        let movers = around.map_or_else(Vec::new, |around| around.boxes());
        let before =
            blobs.get(read::DRONES_BLOB).map(|blob| read::drones_before(&self.store.read(blob)?)).transpose()?;
        let companions = self.companions(stage, item)?;
        let bodies = Bodies { walk: Some(track), companions, movers };
        let seed = Seed::of_item(self.plan.recipe.seed, described.name.as_str(), &described.items[item].to_string());
        let paths: Vec<PathBuf> = described.sources.iter().map(|source| source.path.clone()).collect();
        let plugins = Plugins::of_expert(&expert.plugins, &paths)?.for_item(name.clone());
        let mut flight = expert.flight(&world, bodies, seed, plugins)?.map_err(|reason| {
            Diagnostic::new("plan-from-nothing", Fault::Recipe, format!("`{name}` has no flight to go on from"))
                .because(reason)
        })?;
        before.into_iter().flatten().for_each(|places| flight.beside(places));
        Ok(KnownFlight { world, flight, flown })
    }

    fn world(&mut self, town: &Arrival) -> Result<Arc<World>> {
        if let Some(world) = self.worlds.get(&town.stage) {
            return Ok(Arc::clone(world));
        }
        let blobs = self.blobs(town.stage, town.item)?;
        let world = Arc::new(World::new(read::town(&self.store.read(&blobs[read::TOWN_BLOB])?)?));
        self.worlds.insert(town.stage, Arc::clone(&world));
        Ok(world)
    }

    fn companions(&self, stage: usize, item: usize) -> Result<Vec<Companion>> {
        let part = self.plan.recipe.stages[stage].connection(read::COMPANIONS_BLOB);
        let Some(chosen) = part.and_then(|part| part.arrivals.get(item)) else { return Ok(vec![]) };
        let blobs = self.blobs(chosen.stage, chosen.item)?;
        read::companions(&self.store.read(&blobs[read::COMPANIONS_BLOB])?)
    }

    fn blobs(&self, stage: usize, item: usize) -> Result<&Blobs> {
        let recipe = self.plan.recipe;
        let finished = self.plan.stages[stage].finished[item].as_ref();
        finished.map(|finished| &*finished.record.outputs).ok_or_else(|| {
            let (id, path) = (recipe.id(stage, item), recipe.path.display());
            let message = format!("`{id}` is not in the store as the recipe now asks for it");
            Diagnostic::new("plan-from-unfinished", Fault::Recipe, message)
                .hint(format!("make it first: `cosfly run {path}`, with the same `--set` and `--store`"))
                .hint(format!("`cosfly why {path} {id}` says what changed since"))
        })
    }
}

fn unknown(trajectory: &str, names: &[String]) -> Box<Diagnostic> {
    let message = format!("the recipe has no trajectory `{trajectory}`");
    let diagnostic = Diagnostic::new("plan-from-unknown", Fault::Input, message);
    let known = || names.iter().map(String::as_str);
    match (nearest_name(trajectory, known()), names) {
        (Some(near), _) => diagnostic.hint(format!("did you mean `{near}`?")),
        (None, [first, .., last]) => diagnostic.hint(format!("its trajectories are `{first}` ... `{last}`")),
        (None, [only]) => diagnostic.hint(format!("its only trajectory is `{only}`")),
        (None, []) => diagnostic.hint("trajectories come from stages with `use = \"muco\"` or `use = \"perturb\"`"),
    }
}
