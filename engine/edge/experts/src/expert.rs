//! Parameters of an expert in a recipe: for the stage that plans, and for tools that ask the same expert again.
use crate::plugins::config::ExpertPlugins;
use crate::plugins::{PluginRole, source};
use cosfly_diagnose::ParameterError;
use cosfly_flight::Expert;
use cosfly_objectives::{InspectionConfig, Objective, ObjectiveConfig, PatrolConfig};
use cosfly_pilot::aim::AimConfig;
use cosfly_planner::config::{DronesConfig, Foresight, Planner};
use cosfly_planner::{MucoConfig, Preset};
use cosfly_stage::{Source, parameters};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An expert as a recipe describes it: parameters of a `plan` stage.
#[derive(Clone, Debug, Default)]
pub struct RecipeExpert {
    /// Weights, objective and aim.
    pub expert: Expert,
    /// Cost terms and objective from plugins.
    pub plugins: ExpertPlugins,
}

/// The pilot of a `plan` stage.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct Pilot {
    /// Aim of the camera at a walker: framing, lag and lead, and the largest rates of turning.
    aim: AimConfig,
}

impl RecipeExpert {
    /// Schema of all parameters in one table.
    pub fn schema() -> serde_json::Value {
        let own = parameters::merged_schema::<MucoConfig, ObjectiveConfig>();
        let own = parameters::merged_into(own, parameters::schema_of::<ExpertPlugins>());
        parameters::merged_into(own, parameters::schema_of::<Pilot>())
    }

    /// Reads parameters as recipes give them, or as [`Self::canonical`] gives them.
    ///
    /// # Errors
    /// Values out of range and contradictions, at their place.
    pub fn read(mut given: serde_json::Value) -> Result<Self, ParameterError> {
        let named = ["inspect", "patrol", "plugin"].map(|key| given.get(key).map(|_| key));
        let plugins: ExpertPlugins = parameters::take(&mut given)?;
        let aims = given.get("aim").is_some();
        let Pilot { aim } = parameters::take(&mut given)?;
        let (config, objective) = parameters::read_merged::<MucoConfig, ObjectiveConfig>(given)?;
        plugins.validate()?;
        let refused = |(path, message): (String, String)| parameters::refused_at(&path, message);
        config.validate().map_err(refused)?;
        aim.validate().map_err(|(path, message)| refused((format!("aim.{path}"), message)))?;
        objective.validate(config.limits.speed_mps).map_err(refused)?;
        let asked = objective.objective.name();
        if let Some(key) = named.into_iter().flatten().find(|key| *key != asked) {
            let message = format!("`{key}` is for `objective = \"{key}\"`; this stage's objective is `{asked}`");
            let hint = Some(format!("set `objective = \"{key}\"`, or leave `{key}` out"));
            return Err(ParameterError { hint, ..parameters::refused_at(key, message) });
        }
        if aims && objective.objective != Objective::Track {
            let message =
                format!("`aim` is the aim at a walker; this stage's objective is `{asked}`, which follows nobody");
            let hint = Some("leave `aim` out".to_owned());
            return Err(ParameterError { hint, ..parameters::refused_at("aim", message) });
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
        check_foresight(&config, &objective)?;
        check_drones(&config, &objective, &plugins)?;
        Ok(Self { expert: Expert { config, objective, aim }, plugins })
    }

    /// Number of flights, where that is not the number of walkers.
    pub fn count(&self) -> Option<u64> {
        let of_plugin = self.plugins.plugin.as_ref().filter(|_| self.expert.objective.objective == Objective::Plugin);
        of_plugin.map(|plugin| plugin.count).or_else(|| self.expert.objective.count())
    }

    /// Files of its plugins.
    pub fn sources(&self) -> Vec<Source> {
        let settings = self.plugins.settings();
        let role = |parameter: &str| if parameter == "plugin" { PluginRole::Objective } else { PluginRole::Term };
        settings.iter().map(|(parameter, setting)| source(parameter, role(parameter), setting)).collect()
    }

    /// Parameters with the values in force, for keys and for reasons of changes. Those that the objective does not read are left out, and so are the
    /// numbers of flights and drones, on which no single flight depends.
    pub fn canonical(&self) -> serde_json::Value {
        let mut all = parameters::canonical(&self.expert.config.in_force());
        let plugins = parameters::canonical(&self.plugins.canonical());
        let defaults = parameters::canonical(&ExpertPlugins::default());
        for (key, value) in
            plugins.as_object().into_iter().flatten().filter(|(key, value)| defaults.get(key) != Some(value))
        {
            all[key] = value.clone();
        }
        let mut objective = parameters::canonical(&self.expert.objective);
        // What is left at its default is left out, so that recipes that know none of it keep their keys.
        if self.expert.config.foresight == Foresight::Expected {
            all = parameters::without(all, &["foresight", "causal"]);
        }
        if self.expert.config.drones.count == 1 {
            all = parameters::without(all, &["drones"]);
        } else {
            all["drones"] = parameters::without(all["drones"].take(), DronesConfig::NOT_IN_KEY);
        }
        if self.expert.objective.objective == Objective::Track {
            all["aim"] = parameters::canonical(&self.expert.aim);
            return all;
        }
        let key = self.expert.objective.objective.name();
        all["objective"] = objective["objective"].take();
        if self.expert.objective.objective == Objective::Plugin {
            return all;
        }
        let not_in_key = match self.expert.objective.objective {
            Objective::Patrol => PatrolConfig::NOT_IN_KEY,
            _ => InspectionConfig::NOT_IN_KEY,
        };
        all[key] = parameters::without(objective[key].take(), not_in_key);
        all
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

/// Refuses parameters that an expert who knows only the past does not support.
fn check_foresight(config: &MucoConfig, objective: &ObjectiveConfig) -> Result<(), ParameterError> {
    if config.foresight == Foresight::Expected {
        return Ok(());
    }
    let name = objective.objective.name();
    let reason = if objective.objective != Objective::Track {
        format!("flies behind walkers; this stage's objective is `{name}`")
    } else if config.planner.is_baseline() || config.preset == Preset::Paper {
        "is for `planner = \"muco\"` with another preset than `paper`".to_owned()
    } else {
        return check_loss_ahead(config);
    };
    let message = format!("`foresight = \"causal\"` {reason}");
    let hint = Some("leave `foresight` out, or the other one of the two".to_owned());
    Err(ParameterError { hint, ..parameters::refused_at("foresight", message) })
}

/// Refuses losses that an expert who knows only the past does not look far enough ahead for: a plan holds as long a way before
/// and behind its loss.
fn check_loss_ahead(config: &MucoConfig) -> Result<(), ParameterError> {
    let (occlusion, horizon_s) = (&config.occlusion, config.causal.horizon_s);
    let least_s = 2.0 * (occlusion.min_s + occlusion.max_s);
    if occlusion.count == 0 || horizon_s >= least_s {
        return Ok(());
    }
    let message = format!(
        "`causal.horizon_s` is {horizon_s}; to lose the target for {} to {} s on purpose it must be at least {least_s}",
        occlusion.min_s, occlusion.max_s
    );
    let hint = Some("raise it, or order shorter losses".to_owned());
    Err(ParameterError { hint, ..parameters::refused_at("causal.horizon_s", message) })
}

/// Refuses what several drones do not support.
fn check_drones(
    config: &MucoConfig,
    objective: &ObjectiveConfig,
    plugins: &ExpertPlugins,
) -> Result<(), ParameterError> {
    if config.drones.count == 1 {
        return Ok(());
    }
    let reason = if objective.objective != Objective::Track {
        format!("this stage's objective is `{}`, which follows nobody", objective.objective.name())
    } else if !plugins.terms.is_empty() {
        "cost terms of plugins may be drawn for each flight anew, so that flights would not know of each other"
            .to_owned()
    } else {
        return Ok(());
    };
    let message = format!("`drones.count` is {}, but {reason}", config.drones.count);
    let hint = Some("leave `drones.count` out".to_owned());
    Err(ParameterError { hint, ..parameters::refused_at("drones.count", message) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_survive_their_canonical_form_and_tracking_reads_nothing_of_other_objectives() {
        let given =
            serde_json::json!({ "objective": "patrol", "patrol": { "count": 3, "corners": 5 }, "preset": "short" });
        let read = RecipeExpert::read(given).unwrap();
        let again = RecipeExpert::read(read.canonical()).unwrap();
        assert_eq!((again.expert.objective.patrol.corners, again.expert.objective.patrol.count), (5, 1));
        assert_eq!(
            (again.expert.config, again.expert.objective.objective),
            (read.expert.config.in_force(), Objective::Patrol)
        );
        let track = RecipeExpert::read(serde_json::json!({ "objective": "track" })).unwrap().canonical();
        let mut defaults = parameters::canonical(&MucoConfig::default().in_force());
        for key in ["foresight", "causal", "drones"] {
            defaults.as_object_mut().unwrap().remove(key);
        }
        defaults["aim"] = parameters::canonical(&AimConfig::default());
        assert_eq!(track, defaults);
        let drones = |count: u32| {
            RecipeExpert::read(serde_json::json!({ "drones": { "count": count, "separation_m": 9.0 } }))
                .unwrap()
                .canonical()
        };
        assert_eq!(drones(2), drones(3));
        assert_eq!(drones(2)["drones"], serde_json::json!({ "separation_m": 9.0 }));
    }

    #[test]
    fn contradictions_between_objective_preset_and_planner_are_refused_at_their_place() {
        let check = |given: serde_json::Value, path: &[&str]| {
            assert_eq!(RecipeExpert::read(given.clone()).expect_err("refused").path, path, "{given}");
        };
        check(
            serde_json::json!({ "objective": "inspect", "targets": { "companions": 1 } }),
            &["targets", "companions"],
        );
        check(serde_json::json!({ "aim": { "lag_s": 9.0 } }), &["aim", "lag_s"]);
        check(serde_json::json!({ "objective": "patrol", "aim": {} }), &["aim"]);
        check(serde_json::json!({ "inspect": { "row_m": 2.0 } }), &["inspect"]);
        check(serde_json::json!({ "objective": "inspect", "patrol": {} }), &["patrol"]);
        check(serde_json::json!({ "planner": "astar" }), &["planner"]);
        check(serde_json::json!({ "planner": "beam", "preset": "paper" }), &["planner"]);
        check(serde_json::json!({ "preset": "paper", "occlusion": { "count": 1 } }), &["occlusion", "count"]);
        check(serde_json::json!({ "planner": "astar_smoothed", "occlusion": { "count": 1 } }), &["occlusion", "count"]);
        check(serde_json::json!({ "drones": { "count": 2 }, "objective": "patrol" }), &["drones", "count"]);
        check(serde_json::json!({ "drones": { "count": 0 } }), &["drones", "count"]);
        check(serde_json::json!({ "foresight": "causal", "objective": "patrol" }), &["foresight"]);
        check(serde_json::json!({ "foresight": "causal", "planner": "astar_smoothed" }), &["foresight"]);
        check(serde_json::json!({ "foresight": "causal", "occlusion": { "count": 1 } }), &["causal", "horizon_s"]);
        check(serde_json::json!({ "foresight": "causal", "causal": { "horizon_s": 0.5 } }), &["causal", "horizon_s"]);
        for fine in [
            serde_json::json!({ "foresight": "causal", "causal": { "horizon_s": 5.0 } }),
            serde_json::json!({ "foresight": "causal", "causal": { "horizon_s": 12.0 }, "occlusion": { "count": 1 } }),
            serde_json::json!({ "planner": "astar_smoothed" }),
            serde_json::json!({ "planner": "dp", "limits": { "require_kinematics": false } }),
            serde_json::json!({ "objective": "inspect", "inspect": { "row_m": 2.0 } }),
        ] {
            RecipeExpert::read(fine).unwrap();
        }
    }
}
