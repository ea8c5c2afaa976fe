//! Expert of a `muco` stage: its parameters, a town, a walk and its companions. For the stage itself, and for tools that
//! ask the same expert again from another state.

use crate::parameters;
use crate::plugins::config::ExpertPlugins;
use crate::plugins::{DrawnReference, Plugins, Role, source};
use crate::world::World;
use cosfly_diagnose::ParameterError;
use cosfly_frames::{Seed, TargetTrack};
use cosfly_geometry::OrientedBox;
use cosfly_maps::ObstacleKind;
use cosfly_planner::config::Planner;
use cosfly_planner::objectives::inspect::{self, Inspection};
use cosfly_planner::objectives::patrol::{self, MET_M, Patrol};
use cosfly_planner::objectives::reference;
use cosfly_planner::objectives::{Mission, Objective, ObjectiveConfig, Site, track};
use cosfly_planner::weights::Preset;
use cosfly_planner::{MucoConfig, PlanOutcome, StartState, TermCost, Trajectory, plan_request, visibility};
use cosfly_stage::Source;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Parameters of a `muco` stage.
#[derive(Clone, Debug, Default)]
pub struct Expert {
    /// Weights and limits.
    pub config: MucoConfig,
    /// Objective of the flights.
    pub objective: ObjectiveConfig,
    /// Cost terms and objective from plugins.
    pub plugins: ExpertPlugins,
}

/// A walk that may accompany another one: id and track.
pub type Companion = (String, TargetTrack);

impl Expert {
    /// Schema of all parameters in one table.
    pub fn schema() -> serde_json::Value {
        let own = parameters::merged_schema::<MucoConfig, ObjectiveConfig>();
        parameters::merged_into(own, parameters::schema_of::<ExpertPlugins>())
    }

    /// Reads parameters as recipes give them, or as [`Self::canonical`] gives them.
    ///
    /// # Errors
    /// Values out of range and contradictions, at their place.
    pub fn read(mut given: serde_json::Value) -> Result<Self, ParameterError> {
        let named = ["inspect", "patrol", "plugin"].map(|key| given.get(key).map(|_| key));
        let plugins: ExpertPlugins = parameters::take(&mut given)?;
        let (config, objective) = parameters::read_merged::<MucoConfig, ObjectiveConfig>(given)?;
        plugins.validate()?;
        let refused = |(path, message): (String, String)| parameters::refused_at(&path, message);
        config.validate().map_err(refused)?;
        objective.validate(config.limits.speed_mps).map_err(refused)?;
        let asked = objective.objective.name();
        if let Some(key) = named.into_iter().flatten().find(|key| *key != asked) {
            let message = format!("`{key}` is for `objective = \"{key}\"`; this stage's objective is `{asked}`");
            let hint = Some(format!("set `objective = \"{key}\"`, or leave `{key}` out"));
            return Err(ParameterError { hint, ..parameters::refused_at(key, message) });
        }
        if objective.objective == Objective::Plugin && plugins.plugin.is_none() {
            let hint = Some("add `plugin.use = \"wasm:FILE\"`, and what it is told as `plugin.params`".to_owned());
            let message = "`objective` is `plugin`, but no `plugin` is given";
            return Err(ParameterError { hint, ..parameters::refused_at("objective", message) });
        }
        if config.planner != Planner::Muco && (objective.objective != Objective::Track || config.targets.companions > 0)
        {
            let message = "`planner` names a baseline; only `muco` takes companions and other objectives than `track`";
            return Err(parameters::refused_at("planner", message));
        }
        if objective.objective != Objective::Track && config.targets.companions > 0 {
            let message = format!(
                "`targets.companions` is {}; only `objective = \"track\"` has companions",
                config.targets.companions
            );
            return Err(parameters::refused_at("targets.companions", message));
        }
        check_planner(&config)?;
        Ok(Self { config, objective, plugins })
    }

    /// Number of flights, where that is not the number of walkers.
    pub fn count(&self) -> Option<u64> {
        let of_plugin = self.plugins.plugin.as_ref().filter(|_| self.objective.objective == Objective::Plugin);
        of_plugin.map(|plugin| plugin.count).or_else(|| self.objective.count())
    }

    /// Files of its plugins.
    pub fn sources(&self) -> Vec<Source> {
        let settings = self.plugins.settings();
        let role = |parameter: &str| if parameter == "plugin" { Role::Objective } else { Role::Term };
        settings.iter().map(|(parameter, setting)| source(parameter, role(parameter), setting)).collect()
    }

    /// Parameters with all defaults filled in, for keys. Those that the objective does not read are left out, and so is the
    /// number of flights, on which no single flight depends.
    pub fn canonical(&self) -> serde_json::Value {
        let mut all = parameters::canonical(&self.config);
        let plugins = parameters::canonical(&self.plugins.canonical());
        let defaults = parameters::canonical(&ExpertPlugins::default());
        for (key, value) in
            plugins.as_object().into_iter().flatten().filter(|(key, value)| defaults.get(key) != Some(value))
        {
            all[key] = value.clone();
        }
        let mut objective = parameters::canonical(&self.objective);
        if self.objective.objective == Objective::Track {
            return all;
        }
        let key = self.objective.objective.name();
        all["objective"] = objective["objective"].take();
        if self.objective.objective == Objective::Plugin {
            return all;
        }
        all[key] = objective[key].take();
        if let Some(table) = all[key].as_object_mut() {
            table.remove("count");
        }
        all
    }

    /// Flight behind `walk` and its companions, or one that the objective draws from `seed`. `Err` inside is the reason why
    /// there is nothing to fly.
    ///
    /// # Errors
    /// Failures of a plugin.
    pub fn flight(
        &self,
        world: &Arc<World>,
        walk: Option<TargetTrack>,
        companions: Vec<Companion>,
        seed: Seed,
        plugins: Plugins,
    ) -> cosfly_diagnose::Result<Result<Flight, String>> {
        let drawn = if self.objective.objective == Objective::Plugin {
            let (low, high) = bounds(world);
            match plugins.draw_reference(world, &self.config, [low.x, low.y, high.x, high.y], seed)? {
                Ok(drawn) => Some(drawn),
                Err(reason) => return Ok(Err(reason)),
            }
        } else {
            None
        };
        Ok(self.flight_of(world, walk, companions, seed, plugins, drawn))
    }

    fn flight_of(
        &self,
        world: &World,
        walk: Option<TargetTrack>,
        companions: Vec<Companion>,
        seed: Seed,
        plugins: Plugins,
        drawn: Option<DrawnReference>,
    ) -> Result<Flight, String> {
        let ground = |x: f64, y: f64| world.ground.ground_height_m(x, y).unwrap_or(0.0);
        let structures = if self.objective.objective == Objective::Inspect { buildings(world) } else { Vec::new() };
        let site = Site { exact: &world.exact, structures: &structures, ground: &ground, bounds: bounds(world) };
        let (mission, purpose) = match (self.objective.objective, walk) {
            (Objective::Track, Some(walk)) => (track::mission(walk, &self.config), Purpose::Walker),
            (Objective::Track, None) => return Err("there is no walk to follow".to_owned()),
            (Objective::Inspect, _) => {
                let inspection = inspect::mission(&site, &self.objective.inspect, &self.config, seed)?;

                (inspection.mission.clone(), Purpose::Walls(Box::new(inspection)))
            }
            (Objective::Patrol, _) => {
                let patrol = patrol::mission(&site, &self.objective.patrol, &self.config, seed)?;

                (patrol.mission.clone(), Purpose::Waypoints(Box::new(patrol)))
            }
            (Objective::Plugin, _) => {
                let drawn = drawn.ok_or("there is no reference to fly along")?;
                (reference::mission(&drawn.reference, &self.config), Purpose::Reference(Box::new(drawn)))
            }
        };
        let (companion_ids, companions) = companions.into_iter().unzip();
        let objective = self.objective.clone();
        Ok(Flight { mission, companion_ids, companions, purpose, objective, plugins, seed })
    }
}

/// Refuses parameters that the chosen planner does not support.
fn check_planner(config: &MucoConfig) -> Result<(), ParameterError> {
    let refuse = |path: &str, message: String, hint: &str| {
        Err(ParameterError { hint: Some(hint.to_owned()), ..parameters::refused_at(path, message) })
    };
    let (paper, is_baseline) = (config.preset == Preset::Paper, config.planner.is_baseline());
    let name = config.planner.name();
    if paper && is_baseline {
        let message = format!("`planner` is `{name}`, but `preset = \"paper\"` is a planner of its own");
        return refuse("planner", message, "leave one of the two out; `weights` changes what a baseline weighs");
    }
    if config.occlusion.count > 0 && (paper || is_baseline) {
        let who = if paper { "preset = \"paper\"".to_owned() } else { format!("planner = \"{name}\"") };
        let count = config.occlusion.count;
        let message = format!("`occlusion.count` is {count}, but `{who}` cannot lose its target on purpose");
        return refuse("occlusion.count", message, "leave it out, or take another preset with `planner = \"muco\"`");
    }
    if config.limits.require_kinematics && !config.planner.bounds_kinematics() {
        let message = format!(
            "`planner = \"{name}\"` bounds no acceleration, and `limits.require_kinematics` is true: all its flights would be rejected"
        );
        return refuse("planner", message, "set `limits.require_kinematics = false`, or take `astar_smoothed`");
    }
    Ok(())
}

/// Boxes of each building, by the building's number.
fn buildings(world: &World) -> Vec<Vec<OrientedBox>> {
    let mut boxes: BTreeMap<u32, Vec<OrientedBox>> = BTreeMap::new();
    for obstacle in world.town.obstacles.iter().filter(|obstacle| obstacle.kind == ObstacleKind::Building) {
        boxes.entry(obstacle.object_id).or_default().push(obstacle.shape);
    }
    boxes.into_values().collect()
}

/// Corners of the walkable ground seen from above; of the whole town where there is none.
fn bounds(world: &World) -> (cosfly_frames::DVec2, cosfly_frames::DVec2) {
    let corners = world.town.walkable.iter().flat_map(|polygon| &polygon.outline_in_world);
    let around = corners.map(|corner| corner.truncate()).fold(None, |around, corner| {
        let (low, high) = around.unwrap_or((corner, corner));
        Some((corner.min(low), corner.max(high)))
    });
    around.unwrap_or((world.town.min_in_world.truncate(), world.town.max_in_world.truncate()))
}

enum Purpose {
    Walker,
    Walls(Box<Inspection>),
    Waypoints(Box<Patrol>),
    Reference(Box<DrawnReference>),
}

/// One flight that can be planned, from its beginning or from any state.
pub struct Flight {
    /// Task of the planner.
    pub mission: Mission,
    companion_ids: Vec<String>,
    companions: Vec<TargetTrack>,
    purpose: Purpose,
    objective: ObjectiveConfig,
    plugins: Plugins,
    seed: Seed,
}

impl Flight {
    /// The whole flight, and warnings of plugins for users. An inspection lists its coverage beside its costs, as `coverage`
    /// of weight 0.
    ///
    /// # Errors
    /// Failures of a plugin.
    pub fn plan(&self, world: &Arc<World>) -> cosfly_diagnose::Result<(PlanOutcome, Vec<String>)> {
        let (mut outcome, warnings) = self.plan_mission(world, &self.mission, &self.companions, None)?;
        if let (PlanOutcome::Planned(flight), Purpose::Walls(inspection)) = (&mut outcome, &self.purpose) {
            let ground = |x: f64, y: f64| world.ground.ground_height_m(x, y).unwrap_or(0.0);
            let structures = buildings(world);
            let site = Site { exact: &world.exact, structures: &structures, ground: &ground, bounds: bounds(world) };
            let per_frame = inspection.coverage(&site, &flight.poses_in_world, &self.objective.inspect).gained();
            let sum = per_frame.iter().sum();
            flight.terms.push(TermCost { name: "coverage".to_owned(), weight: 0.0, sum, per_frame });
        }
        Ok((outcome, warnings))
    }

    /// Rest of the flight from `frame` on, at most `frames` long, of a drone that is at `start` then.
    ///
    /// # Errors
    /// Failures of a plugin.
    pub fn plan_from(
        &self,
        world: &Arc<World>,
        frame: usize,
        frames: usize,
        start: StartState,
    ) -> cosfly_diagnose::Result<PlanOutcome> {
        let mission = self.mission.part(frame, frames);
        let end = frame + mission.track.len();
        let part = |companion: &TargetTrack| TargetTrack {
            states: companion.states.get(frame..end).unwrap_or_default().to_vec(),
            ..companion.clone()
        };
        let companions: Vec<TargetTrack> = self.companions.iter().map(part).collect();
        Ok(self.plan_mission(world, &mission, &companions, Some((frame, start)))?.0)
    }

    fn plan_mission(
        &self,
        world: &Arc<World>,
        mission: &Mission,
        companions: &[TargetTrack],
        start: Option<(usize, StartState)>,
    ) -> cosfly_diagnose::Result<(PlanOutcome, Vec<String>)> {
        let ground = |x: f64, y: f64| world.ground.ground_height_m(x, y).unwrap_or(0.0);
        let mut request = mission.request(&world.exact, &world.town.planning_boxes, &ground);
        request.companions = companions;
        if let Some((frame, state)) = start {
            request.start = Some(state);
            request.first_frame = i64::try_from(frame).unwrap_or(i64::MAX);
        }
        let (terms, after) = self.plugins.open_terms(world, self.seed)?;
        request.extra_terms.extend(terms);
        let outcome = plan_request(request);
        Ok((outcome, after.warnings()?))
    }

    /// Notes by name, and warnings, about the whole flight.
    pub fn findings(&self, world: &World, flight: &Trajectory) -> (BTreeMap<String, String>, Vec<String>) {
        let mut notes = BTreeMap::new();
        let mut warnings = Vec::new();
        match &self.purpose {
            Purpose::Walker => {}
            Purpose::Walls(inspection) => {
                let covered = flight.terms.iter().find(|term| term.name == "coverage");
                notes.insert("coverage".to_owned(), format!("{:.3}", covered.map_or(0.0, |term| term.sum)));
                notes.insert("sides".to_owned(), format!("{} of 4", inspection.sides));
            }
            Purpose::Waypoints(patrol) => {
                tell_met(&patrol.shortfalls_m(&flight.poses_in_world), &mut notes, &mut warnings);
            }
            Purpose::Reference(drawn) => {
                notes.extend(drawn.notes.iter().cloned());
                warnings.extend(drawn.warnings.iter().cloned());
                let shortfalls = drawn.reference.shortfalls_m(&flight.poses_in_world);
                if !shortfalls.is_empty() {
                    tell_met(&shortfalls, &mut notes, &mut warnings);
                }
            }
        }
        if !self.companions.is_empty() {
            notes.insert("companions".to_owned(), self.companion_ids.join(", "));
            let seen = self.companions.iter().map(|companion| companion_visibility(world, companion, flight));
            let mean = seen.sum::<f64>() / self.companions.len() as f64;
            notes.insert("visibility of companions".to_owned(), format!("{mean:.3}"));
        }
        let certificate = &flight.certificate;
        let occlusion = &self.mission.config.occlusion;
        if occlusion.count > 0 {
            let reached = certificate.occlusion_reached_s;
            notes.insert("occlusion".to_owned(), format!("{reached} of {} s", certificate.occlusion_ordered_s));
            let least = f64::from(occlusion.count) * occlusion.min_s;
            if reached < least {
                warnings.push(format!("the target was to be lost for {least} s at least and is lost for {reached} s"));
            }
        }
        (notes, warnings)
    }
}

/// Notes the number of waypoints that are met, and warns about the others.
fn tell_met(shortfalls: &[f64], notes: &mut BTreeMap<String, String>, warnings: &mut Vec<String>) {
    let worst = shortfalls.iter().copied().fold(0.0, f64::max);
    let met = shortfalls.iter().filter(|miss| **miss <= MET_M).count();
    let words = format!("{met} of {} within {MET_M} m, worst {worst:.2} m", shortfalls.len());
    notes.insert("waypoints".to_owned(), words);
    for (index, miss) in shortfalls.iter().enumerate().filter(|(_, miss)| **miss > MET_M) {
        warnings.push(format!("waypoint {index} is missed by {miss:.1} m at its time"));
    }
}

fn companion_visibility(world: &World, companion: &TargetTrack, flight: &Trajectory) -> f64 {
    let pairs = companion.states.iter().zip(&flight.poses_in_world);
    let seen = pairs.map(|(state, pose)| visibility(&world.exact, pose.position_in_world, state, companion.height_m));
    seen.sum::<f64>() / companion.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_survive_their_canonical_form_and_tracking_reads_nothing_of_other_objectives() {
        let given =
            serde_json::json!({ "objective": "patrol", "patrol": { "count": 3, "corners": 5 }, "preset": "short" });
        let read = Expert::read(given).unwrap();
        let again = Expert::read(read.canonical()).unwrap();
        assert_eq!((again.objective.patrol.corners, again.objective.patrol.count), (5, 1));
        assert_eq!((again.config, again.objective.objective), (read.config, Objective::Patrol));
        let track = Expert::read(serde_json::json!({ "objective": "track" })).unwrap().canonical();
        assert_eq!(track, parameters::canonical(&MucoConfig::default()));
    }

    #[test]
    fn contradictions_between_objective_preset_and_planner_are_refused_at_their_place() {
        let check = |given: serde_json::Value, path: &[&str]| {
            assert_eq!(Expert::read(given.clone()).expect_err("refused").path, path, "{given}");
        };
        check(
            serde_json::json!({ "objective": "inspect", "targets": { "companions": 1 } }),
            &["targets", "companions"],
        );
        check(serde_json::json!({ "inspect": { "row_m": 2.0 } }), &["inspect"]);
        check(serde_json::json!({ "objective": "inspect", "patrol": {} }), &["patrol"]);
        check(serde_json::json!({ "planner": "astar" }), &["planner"]);
        check(serde_json::json!({ "planner": "beam", "preset": "paper" }), &["planner"]);
        check(serde_json::json!({ "preset": "paper", "occlusion": { "count": 1 } }), &["occlusion", "count"]);
        check(serde_json::json!({ "planner": "astar_smoothed", "occlusion": { "count": 1 } }), &["occlusion", "count"]);
        for fine in [
            serde_json::json!({ "planner": "astar_smoothed" }),
            serde_json::json!({ "planner": "dp", "limits": { "require_kinematics": false } }),
            serde_json::json!({ "objective": "inspect", "inspect": { "row_m": 2.0 } }),
        ] {
            Expert::read(fine).unwrap();
        }
    }
}
