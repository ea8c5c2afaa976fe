//! [`PedestrianConfig`]: the parameters of pedestrians in a recipe, and the rules between them.

use crate::kinds::is_zero;
use crate::{AreaConfig, KindShares, PedestrianConfigRule};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Simulated pedestrians: number, length of the walks, manner of walking.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("x-gone" = { "speed_noise": "write `speed_variation_share`", "steps": "write `frames`, as in stage `traffic`" }))]
pub struct PedestrianConfig {
    /// Number of pedestrian paths. Default 4.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub count: u64,
    /// Frames of each path. Default 200.
    #[schemars(range(min = 2, max = 100_000))]
    pub frames: u32,
    /// Time between frames, seconds. Default 0.5.
    #[schemars(range(min = 0.01, max = 10.0))]
    pub dt_s: f64,
    /// Walking speed.
    pub speed: SpeedConfig,
    /// Slowdown in bends: speed is divided by 1 + `turn_slowdown_m` x curvature (1/m). Metres. Default 1.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub turn_slowdown_m: f64,
    /// Random variation of the speed, as a share of it. Default 0.1.
    #[schemars(range(min = 0.0, max = 0.9))]
    pub speed_variation_share: f64,
    /// Random stops.
    pub stops: StopConfig,
    /// Children, old people, runners and people who take something along, by share. Default none.
    #[serde(skip_serializing_if = "KindShares::is_default")]
    pub kinds: KindShares,
    /// Share of restless pedestrians, who turn about every few metres, as children at play and people who search. Flights
    /// behind them are hard (`difficulty`). Default 0.
    #[serde(skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restless_share: f64,
    /// Body height.
    pub height: HeightRange,
    /// Body radius seen from above; the largest is the least distance from obstacles for all.
    pub radius: RadiusRange,
    /// Cell size of the walkable grid, metres. Default 0.5.
    #[schemars(range(min = 0.1, max = 2.0))]
    pub grid_m: f64,
    /// Largest distance of the simplified route from the grid route (Douglas-Peucker), metres. Default 0.2.
    #[schemars(range(min = 0.0, max = 5.0))]
    pub simplify_m: f64,
    /// Distance from the edge of the walkable ground that pedestrians like to keep, metres. Default 0.8.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub edge_distance_m: f64,
    /// Ground whose pieces are all smaller than this across is refused, metres. Default 20.
    #[schemars(range(min = 1.0, max = 10_000.0))]
    pub min_route_m: f64,
    /// Areas where walks begin and have goals more or less often, and areas that nobody enters. Default none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    pub areas: Vec<AreaConfig>,
}

impl Default for PedestrianConfig {
    fn default() -> Self {
        Self {
            count: 4,
            frames: 200,
            dt_s: 0.5,
            speed: SpeedConfig::default(),
            turn_slowdown_m: 1.0,
            speed_variation_share: 0.1,
            stops: StopConfig::default(),
            kinds: KindShares::default(),
            restless_share: 0.0,
            height: HeightRange::default(),
            radius: RadiusRange::default(),
            grid_m: 0.5,
            simplify_m: 0.2,
            edge_distance_m: 0.8,
            min_route_m: 20.0,
            areas: vec![],
        }
    }
}

/// Walking speed: each pedestrian draws a cruise speed from a normal distribution, clipped to the limits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SpeedConfig {
    /// Mean cruise speed, m/s. Default 1.34.
    #[schemars(range(min = 0.05, max = 10.0))]
    pub mean_mps: f64,
    /// Standard deviation of the cruise speed between pedestrians, m/s. Default 0.26.
    #[schemars(range(min = 0.0, max = 5.0))]
    pub deviation_mps: f64,
    /// Slowest walking, m/s; standing is a stop. Default 0.5.
    #[schemars(range(min = 0.05, max = 10.0))]
    pub min_mps: f64,
    /// Fastest walking, m/s. Default 2.2.
    #[schemars(range(min = 0.05, max = 10.0))]
    pub max_mps: f64,
}

impl Default for SpeedConfig {
    fn default() -> Self {
        Self { mean_mps: 1.34, deviation_mps: 0.26, min_mps: 0.5, max_mps: 2.2 }
    }
}

/// Random stops, never on a crossing or a carriageway.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct StopConfig {
    /// Mean number of stops in 100 m of walk. Default 1.
    #[schemars(range(min = 0.0, max = 50.0))]
    pub per_100m: f64,
    /// Shortest stop, seconds. Default 2.
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub min_s: f64,
    /// Longest stop, seconds. Default 8.
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub max_s: f64,
}

impl Default for StopConfig {
    fn default() -> Self {
        Self { per_100m: 1.0, min_s: 2.0, max_s: 8.0 }
    }
}

/// Body height, drawn uniformly for each pedestrian.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct HeightRange {
    /// Smallest, metres. Default 1.55.
    #[schemars(range(min = 0.5, max = 3.0))]
    pub min_m: f64,
    /// Largest, metres. Default 1.9.
    #[schemars(range(min = 0.5, max = 3.0))]
    pub max_m: f64,
}

impl Default for HeightRange {
    fn default() -> Self {
        Self { min_m: 1.55, max_m: 1.9 }
    }
}

/// Body radius seen from above, drawn uniformly for each pedestrian.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct RadiusRange {
    /// Smallest, metres. Default 0.22.
    #[schemars(range(min = 0.05, max = 2.0))]
    pub min_m: f64,
    /// Largest, metres. Default 0.28.
    #[schemars(range(min = 0.05, max = 2.0))]
    pub max_m: f64,
}

impl Default for RadiusRange {
    fn default() -> Self {
        Self { min_m: 0.22, max_m: 0.28 }
    }
}

impl PedestrianConfig {
    /// Parameters that no single walk depends on; not in its key.
    pub const NOT_IN_KEY: &[&str] = &["count"];

    /// Checks what the schema cannot say (order of limits) and, for callers without a schema, finiteness.
    pub fn check(&self) -> Result<(), PedestrianConfigRule> {
        let numbers: [(&'static [&'static str], f64, f64, f64); 18] = [
            (&["dt_s"], self.dt_s, 0.01, 10.0),
            (&["speed", "mean_mps"], self.speed.mean_mps, 0.05, 10.0),
            (&["speed", "deviation_mps"], self.speed.deviation_mps, 0.0, 5.0),
            (&["speed", "min_mps"], self.speed.min_mps, 0.05, 10.0),
            (&["speed", "max_mps"], self.speed.max_mps, 0.05, 10.0),
            (&["turn_slowdown_m"], self.turn_slowdown_m, 0.0, 100.0),
            (&["speed_variation_share"], self.speed_variation_share, 0.0, 0.9),
            (&["stops", "per_100m"], self.stops.per_100m, 0.0, 50.0),
            (&["stops", "min_s"], self.stops.min_s, 0.0, 3600.0),
            (&["stops", "max_s"], self.stops.max_s, 0.0, 3600.0),
            (&["restless_share"], self.restless_share, 0.0, 1.0),
            (&["height", "min_m"], self.height.min_m, 0.5, 3.0),
            (&["height", "max_m"], self.height.max_m, 0.5, 3.0),
            (&["radius", "min_m"], self.radius.min_m, 0.05, 2.0),
            (&["radius", "max_m"], self.radius.max_m, 0.05, 2.0),
            (&["grid_m"], self.grid_m, 0.1, 2.0),
            (&["simplify_m"], self.simplify_m, 0.0, 5.0),
            (&["edge_distance_m"], self.edge_distance_m, 0.0, 10.0),
        ];
        for (path, value, min, max) in numbers {
            PedestrianConfigRule::within(path, value, min, max)?;
        }
        self.kinds.check()?;
        AreaConfig::check(&self.areas)?;
        PedestrianConfigRule::within(&["min_route_m"], self.min_route_m, 1.0, 10_000.0)?;
        PedestrianConfigRule::within(&["frames"], f64::from(self.frames), 2.0, 100_000.0)?;
        let duration_s = f64::from(self.frames) * self.dt_s;
        if duration_s > 86_400.0 {
            let message = format!("`frames` x `dt_s` is `{duration_s}` s; it must not be more than a day, `86400` s");
            return Err(PedestrianConfigRule { path: vec!["frames"], message });
        }
        PedestrianConfigRule::in_order(&["speed", "min_mps"], self.speed.min_mps, "max_mps", self.speed.max_mps)?;
        PedestrianConfigRule::in_order(&["stops", "min_s"], self.stops.min_s, "max_s", self.stops.max_s)?;
        PedestrianConfigRule::in_order(&["height", "min_m"], self.height.min_m, "max_m", self.height.max_m)?;
        PedestrianConfigRule::in_order(&["radius", "min_m"], self.radius.min_m, "max_m", self.radius.max_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_keep_their_own_rules() {
        PedestrianConfig::default().check().unwrap();
    }

    #[test]
    fn a_broken_rule_names_its_field() {
        let mut config = PedestrianConfig::default();
        config.speed.min_mps = 3.0;
        let rule = config.check().unwrap_err();
        assert_eq!(rule.path, ["speed", "min_mps"]);
        assert_eq!(rule.message, "`min_mps` is `3`; it must not be more than `max_mps`, which is `2.2`");
        let corners = vec![[0.0, 0.0], [1.0, f64::INFINITY], [2.0, 0.0]];
        let area = AreaConfig { polygon_m: corners, ..AreaConfig::default() };
        let far = PedestrianConfig { areas: vec![area], ..PedestrianConfig::default() };
        let message = "area 0 has a corner at `inf`; corners must be within `100000` m of the origin";
        assert_eq!(far.check().unwrap_err().message, message);
        let nan = PedestrianConfig { dt_s: f64::NAN, ..PedestrianConfig::default() };
        assert_eq!(nan.check().unwrap_err().message, "`dt_s` is `NaN`; it must be within `0.01` and `10`");
    }

    #[test]
    fn the_schema_names_every_unit_and_range() {
        let schema = serde_json::to_value(schemars::schema_for!(PedestrianConfig)).unwrap();
        assert_eq!(schema["properties"]["count"]["maximum"], 1_000_000);
        assert_eq!(schema["properties"]["dt_s"]["default"], 0.5);
        assert_eq!(schema["additionalProperties"], false);
    }
}
