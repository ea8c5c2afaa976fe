//! [`Suite`]: the episodes of a recipe, with the experts' flights.

use crate::settings::FlySettings;
use cosfly_diagnose::{Diagnostic, Fault, ParameterError, Result, counted};
use cosfly_domain::{PlanOutcome, Town};
use cosfly_env::policies::Knowledge;
use cosfly_env::{Episode, FlightSite, Others, Start};
use cosfly_experts::{Kind, RecipeExpert, artifacts, pictures, render_files};
use cosfly_film::Shooting;
use cosfly_fingerprint::Digest;
use cosfly_frames::{DVec3, Seed};
use cosfly_recipe::{Recipe, RecipeStage};
use cosfly_render::{RenderConfig, Scene, SceneScan};
use cosfly_runner::{Plan, RunOptions, RunOutcome, run};
use cosfly_stage::{BlobSource, Blobs, RunEvent, StageRole};
use cosfly_store::Store;
use serde::de::DeserializeOwned;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::Arc;

/// Version of the environment: raised when an episode's rows change for the same actions, or what a number of its state means.
pub const ENVIRONMENT_VERSION: u32 = 3;

/// An episode and what baselines may know of it.
#[derive(Clone)]
pub struct EpisodeTask {
    /// The episode.
    pub episode: Arc<Episode>,
    /// Knowledge that baselines may have.
    pub knowledge: Knowledge,
    /// Mean visibility that the certificate of the expert's flight states.
    pub certified_visibility: f64,
    /// The town as it looks.
    pub scenery: Arc<SuiteTown>,
    /// Weather, and looks of the target: those of the pictures that the recipe makes of the flight.
    pub shooting: Arc<Shooting>,
    /// Number of its part in [`Suite::parts`].
    pub part: usize,
    /// Digest of all that the episode is made of, and of the version of the environment.
    pub digest: Digest,
}

impl EpisodeTask {
    /// An episode in a town that is not drawn: empty ground under a clear sky.
    pub fn undrawn(episode: Episode, knowledge: Knowledge, certified_visibility: f64) -> Self {
        let scenery = Arc::new(SuiteTown { town: Arc::default(), looks: episode.seed, scan: SceneScan::default() });
        let shooting = Arc::new(Shooting::plain(episode.looks));
        let digest = Digest::of(episode.name.as_bytes());
        Self { episode: Arc::new(episode), knowledge, certified_visibility, scenery, shooting, part: 0, digest }
    }
}

/// A town as it looks.
pub struct SuiteTown {
    /// The town.
    pub town: Arc<Town>,
    /// Seed of colours and patterns.
    pub looks: Seed,
    /// The scan that it is drawn as.
    pub scan: SceneScan,
}

impl SuiteTown {
    /// The town ready to be drawn.
    pub fn scene(&self) -> Scene {
        Scene::new(&self.town, self.looks).with_scan(self.scan.clone())
    }
}

/// The episodes of a recipe, or of a tier of a benchmark.
#[derive(Clone)]
pub struct Suite {
    /// Name of the recipe or of the tier.
    pub name: String,
    /// Digest of all towns and flights: equal exactly when the episodes are.
    pub digest: Digest,
    /// The recipe; of a tier, all recipes that it takes episodes from.
    pub parts: Vec<SuitePart>,
    /// Episodes in the order of the recipe.
    pub tasks: Vec<EpisodeTask>,
    /// Walks that have no episode because the expert found no flight behind them.
    pub rejected: u64,
}

/// A recipe in a suite.
#[derive(Clone, Debug, PartialEq)]
pub struct SuitePart {
    /// Name of the recipe.
    pub name: String,
    /// Its drone and air.
    pub settings: FlySettings,
}

impl SuitePart {
    /// The part that a recipe is.
    ///
    /// # Errors
    /// `fly-settings`.
    pub fn of(recipe: &Recipe) -> Result<Self> {
        Ok(Self { name: recipe.name.clone(), settings: FlySettings::of(recipe)? })
    }
}

/// Whether a stage plans flights behind walkers.
pub(crate) fn follows(stage: &RecipeStage) -> bool {
    stage.has_role(StageRole::Plans) && stage.connection("walks").is_some()
}

/// Names of the stages whose walks the stages number `stages` plan behind.
fn walkers<'r>(recipe: &'r Recipe, stages: &[usize]) -> Vec<&'r str> {
    let connections = stages.iter().filter_map(|stage| recipe.stages[*stage].connection("walks"));
    let upstreams: BTreeSet<usize> = connections.flat_map(|it| it.upstreams.iter().copied()).collect();
    upstreams.into_iter().map(|stage| recipe.stages[stage].name.as_str()).collect()
}

/// Code of a recipe whose experts found no flight.
pub const NO_EPISODE: &str = "fly-no-episode";

impl Suite {
    /// Makes what a recipe's experts need, and reads their flights as episodes.
    ///
    /// # Errors
    /// `fly-suite` for a recipe without experts, [`NO_EPISODE`] for one without an episode; failures of stages; errors of the store.
    pub fn make(
        recipe: &Recipe,
        store: &Store,
        options: &RunOptions,
        report: &(dyn Fn(RunEvent) + Sync),
    ) -> Result<Self> {
        let part = SuitePart::of(recipe)?;
        let stages: Vec<usize> = (0..recipe.stages.len()).filter(|at| follows(&recipe.stages[*at])).collect();
        if stages.is_empty() {
            let message = format!("`{}` has no episodes: no stage plans flights behind walkers", recipe.path.display());
            return Err(Diagnostic::new("fly-suite", Fault::Recipe, message).hint(
                "a suite has a stage with `use = \"plan\"` and `objective = \"track\"`, as recipes/suites have",
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
        let reader = Reader { plan: cosfly_runner::plan(recipe, store)?, store, places: BTreeMap::new() };
        let suite = reader.read(&stages, part)?;
        if suite.tasks.is_empty() {
            let message = format!("`{}` has no episode: the expert found no flight", recipe.path.display());
            let walks = walkers(recipe, &stages).join("`, `");
            return Err(Diagnostic::new("fly-no-episode", Fault::Recipe, message)
                .because(format!("none behind {}", counted(suite.rejected, "walk")))
                .hint(format!(
                    "`cosfly run` on the recipe says why; more walks may have some: a larger `count` of `{walks}`"
                )));
        }
        Ok(suite)
    }
}

/// Index of the stage that made a town, its item, and the stage that films it.
type PlaceKey = (usize, usize, Option<usize>);

struct Reader<'a> {
    plan: Plan<'a>,
    store: &'a Store,
    places: BTreeMap<PlaceKey, (Arc<FlightSite>, Arc<SuiteTown>)>,
}

impl Reader<'_> {
    fn read(mut self, stages: &[usize], part: SuitePart) -> Result<Suite> {
        let recipe = self.plan.recipe;
        // The seed draws wind and blackouts of episodes.
        let first = format!("environment {ENVIRONMENT_VERSION}\nseed {}\n", recipe.seed);
        let (mut tasks, mut rejected, mut listed) = (Vec::new(), 0, first.clone());
        for &stage in stages {
            let described = &recipe.stages[stage];
            let broken = |rule: String| Diagnostic::new("fly-suite", Fault::Bug, rule);
            let parameters = described.stage.properties().parameters.clone();
            let expert = RecipeExpert::read(parameters).map_err(|error| broken(error.message))?;
            let config = Arc::new(expert.expert.config);
            let town = described.connection("town").and_then(|connection| connection.arrivals.first());
            let town = town.map(|arrival| (arrival.stage, arrival.item));
            let town = town.ok_or_else(|| broken(format!("`{}` has no town", described.name)))?;
            let films = films_of(recipe, stage);
            let pictures = pictures_of(recipe, films).map_err(|error| broken(error.message))?;
            let scan = films.map(|films| scan_of(&recipe.stages[films], &pictures)).transpose()?.unwrap_or_default();
            for (item, name) in described.items.iter().enumerate() {
                let blobs = self.blobs(stage, item)?.clone();
                let begun = listed.len();
                for (blob, stored) in blobs.iter() {
                    let _ = writeln!(listed, "{}/{name}/{blob} {}", described.name, stored.digest);
                }
                let outcome = artifacts::FLIGHT.decode(&self.store.read(&blobs[artifacts::FLIGHT.blob])?)?;
                let PlanOutcome::Planned(flight) = outcome else {
                    rejected += 1;
                    continue;
                };
                let followed = self.find(&blobs, &artifacts::FOLLOWED)?;
                let around = self.find(&blobs, &artifacts::AROUND)?.unwrap_or_default();
                let shooting = Shooting::of(&pictures, &flight, followed.as_ref(), name.variant())?;
                // Pictures of policies show it.
                let _ = writeln!(listed, "{}/{name}/weather {:?}", described.name, shooting.weather);
                listed.push_str(&scan);
                let followed = followed.map(|followed| followed.plan);
                let (place, scenery) = self.place(town, films, &pictures)?;
                let name = name.of_stage(&described.name).to_string();
                let seed = Seed::of_item(recipe.seed, "fly", &name);
                let waypoints: Vec<DVec3> = flight.poses_in_world.iter().map(|pose| pose.position_in_world).collect();
                let episode = Episode {
                    name,
                    stratum: described.name.as_str().to_owned(),
                    place,
                    start: start(&waypoints, flight.track.dt_s),
                    target: Arc::new(flight.track),
                    others: Arc::new(Others::new(&around, followed.as_ref())),
                    followed,
                    looks: shooting.clothes_seed,
                    weather: Some(shooting.weather.clone()),
                    seed,
                };
                let digest =
                    Digest::of(format!("{first}{}town {}\n", &listed[begun..], Digest(scenery.looks.0)).as_bytes());
                let knowledge = Knowledge { flight: waypoints.into(), config: Arc::clone(&config) };
                let certified_visibility = flight.certificate.mean_visibility;
                let (episode, shooting) = (Arc::new(episode), Arc::new(shooting));
                tasks.push(EpisodeTask {
                    episode,
                    knowledge,
                    certified_visibility,
                    scenery,
                    shooting,
                    part: 0,
                    digest,
                });
            }
        }
        let digest = Digest::of(listed.as_bytes());
        Ok(Suite { name: recipe.name.clone(), digest, parts: vec![part], tasks, rejected })
    }

    fn place(
        &mut self,
        at: (usize, usize),
        films: Option<usize>,
        pictures: &RenderConfig,
    ) -> Result<(Arc<FlightSite>, Arc<SuiteTown>)> {
        let key = (at.0, at.1, films);
        if let Some(known) = self.places.get(&key) {
            return Ok(known.clone());
        }
        let stored = self.blobs(at.0, at.1)?[artifacts::TOWN.blob];
        let (town, looks) = (Arc::new(artifacts::TOWN.decode(&self.store.read(&stored)?)?), Seed(stored.digest.0));
        // Buildings look as in films.
        let files = films.map(|films| files_of(&self.plan.recipe.stages[films])).unwrap_or_default();
        let scan = render_files::read_scan(pictures, &files, &town)?;
        let site = FlightSite::new(Arc::clone(&town), looks).with_scan(scan.clone());
        let known = (Arc::new(site), Arc::new(SuiteTown { town, looks, scan }));
        self.places.insert(key, known.clone());
        Ok(known)
    }

    /// Value in a blob of a flight; `None` where there is no such blob.
    fn find<T: DeserializeOwned>(&self, blobs: &Blobs, kind: &Kind<T>) -> Result<Option<T>> {
        blobs.get(kind.blob).map(|blob| kind.decode(&self.store.read(blob)?)).transpose()
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

/// The first stage that films the flights of a stage.
fn films_of(recipe: &Recipe, flights: usize) -> Option<usize> {
    let films = |stage: &&RecipeStage| {
        let mut upstreams = stage.connections.iter().flat_map(|connection| &connection.upstreams);
        let is_of_flights = upstreams.any(|upstream| are_of(recipe, *upstream, flights));
        stage.has_role(StageRole::Films) && is_of_flights
    };
    recipe.stages.iter().position(|stage| films(&stage))
}

/// The settings of the pictures of a stage; those of the default under a clear sky without one.
fn pictures_of(recipe: &Recipe, films: Option<usize>) -> std::result::Result<RenderConfig, ParameterError> {
    match films {
        Some(films) => pictures::read(recipe.stages[films].parameters.clone()).map(|(config, _)| config),
        None => Ok(RenderConfig { weathers: vec!["ClearNoon".to_owned()], ..RenderConfig::default() }),
    }
}

fn files_of(films: &RecipeStage) -> Vec<PathBuf> {
    films.sources.iter().map(|source| source.path.clone()).collect()
}

/// Part of a suite's digest about the scan that pictures show: policies see it. Nothing where there is none.
fn scan_of(films: &RecipeStage, pictures: &RenderConfig) -> Result<String> {
    if pictures.mesh.is_none() && pictures.splats.is_none() {
        return Ok(String::new());
    }
    let parameters = &films.stage.properties().parameters;
    let mut listed = format!("scan {} {}\n", parameters["mesh"], parameters["splats"]);
    for path in files_of(films) {
        let bytes = std::fs::read(&path)
            .map_err(|error| Diagnostic::unread(format!("the scan's file `{}`", path.display()), &error))?;
        let _ = writeln!(listed, "scan {}", Digest::of(&bytes));
    }
    Ok(listed)
}

/// Whether the artifacts of a stage are those of `flights`, or were made of them by stages that change flights.
fn are_of(recipe: &Recipe, stage: usize, flights: usize) -> bool {
    let changed = || recipe.stages[stage].changed().into_iter().flat_map(|connection| &connection.upstreams);
    stage == flights || changed().any(|upstream| are_of(recipe, *upstream, flights))
}

/// The first state of a flight.
fn start(waypoints: &[DVec3], dt_s: f64) -> Start {
    let position_in_world = waypoints.first().copied().unwrap_or_default();
    let velocity_in_world = waypoints.get(1).map_or(DVec3::ZERO, |next| (*next - position_in_world) / dt_s);
    Start { position_in_world, velocity_in_world }
}
