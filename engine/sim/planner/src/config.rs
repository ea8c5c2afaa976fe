//! Parameters of the `muco` stage, their defaults, ranges and contradictions.

use crate::baselines::Baseline;
use crate::paper::config::PaperConfig;
use crate::terms::{WeightOverrides, Weights};
use crate::trajectory::Limits;
use crate::weights::Preset;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the drone is to follow its target.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct MucoConfig {
    /// Named way of flying: `cosfly` (visibility first, the default), `rear` (behind the walker), `short` (short
    /// flights) or `paper` (the paper's weights and its own pipeline).
    pub preset: Preset,
    /// Who plans: `muco` (the default), or a baseline to compare with. What a baseline finds is judged like any flight;
    /// all but `astar_smoothed` bound no acceleration, so set `limits.require_kinematics = false` for them.
    pub planner: Planner,
    /// Single weights that replace those of the preset.
    pub weights: WeightOverrides,
    /// What a flight must never exceed.
    pub limits: LimitsConfig,
    /// Where the drone should be relative to its target.
    pub view: ViewConfig,
    /// The global search for the start.
    pub search: SearchConfig,
    /// Several targets at once.
    pub targets: TargetsConfig,
    /// Losing the target on purpose.
    pub occlusion: OcclusionConfig,
    /// The descent of `preset = "paper"`; of it the other presets use only `difference_m`, for terms without a gradient.
    pub descent: DescentConfig,
    /// What only `preset = "paper"` has.
    pub paper: PaperConfig,
}

/// Who plans.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Planner {
    /// The multi-constraint optimiser of the preset.
    #[default]
    Muco,
    /// The paper's A* over voxels of 2 m and time steps.
    Astar,
    /// Its path, smoothed to the limits of speed, acceleration and jerk.
    AstarSmoothed,
    /// Layered beam search over the same voxels.
    Beam,
    /// The way through the polar lattice, with nothing after it.
    Dp,
}

impl Planner {
    /// Name in recipes.
    pub fn name(self) -> &'static str {
        match self {
            Self::Muco => "muco",
            Self::Astar => "astar",
            Self::AstarSmoothed => "astar_smoothed",
            Self::Beam => "beam",
            Self::Dp => "dp",
        }
    }

    /// The baseline of that name; `None` for the optimiser.
    pub fn baseline(self) -> Option<Baseline> {
        match self {
            Self::Muco => None,
            Self::Astar => Some(Baseline::AstarFast),
            Self::AstarSmoothed => Some(Baseline::AstarSmoothed),
            Self::Beam => Some(Baseline::Beam),
            Self::Dp => Some(Baseline::Dp),
        }
    }
}

/// What is to be seen when companions of the target are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SeveralTargets {
    /// As much as possible of all together.
    #[default]
    Mean,
    /// As much as possible of the one that is seen least.
    Minimum,
}

/// Several targets at once.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TargetsConfig {
    /// Further walkers to be seen beside each target: those that stay nearest to it. Default 0.
    #[schemars(range(min = 0, max = 8))]
    pub companions: u32,
    /// Which visibility counts. Default `mean`.
    pub visibility: SeveralTargets,
}

/// Losing the target on purpose: whole frames in which no body point is seen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct OcclusionConfig {
    /// How often the target is to be lost. What could not be reached is in the certificate. Default 0.
    #[schemars(range(min = 0, max = 100))]
    pub count: u32,
    /// Shortest loss, seconds. Default 2.
    #[schemars(range(min = 0.1, max = 60.0))]
    pub min_s: f64,
    /// Longest loss, seconds; half-way between the two is aimed at. Default 4.
    #[schemars(range(min = 0.1, max = 60.0))]
    pub max_s: f64,
}

/// What a flight must never exceed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct LimitsConfig {
    /// Smallest distance from obstacles along the whole swept path, metres. Default 1.5.
    #[schemars(range(min = 0.1, max = 10.0))]
    pub clearance_m: f64,
    /// Largest speed, m/s. Default 12.
    #[schemars(range(min = 0.5, max = 50.0))]
    pub speed_mps: f64,
    /// Largest acceleration, m/s^2. Default 6.
    #[schemars(range(min = 0.1, max = 100.0))]
    pub acceleration_mps2: f64,
    /// Largest jerk, m/s^3. Default 12.
    #[schemars(range(min = 0.1, max = 1000.0))]
    pub jerk_mps3: f64,
    /// Reject flights beyond the speed, acceleration or jerk limits; if false they are published with the
    /// violation in their certificate. Clearance is always required. Default true.
    pub require_kinematics: bool,
}

/// Where the drone should be relative to its target.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ViewConfig {
    /// Best distance from drone to the target's feet, metres. Default 28.
    #[schemars(range(min = 2.0, max = 200.0))]
    pub distance_m: f64,
    /// Best angle of the line of sight below the horizon, degrees. Default 45.
    #[schemars(range(min = 5.0, max = 85.0))]
    pub pitch_deg: f64,
    /// Altitude below which a strong penalty holds, metres above ground; the search starts here. Default 20.
    #[schemars(range(min = 0.5, max = 200.0))]
    pub min_altitude_m: f64,
    /// Altitude above which a light penalty holds, metres above ground. Default 20.
    #[schemars(range(min = 0.5, max = 200.0))]
    pub preferred_altitude_m: f64,
    /// Highest altitude that is searched, metres above ground. Default 40.
    #[schemars(range(min = 0.5, max = 400.0))]
    pub max_altitude_m: f64,
    /// Smallest horizontal distance that is searched, metres. Default 4.
    #[schemars(range(min = 0.5, max = 200.0))]
    pub min_radius_m: f64,
    /// Largest horizontal distance that is searched, metres. Default 38.
    #[schemars(range(min = 1.0, max = 400.0))]
    pub max_radius_m: f64,
    /// Distance from obstacles below which the soft safety cost acts, metres. Default 8.
    #[schemars(range(min = 0.1, max = 50.0))]
    pub safety_influence_m: f64,
    /// Half-angle of the sector behind the walker that is searched, degrees; 180 allows every side
    /// (the viewpoint weight still prefers the rear). Default 180.
    #[schemars(range(min = 10.0, max = 180.0))]
    pub rear_sector_deg: f64,
}

/// The global search: a shortest path over a lattice of viewpoints around the moving target.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SearchConfig {
    /// How much is searched: `escalating` (the default) tries the fast lattice first, with half the altitudes, four
    /// fifths of the radii and twice the time between viewpoints, and the full one where that is not good enough.
    pub effort: SearchEffort,
    /// Directions around the target. Default 96.
    #[schemars(range(min = 8, max = 360))]
    pub azimuths: u32,
    /// Altitudes between the lowest and the highest. Default 8.
    #[schemars(range(min = 1, max = 8))]
    pub altitudes: u32,
    /// Horizontal distances between the smallest and the largest. Default 10.
    #[schemars(range(min = 1, max = 12))]
    pub radii: u32,
    /// Frames between searched viewpoints; those between are interpolated (paper: 5 to 10). At
    /// short time steps they are half a second apart at least. Default 1.
    #[schemars(range(min = 1, max = 10))]
    pub keyframe_frames: u32,
    /// Cost of moving relative to the target, per square metre and frame. Default 1.
    #[schemars(range(min = 0.001, max = 1000.0))]
    pub relative_motion: f64,
    /// Cost of moving at all, per square metre and frame. Default 1.2.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub absolute_motion: f64,
    /// Boxes further than this from the path (seen from above) are left out of planning, metres. Default 45.
    #[schemars(range(min = 5.0, max = 500.0))]
    pub filter_radius_m: f64,
}

/// How much the global search does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SearchEffort {
    /// The fast lattice; the full one where it finds nothing, nothing valid, or too little visibility.
    #[default]
    Escalating,
    /// The fast lattice, and the full one only where it finds nothing valid.
    Fast,
    /// The full lattice at once.
    Quality,
}

/// The descent (paper, section 3.3 and appendix B).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct DescentConfig {
    /// Largest number of iterations. Default 40.
    #[schemars(range(min = 0, max = 1000))]
    pub iterations: u32,
    /// Finite-difference step, metres: large enough to cross a canopy's edge. Default 0.5.
    #[schemars(range(min = 0.001, max = 0.9))]
    pub difference_m: f64,
    /// Learning rate at the start, and its cap. Default 0.05.
    #[schemars(range(min = 0.000_001, max = 10.0))]
    pub rate: f64,
    /// Learning rate at which the descent stops. Default 0.001.
    #[schemars(range(min = 0.000_000_1, max = 10.0))]
    pub min_rate: f64,
    /// Largest displacement of a waypoint in one iteration, metres. Default 0.5.
    #[schemars(range(min = 0.01, max = 1.0))]
    pub max_move_m: f64,
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
            descent: DescentConfig::default(),
            paper: PaperConfig::default(),
        }
    }
}

impl Default for TargetsConfig {
    fn default() -> Self {
        Self { companions: 0, visibility: SeveralTargets::Mean }
    }
}

impl Default for OcclusionConfig {
    fn default() -> Self {
        Self { count: 0, min_s: 2.0, max_s: 4.0 }
    }
}

impl Default for LimitsConfig {
    fn default() -> Self {
        Self { clearance_m: 1.5, speed_mps: 12.0, acceleration_mps2: 6.0, jerk_mps3: 12.0, require_kinematics: true }
    }
}

impl Default for ViewConfig {
    fn default() -> Self {
        Self {
            distance_m: 28.0,
            pitch_deg: 45.0,
            min_altitude_m: 20.0,
            preferred_altitude_m: 20.0,
            max_altitude_m: 40.0,
            min_radius_m: 4.0,
            max_radius_m: 38.0,
            safety_influence_m: 8.0,
            rear_sector_deg: 180.0,
        }
    }
}

impl Default for SearchConfig {
    fn default() -> Self {
        Self {
            effort: SearchEffort::Escalating,
            azimuths: 96,
            altitudes: 8,
            radii: 10,
            keyframe_frames: 1,
            relative_motion: 1.0,
            absolute_motion: 1.2,
            filter_radius_m: 45.0,
        }
    }
}

impl Default for DescentConfig {
    fn default() -> Self {
        Self { iterations: 40, difference_m: 0.5, rate: 0.05, min_rate: 0.001, max_move_m: 0.5 }
    }
}

impl MucoConfig {
    /// The weights in force.
    pub fn resolved_weights(&self) -> Weights {
        Weights::resolve(self.preset, &self.weights)
    }

    /// The limits that a certificate states.
    pub fn stated_limits(&self) -> Limits {
        Limits {
            clearance_m: self.limits.clearance_m,
            speed_mps: self.limits.speed_mps,
            acceleration_mps2: self.limits.acceleration_mps2,
            jerk_mps3: self.limits.jerk_mps3,
        }
    }

    /// Refuses values out of range and contradictory bands: (path of the parameter, what is wrong).
    pub fn validate(&self) -> Result<(), (String, String)> {
        self.check_ranges()?;
        let v = &self.view;
        let ordered = |low_path: &str, low: f64, high_path: &str, high: f64| {
            if low <= high {
                return Ok(());
            }
            let rule = format!("`{low_path}` is {low}; it must not be above `{high_path}`, which is {high}");
            Err((low_path.to_owned(), rule))
        };
        ordered("view.min_altitude_m", v.min_altitude_m, "view.max_altitude_m", v.max_altitude_m)?;
        ordered("view.min_altitude_m", v.min_altitude_m, "view.preferred_altitude_m", v.preferred_altitude_m)?;
        ordered("view.preferred_altitude_m", v.preferred_altitude_m, "view.max_altitude_m", v.max_altitude_m)?;
        ordered("view.min_radius_m", v.min_radius_m, "view.max_radius_m", v.max_radius_m)?;
        ordered("view.max_radius_m", v.max_radius_m, "search.filter_radius_m", self.search.filter_radius_m)?;
        ordered("occlusion.min_s", self.occlusion.min_s, "occlusion.max_s", self.occlusion.max_s)?;
        self.paper.validate().map_err(|(name, rule)| (format!("paper.{name}"), rule))?;
        ordered("descent.min_rate", self.descent.min_rate, "descent.rate", self.descent.rate)?;
        Ok(())
    }

    fn check_ranges(&self) -> Result<(), (String, String)> {
        let (l, v, s, d) = (&self.limits, &self.view, &self.search, &self.descent);
        for (path, value, low, high) in [
            ("limits.clearance_m", l.clearance_m, 0.1, 10.0),
            ("limits.speed_mps", l.speed_mps, 0.5, 50.0),
            ("limits.acceleration_mps2", l.acceleration_mps2, 0.1, 100.0),
            ("limits.jerk_mps3", l.jerk_mps3, 0.1, 1000.0),
            ("view.distance_m", v.distance_m, 2.0, 200.0),
            ("view.pitch_deg", v.pitch_deg, 5.0, 85.0),
            ("view.min_altitude_m", v.min_altitude_m, 0.5, 200.0),
            ("view.preferred_altitude_m", v.preferred_altitude_m, 0.5, 200.0),
            ("view.max_altitude_m", v.max_altitude_m, 0.5, 400.0),
            ("view.min_radius_m", v.min_radius_m, 0.5, 200.0),
            ("view.max_radius_m", v.max_radius_m, 1.0, 400.0),
            ("view.safety_influence_m", v.safety_influence_m, 0.1, 50.0),
            ("view.rear_sector_deg", v.rear_sector_deg, 10.0, 180.0),
            ("search.azimuths", f64::from(s.azimuths), 8.0, 360.0),
            ("search.altitudes", f64::from(s.altitudes), 1.0, 8.0),
            ("search.radii", f64::from(s.radii), 1.0, 12.0),
            ("search.keyframe_frames", f64::from(s.keyframe_frames), 1.0, 10.0),
            ("search.relative_motion", s.relative_motion, 0.001, 1000.0),
            ("search.absolute_motion", s.absolute_motion, 0.0, 1000.0),
            ("search.filter_radius_m", s.filter_radius_m, 5.0, 500.0),
            ("targets.companions", f64::from(self.targets.companions), 0.0, 8.0),
            ("occlusion.count", f64::from(self.occlusion.count), 0.0, 100.0),
            ("occlusion.min_s", self.occlusion.min_s, 0.1, 60.0),
            ("occlusion.max_s", self.occlusion.max_s, 0.1, 60.0),
            ("descent.iterations", f64::from(d.iterations), 0.0, 1000.0),
            ("descent.difference_m", d.difference_m, 0.001, 0.9),
            ("descent.rate", d.rate, 0.000_001, 10.0),
            ("descent.min_rate", d.min_rate, 0.000_000_1, 10.0),
            ("descent.max_move_m", d.max_move_m, 0.01, 1.0),
        ] {
            in_range(path, value, low, high)?;
        }
        for (name, weight) in self.resolved_weights().named() {
            in_range(&format!("weights.{name}"), weight, 0.0, 1e6)?;
        }
        Ok(())
    }
}

pub(crate) fn in_range(path: &str, value: f64, low: f64, high: f64) -> Result<(), (String, String)> {
    if value >= low && value <= high {
        return Ok(());
    }
    Err((path.to_owned(), format!("`{path}` is {value}; it must be between {low} and {high}")))
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
    }

    #[test]
    fn overrides_replace_single_weights_of_the_preset() {
        let weights = WeightOverrides { visibility: Some(5.0), ..WeightOverrides::default() };
        let config = MucoConfig { preset: Preset::Paper, weights, ..MucoConfig::default() };
        let resolved = config.resolved_weights();
        assert_eq!((resolved.visibility, resolved.tracking), (5.0, 1.0));
    }
}
