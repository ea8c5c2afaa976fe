//! All parameters of a flight, and the checks that run over several tables at once.

use super::descent::DescentConfig;
use super::drones::DronesConfig;
use super::foresight::{CausalConfig, Foresight};
use super::limits::{LimitsConfig, VIEW_RATE_DEG_S};
use super::occlusion::OcclusionConfig;
use super::paper::PaperConfig;
use super::planner::Planner;
use super::ranges::{RangeRefusal, in_range, ordered};
use super::search::SearchConfig;
use super::targets::TargetsConfig;
use super::view::ViewConfig;
use crate::terms::{WeightOverrides, Weights};
use crate::weights::Preset;
use cosfly_domain::Limits;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters of a flight that follows a target.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct MucoConfig {
    /// Named way of flying: `cosfly` (visibility first at a calm pace, the default), `agile` (visibility at any pace), `rear`
    /// (behind the walker), `short` (short flights) or `paper` (the paper's weights and its own pipeline).
    pub preset: Preset,
    /// The planner: `muco` (the default), or a baseline to compare with. A baseline's flight is judged like any other;
    /// all but `astar_smoothed` bound no acceleration, so set `limits.require_kinematics = false` for them.
    pub planner: Planner,
    /// Single weights that replace those of the preset.
    pub weights: WeightOverrides,
    /// Limits that a flight must never exceed.
    pub limits: LimitsConfig,
    /// Wanted position of the drone relative to its target.
    pub view: ViewConfig,
    /// The global search for the start.
    pub search: SearchConfig,
    /// Several targets at once.
    pub targets: TargetsConfig,
    /// Losing the target on purpose.
    pub occlusion: OcclusionConfig,
    /// Knowledge of the expert about the future of its target and of all that moves: `expected` (all, the default) or
    /// `causal` (nothing: it plans again and again as it flies).
    pub foresight: Foresight,
    /// The planning of `foresight = "causal"`.
    pub causal: CausalConfig,
    /// Several drones behind one target.
    pub drones: DronesConfig,
    /// The descent of `preset = "paper"`; of it the other presets use only `difference_m`, for terms without a gradient.
    pub descent: DescentConfig,
    /// Parameters that only `preset = "paper"` reads.
    pub paper: PaperConfig,
}

impl Default for MucoConfig {
    fn default() -> Self {
        Self {
            preset: Preset::Cosfly,
            planner: Planner::Muco,
            weights: WeightOverrides::default(),
            limits: LimitsConfig::default(),
            view: ViewConfig::default(),
            search: SearchConfig::default(),
            targets: TargetsConfig::default(),
            occlusion: OcclusionConfig::default(),
            foresight: Foresight::Expected,
            causal: CausalConfig::default(),
            drones: DronesConfig::default(),
            descent: DescentConfig::default(),
            paper: PaperConfig::default(),
        }
    }
}

impl MucoConfig {
    /// The weights in force.
    pub fn resolved_weights(&self) -> Weights {
        Weights::resolve(self.preset, &self.weights)
    }

    /// The parameters with the values in force in the place of those that are left to the preset: equal parameters plan alike.
    pub fn in_force(&self) -> Self {
        let Limits { yaw_rate_deg_s, pitch_rate_deg_s, .. } = self.stated_limits();
        // No limit has no number.
        let [yaw_rate_deg_s, pitch_rate_deg_s] =
            [yaw_rate_deg_s, pitch_rate_deg_s].map(|rate| Some(rate).filter(|rate| rate.is_finite()));
        Self {
            weights: self.resolved_weights().into(),
            limits: LimitsConfig { yaw_rate_deg_s, pitch_rate_deg_s, ..self.limits.clone() },
            ..self.clone()
        }
    }

    /// The limits that a certificate states.
    pub fn stated_limits(&self) -> Limits {
        // The paper bounds no rates of view, and its flights do not keep them.
        let view_rate_deg_s = if self.preset == Preset::Paper { f64::INFINITY } else { VIEW_RATE_DEG_S };
        Limits {
            clearance_m: self.limits.clearance_m,
            speed_mps: self.limits.speed_mps,
            acceleration_mps2: self.limits.acceleration_mps2,
            jerk_mps3: self.limits.jerk_mps3,
            yaw_rate_deg_s: self.limits.yaw_rate_deg_s.unwrap_or(view_rate_deg_s),
            pitch_rate_deg_s: self.limits.pitch_rate_deg_s.unwrap_or(view_rate_deg_s),
        }
    }

    /// Refuses values out of range and contradictory bands.
    ///
    /// # Errors
    /// The path of the parameter, and the rule that it breaks.
    pub fn validate(&self) -> Result<(), RangeRefusal> {
        self.check_ranges()?;
        self.view.check_order()?;
        let filter_radius = ("search.filter_radius_m", self.search.filter_radius_m);
        ordered(("view.max_radius_m", self.view.max_radius_m), filter_radius)?;
        self.occlusion.check_order()?;
        self.paper.validate().map_err(|(name, rule)| (format!("paper.{name}"), rule))?;
        self.descent.check_order()
    }

    fn check_ranges(&self) -> Result<(), RangeRefusal> {
        let flight = self.limits.ranges().into_iter().chain(self.view.ranges()).chain(self.search.ranges());
        let targets = self.targets.ranges().into_iter().chain(self.occlusion.ranges()).chain(self.causal.ranges());
        let targets = targets.chain(self.drones.ranges());
        for (path, value, low, high) in flight.chain(targets).chain(self.descent.ranges()) {
            in_range(path, value, low, high)?;
        }
        for (name, weight) in self.resolved_weights().named() {
            in_range(&format!("weights.{name}"), weight, 0.0, 1e6)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_refused(change: impl Fn(&mut MucoConfig), path: &str) {
        let mut config = MucoConfig::default();
        change(&mut config);
        let (found, message) = config.validate().expect_err(path);
        assert_eq!(found, path, "{message}");
        assert!(message.contains(path), "{message}");
    }

    #[test]
    fn defaults_are_valid_and_contradictions_name_their_parameter() {
        assert_eq!(MucoConfig::default().validate(), Ok(()));
        check_refused(|c| c.view.min_altitude_m = 50.0, "view.min_altitude_m");
        check_refused(|c| c.view.max_altitude_m = f64::NAN, "view.max_altitude_m");
        check_refused(|c| c.view.min_radius_m = 39.0, "view.min_radius_m");
        check_refused(|c| c.view.max_radius_m = 60.0, "view.max_radius_m");
        check_refused(|c| c.weights.jerk = Some(-1.0), "weights.jerk");
        check_refused(|c| c.descent.min_rate = 1.0, "descent.min_rate");
        check_refused(|c| c.search.radii = 13, "search.radii");
        check_refused(|c| c.drones.separation_m = 0.0, "drones.separation_m");
        check_refused(|c| c.causal.horizon_s = f64::NAN, "causal.horizon_s");
    }

    #[test]
    fn the_parameters_in_force_have_no_gaps_and_plan_alike() {
        for preset in [Preset::Cosfly, Preset::Paper] {
            let config = MucoConfig { preset, ..MucoConfig::default() };
            let in_force = config.in_force();
            let stated = (config.resolved_weights(), config.stated_limits());
            assert_eq!((in_force.resolved_weights(), in_force.stated_limits()), stated);
            assert_eq!(in_force.limits.yaw_rate_deg_s, (preset == Preset::Cosfly).then_some(VIEW_RATE_DEG_S));
            assert!(in_force.weights.visibility.is_some() && in_force == in_force.in_force());
            // What a recipe writes down as it is already is no change.
            let written = MucoConfig { weights: in_force.weights.clone(), ..config };
            assert_eq!(written.in_force(), in_force);
        }
    }

    #[test]
    fn overrides_replace_single_weights_of_the_preset() {
        let weights = WeightOverrides { visibility: Some(5.0), ..WeightOverrides::default() };
        let config = MucoConfig { preset: Preset::Paper, weights, ..MucoConfig::default() };
        let resolved = config.resolved_weights();
        assert_eq!((resolved.visibility, resolved.tracking), (5.0, 1.0));
    }
}
