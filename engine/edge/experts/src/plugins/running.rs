//! Plugins at work: those of a stage are loaded once, and opened again for every item.

use super::config::{ExpertPlugins, Makes, Setting};
use super::{PluginRole, tables};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::{ObstacleKind, OrientedBox};
use cosfly_flight::{DrawnReference, OpenTerms, World};
use cosfly_frames::{DVec3, Seed};
use cosfly_geometry::SpatialQuery;
use cosfly_objectives::config::{DT_S, LONGEST_S};
use cosfly_objectives::reference::Reference;
use cosfly_planner::{MucoConfig, WeightedTerm};
use cosfly_plugin_host::{
    Answered, Began, Declaration, Host, Kind, NoTown, Plugin, PluginError, PluginLimits, PluginTerm, SiteContext,
    TownView, check_schema, declaration, draw_reference, run_stage, with_defaults,
};
use cosfly_schema::flight_table::FlightColumns;
use cosfly_stage::{Settle, Source, SourceCheck};
use sha2::{Digest as _, Sha256};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

static FOLDER: OnceLock<Option<PathBuf>> = OnceLock::new();
static HOST: OnceLock<Host> = OnceLock::new();

/// Sets the folder of compiled plugins, which outlives the process; to be called before the first plugin is loaded.
pub fn keep_compiled_in(folder: Option<PathBuf>) {
    let _ = FOLDER.set(folder);
}

/// Host of this process.
pub fn host() -> &'static Host {
    HOST.get_or_init(|| Host::new(FOLDER.get_or_init(|| None).clone()))
}

/// File of a plugin as a source of a stage: it is loaded when the recipe is read, and describes its `params`.
/// `parameter` is the parameter that names it; empty for the stage itself.
pub fn source(parameter: &str, role: PluginRole, setting: &Setting) -> Source {
    let under = |key: &str| if parameter.is_empty() { key.to_owned() } else { format!("{parameter}.{key}") };
    let known = setting.clone();
    let read = move |path: &Path| {
        let plugin = load(&known, role, path).map_err(|error| error.diagnostic(None))?;
        check_schema(&plugin.metadata.params_schema)
            .map_err(|message| PluginError::failed(&known.file, "describe", message).diagnostic(None))
    };
    let makes = match role {
        PluginRole::Stage(makes) => Some(makes),
        PluginRole::Term | PluginRole::Objective => None,
    };
    let known = setting.clone();
    let settle = makes.map(|makes| -> Arc<Settle> {
        Arc::new(move |path: &Path| {
            let ready = ready(&known, role, Some(&path.to_path_buf()))?;
            let declared = declaration(&ready.plugin, Arc::new(NoTown), &ready.params);
            let checked = declared.and_then(|declared| misfit(&ready.plugin, tables::check(&declared, makes)));
            checked.map_err(|error| error.diagnostic(None))
        })
    });
    Source {
        parameter: if makes.is_some() { "file".to_owned() } else { under("use") },
        path: PathBuf::from(&setting.file),
        check: Some(SourceCheck { describes: under("params"), read: Arc::new(read), settle }),
    }
}

/// A declaration that does not fit, as a failure of `configure`, which returned it.
fn misfit(plugin: &Plugin, checked: Result<(), tables::PluginRefusal>) -> Result<(), PluginError> {
    checked.map_err(|(message, hint)| {
        let failed = PluginError::failed(&plugin.shown, "configure", message);
        hint.into_iter().fold(failed, PluginError::hint)
    })
}

fn load(setting: &Setting, role: PluginRole, path: &Path) -> Result<Plugin, PluginError> {
    let kind = match role {
        PluginRole::Term => Kind::CostTerm,
        PluginRole::Objective => Kind::Objective,
        PluginRole::Stage(_) => Kind::Stage,
    };
    let (memory_mib, call_ms, fuel) = (setting.limits.memory_mib, setting.limits.call_ms, setting.limits.fuel);
    let plugin = host().load(path, &setting.file, Some(kind), PluginLimits { memory_mib, call_ms, fuel })?;
    if let Some(wanted) = &setting.sha256 {
        let bytes = std::fs::read(path).unwrap_or_default();
        let found: String = Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect();
        if found != *wanted {
            let message = format!("its SHA-256 is `{found}`; the recipe wants `{wanted}`");
            return Err(PluginError::refused(&setting.file, message));
        }
    }
    Ok(plugin)
}

/// A plugin with its parameters.
#[derive(Clone)]
struct Ready {
    plugin: Plugin,
    /// JSON text, defaults filled in.
    params: String,
}

fn ready(setting: &Setting, role: PluginRole, path: Option<&PathBuf>) -> Result<Ready> {
    let path = path.ok_or_else(|| {
        Diagnostic::new("plugin-source", Fault::Bug, format!("plugin `{}` is no source of its stage", setting.file))
    })?;
    let plugin = load(setting, role, path).map_err(|error| error.diagnostic(None))?;
    let schema = check_schema(&plugin.metadata.params_schema)
        .map_err(|message| PluginError::failed(&setting.file, "describe", message).diagnostic(None))?;
    let params = with_defaults(&schema, &setting.params);
    Ok(Ready { plugin, params })
}

/// Plugins of a `plan` stage, or the plugin that is a stage itself.
#[derive(Clone, Default)]
pub struct Plugins {
    terms: Vec<(Ready, String, f64)>,
    other: Option<Ready>,
    /// Item that they run for, in messages.
    item: Option<String>,
}

impl Plugins {
    /// Loads the plugins of an expert from the files at `paths`, in the order of [`ExpertPlugins::settings`].
    ///
    /// # Errors
    /// Files that are not such plugins, and names that are taken.
    pub fn of_expert(config: &ExpertPlugins, paths: &[PathBuf]) -> Result<Self> {
        let mut plugins = Self::default();
        for (index, term) in config.terms.iter().enumerate() {
            let ready = ready(&term.setting(), PluginRole::Term, paths.get(index))?;
            let name = term.name.clone().unwrap_or_else(|| ready.plugin.metadata.name.clone());
            if plugins.terms.iter().any(|(_, known, _)| *known == name) || is_built_in(&name) {
                let message = format!("`terms.{index}` is called `{name}`, and so is another cost term");
                return Err(Diagnostic::new("plugin-name", Fault::Recipe, message)
                    .hint(format!("give it another name: `name = \"{name}_2\"`")));
            }
            plugins.terms.push((ready, name, term.weight));
        }
        if let Some(objective) = &config.plugin {
            plugins.other = Some(ready(&objective.setting(), PluginRole::Objective, paths.get(config.terms.len()))?);
        }
        Ok(plugins)
    }

    /// Loads the plugin that is a stage itself from the file at `paths`.
    ///
    /// # Errors
    /// A file that is not such a plugin.
    pub fn of_stage(setting: &Setting, paths: &[PathBuf]) -> Result<Self> {
        Ok(Self { other: Some(ready(setting, PluginRole::Stage(Makes::default()), paths.first())?), ..Self::default() })
    }

    /// Plugins for the item `item`.
    pub fn for_item(self, item: String) -> Self {
        Self { item: Some(item), ..self }
    }

    /// Runs the plugin of a stage that makes `makes` on a flight; gives its declaration and its answer.
    ///
    /// # Errors
    /// Failures of the plugin.
    pub fn answer(&self, world: &Arc<World>, makes: Makes, flight: &FlightColumns) -> Result<(Declaration, Answered)> {
        let Some(ready) = &self.other else {
            return Err(Diagnostic::new("plugin-source", Fault::Bug, "the stage has no plugin"));
        };
        let encode = |declared: &Declaration| {
            misfit(&ready.plugin, tables::check(declared, makes))?;
            flight.encode(&tables::columns(&declared.reads)).map_err(|refusal| {
                let failed = PluginError::failed(&ready.plugin.shown, "configure", refusal.message);
                refusal.hint.into_iter().fold(failed, PluginError::hint)
            })
        };
        run_stage(&ready.plugin, Arc::new(Town(Arc::clone(world))), &ready.params, encode)
            .map_err(|error| error.diagnostic(self.item.as_deref()))
    }

    /// Name, version and summary of the stage's plugin, as it states them.
    pub fn told(&self) -> [&str; 3] {
        let told = self.other.as_ref().map(|ready| &ready.plugin.metadata);
        told.map_or([""; 3], |told| [&told.name, &told.version, &told.summary])
    }

    /// Diagnostic for an invalid answer of the stage's plugin.
    pub fn wrong_answer(&self, message: String) -> Box<Diagnostic> {
        let shown = self.other.as_ref().map_or("", |ready| &ready.plugin.shown);
        PluginError::failed(shown, "run", message).diagnostic(self.item.as_deref())
    }
}

impl cosfly_flight::FlightPlugins for Plugins {
    fn open_terms(&self, world: &Arc<World>, seed: Seed) -> Result<OpenTerms> {
        let (mut terms, mut began) = (vec![], vec![]);
        for (ready, name, weight) in &self.terms {
            let town: Arc<dyn TownView> = Arc::new(Town(Arc::clone(world)));
            let term = PluginTerm::open(&ready.plugin, town, name, &ready.params, number_of(seed, name));
            let term = term.map_err(|error| error.diagnostic(self.item.as_deref()))?;
            began.push((name.clone(), term.began()));
            terms.push(WeightedTerm { term: Box::new(term), weight: *weight });
        }
        let item = self.item.clone();
        Ok(OpenTerms { terms, warnings: Box::new(move || warnings(&began, item.as_deref())) })
    }

    fn draw_reference(
        &self,
        world: &Arc<World>,
        config: &MucoConfig,
        bounds: [f64; 4],
        seed: Seed,
    ) -> Result<Result<DrawnReference, String>> {
        let Some(ready) = &self.other else { return Ok(Err("no plugin is given".to_owned())) };
        let site = SiteContext {
            seed: number_of(seed, "reference"),
            dt: DT_S,
            max_steps: (LONGEST_S / DT_S) as u32,
            bounds: bounds.to_vec(),
            clearance: config.limits.clearance_m,
            max_speed: config.limits.speed_mps,
            channels: vec![],
        };
        let drawn = draw_reference(&ready.plugin, Arc::new(Town(Arc::clone(world))), &ready.params, site)
            .map_err(|error| error.diagnostic(self.item.as_deref()))?;
        Ok(drawn.map(|drawn| {
            let points = |flat: &[f64]| flat.as_chunks::<3>().0.iter().map(|xyz| DVec3::from_array(*xyz)).collect();
            let (watched, places) = (points(&drawn.plan.watched), points(&drawn.plan.places));
            let reference = Reference { watched, places, pull: drawn.plan.pull };
            DrawnReference { reference, notes: drawn.plan.notes, warnings: drawn.warnings }
        }))
    }
}

/// Warnings of terms for users, after planning.
///
/// # Errors
/// The first failure of a term, which makes the flight invalid.
fn warnings(began: &[(String, Began)], item: Option<&str>) -> Result<Vec<String>> {
    let mut warnings = vec![];
    for (name, began) in began {
        if let Some(failure) = began.failure() {
            return Err(failure.diagnostic(item));
        }
        warnings.extend(began.warnings().into_iter().map(|text| format!("{name}: {text}")));
    }
    Ok(warnings)
}

fn is_built_in(name: &str) -> bool {
    const OTHERS: [&str; 4] = ["standoff", "rendezvous", "reference", "coverage"];
    let weights = serde_json::to_value(MucoConfig::default().weights).unwrap_or_default();
    OTHERS.contains(&name) || weights.get(name).is_some()
}

/// Seed that a plugin is given.
fn number_of(seed: Seed, name: &str) -> u64 {
    let child = seed.child(name, 0);
    let mut first = [0; 8];
    first.copy_from_slice(&child.0[..8]);
    u64::from_le_bytes(first)
}

/// A town as plugins see it.
struct Town(Arc<World>);

impl TownView for Town {
    fn first_hit(&self, from: DVec3, to: DVec3) -> Option<f64> {
        self.0.exact.closest_hit(from, to - from, 1.0).map(|hit| hit.t)
    }

    fn distance_m(&self, point: DVec3, within_m: f64) -> f64 {
        self.0.exact.nearest(point, within_m).map_or(within_m, |nearest| nearest.distance_m)
    }

    fn ground_m(&self, x_m: f64, y_m: f64) -> Option<f64> {
        self.0.ground.ground_height_m(x_m, y_m)
    }

    fn buildings(&self) -> Vec<(u32, OrientedBox)> {
        let buildings = self.0.town.obstacles.iter().filter(|obstacle| obstacle.kind == ObstacleKind::Building);
        let mut boxes: Vec<(u32, OrientedBox)> = buildings.map(|it| (it.object_id, it.shape)).collect();
        boxes.sort_by_key(|(building, _)| *building);
        boxes
    }
}
