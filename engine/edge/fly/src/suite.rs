//! [`Suite`]: the episodes of a recipe, with the experts' flights.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_env::policies::Knowledge;
use cosfly_env::{Episode, Place, Start};
use cosfly_fingerprint::Digest;
use cosfly_frames::{DVec3, Seed};
use cosfly_planner::{MucoConfig, PlanOutcome};
use cosfly_recipe::{Recipe, RecipeStage};
use cosfly_runner::{Plan, RunOptions, RunOutcome, run};
use cosfly_stage::{BlobSource, Blobs, RunEvent};
use cosfly_stages::expert::Expert;
use cosfly_stages::read;
use cosfly_store::Store;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::sync::Arc;

/// Version of the environment: raised when an episode's rows change for the same actions.
pub const ENVIRONMENT_VERSION: u32 = 1;

/// An episode and what baselines may know of it.
pub struct Task {
    /// The episode.
    pub episode: Arc<Episode>,
    /// What baselines may know.
    pub knowledge: Knowledge,
    /// Mean visibility that the certificate of the expert's flight states.
    pub certified_visibility: f64,
}

/// The episodes of a recipe.
pub struct Suite {
    /// Name of the recipe.
    pub name: String,
    /// Digest of all towns and flights: equal exactly when the episodes are.
    pub digest: Digest,
    /// Episodes in the order of the recipe.
    pub tasks: Vec<Task>,
    /// Walks that have no episode because the expert found no flight behind them.
    pub rejected: u64,
}

/// Whether a stage plans flights behind walkers.
fn follows(stage: &RecipeStage) -> bool {
    let objective = stage.stage.properties().parameters.get("objective");
    stage.kind == "muco"
        && stage.name.part().is_empty()
        && objective.is_none_or(|objective| objective.as_str() == Some("track"))
}

impl Suite {
    /// Makes what a recipe's experts need, and reads their flights as episodes.
    ///
    /// # Errors
    /// `fly-suite` for a recipe without experts; failures of stages; errors of the store.
    pub fn make(
        recipe: &Recipe,
        store: &Store,
        options: &RunOptions,
        report: &(dyn Fn(RunEvent) + Sync),
    ) -> Result<Self> {
        let stages: Vec<usize> = (0..recipe.stages.len()).filter(|at| follows(&recipe.stages[*at])).collect();
        if stages.is_empty() {
            let message = format!("`{}` has no episodes: no stage plans flights behind walkers", recipe.path.display());
            return Err(Diagnostic::new("fly-suite", Fault::Recipe, message).hint(
                "a suite has a stage with `use = \"muco\"` and `objective = \"track\"`, as recipes/suites have",
            ));
        }
        for asked in &stages {
            let summary = run(recipe, store, &RunOptions { asked: Some(*asked), ..options.clone() }, report)?;
            if summary.outcome == RunOutcome::Complete {
                continue;
            }
            let first = summary.failures.into_iter().map(|failure| failure.diagnostic).next();
            return Err(first.or(summary.diagnostics.into_iter().next()).unwrap_or_else(|| {
                Diagnostic::new("fly-stopped", Fault::Stopped, "stopped before all episodes were made; they are kept")
            }));
        }
        Reader { plan: cosfly_runner::plan(recipe, store)?, store, places: BTreeMap::new() }.read(&stages)
    }
}

struct Reader<'a> {
    plan: Plan<'a>,
    store: &'a Store,
    /// By the index of the stage that made the town, and its item.
    places: BTreeMap<(usize, usize), Arc<Place>>,
}

impl Reader<'_> {
    fn read(mut self, stages: &[usize]) -> Result<Suite> {
        let recipe = self.plan.recipe;
        let (mut tasks, mut rejected, mut listed) = (Vec::new(), 0, format!("environment {ENVIRONMENT_VERSION}\n"));
        for &stage in stages {
            let described = &recipe.stages[stage];
            let broken = |rule: String| Diagnostic::new("fly-suite", Fault::Bug, rule);
            let parameters = described.stage.properties().parameters.clone();
            let expert = Expert::read(parameters).map_err(|error| broken(error.message))?;
            let config = Arc::new(expert.config);
            let town = described.connection("town").and_then(|connection| connection.arrivals.first());
            let town = town.map(|arrival| (arrival.stage, arrival.item));
            let town = town.ok_or_else(|| broken(format!("`{}` has no town", described.name)))?;
            for (item, name) in described.items.iter().enumerate() {
                let blobs = self.blobs(stage, item)?.clone();
                for (blob, stored) in blobs.iter() {
                    let _ = writeln!(listed, "{}/{name}/{blob} {}", described.name, stored.digest);
                }
                let outcome = read::trajectory(&self.store.read(&blobs[read::TRAJECTORY_BLOB])?)?;
                let PlanOutcome::Planned(flight) = outcome else {
                    rejected += 1;
                    continue;
                };
                let place = self.place(town)?;
                let stratum = described.name.as_str().to_owned();
                let name = name.of_stage(&described.name).to_string();
                let seed = Seed::of_item(recipe.seed, "fly", &name);
                tasks.push(task(name, stratum, place, *flight, Arc::clone(&config), seed));
            }
        }
        Ok(Suite { name: recipe.name.clone(), digest: Digest::of(listed.as_bytes()), tasks, rejected })
    }

    fn place(&mut self, town: (usize, usize)) -> Result<Arc<Place>> {
        if let Some(place) = self.places.get(&town) {
            return Ok(Arc::clone(place));
        }
        let bytes = self.store.read(&self.blobs(town.0, town.1)?[read::TOWN_BLOB])?;
        let place = Arc::new(Place::new(&read::town(&bytes)?));
        self.places.insert(town, Arc::clone(&place));
        Ok(place)
    }

    fn blobs(&self, stage: usize, item: usize) -> Result<&Blobs> {
        let finished = self.plan.stages[stage].finished[item].as_ref();
        finished.map(|finished| &*finished.record.outputs).ok_or_else(|| {
            let id = self.plan.recipe.id(stage, item);
            Diagnostic::new("fly-suite", Fault::Machine, format!("`{id}` is not in the store any more"))
                .hint("run the same command again")
        })
    }
}

fn task(
    name: String,
    stratum: String,
    place: Arc<Place>,
    flight: cosfly_planner::Trajectory,
    config: Arc<MucoConfig>,
    seed: Seed,
) -> Task {
    let waypoints: Vec<DVec3> = flight.poses_in_world.iter().map(|pose| pose.position_in_world).collect();
    let first = waypoints.first().copied().unwrap_or_default();
    let velocity_in_world = waypoints.get(1).map_or(DVec3::ZERO, |next| (*next - first) / flight.track.dt_s);
    let start = Start { position_in_world: first, velocity_in_world };
    let episode = Episode { name, stratum, place, target: Arc::new(flight.track), start, seed };
    let knowledge = Knowledge { flight: waypoints.into(), config };
    Task { episode: Arc::new(episode), knowledge, certified_visibility: flight.certificate.mean_visibility }
}
