//! [`CrowdConfig`]: the parameters of people who walk a town together, and the rules between them.

use crate::kinds::is_zero;
use crate::{AreaConfig, HeightRange, KindShares, PedestrianConfig, PedestrianConfigRule, RadiusRange, SpeedConfig};
use cosfly_diagnose::counted;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// People who walk the town together: number, manner of walking, groups, stops.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("x-gone" = { "speed_noise": "write `speed_deviation_share`", "unevenness_mps": "write `step_deviation_mps`" }))]
pub struct CrowdConfig {
    /// Number of people. Default 100.
    #[schemars(range(min = 0, max = 20_000))]
    pub count: u32,
    /// Children, old people and people who take something along, by share. Default none.
    #[serde(skip_serializing_if = "KindShares::is_default")]
    pub kinds: KindShares,
    /// Share of the companies who are restless and turn about every few metres, as children at play and people who search. Flights
    /// behind them are hard (`difficulty`). Default 0.
    #[serde(skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restless_share: f64,
    /// Free walking speed, drawn for each person.
    pub speed: SpeedConfig,
    /// Random variation of a person's own speed, standard deviation as a share of it. Default 0.06.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub speed_deviation_share: f64,
    /// Irregularity of the steps: standard deviation of the velocity along and across the way, m/s. Default 0.1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub step_deviation_mps: f64,
    /// Deceleration before a stop and acceleration after it, m/s2. Default 1.1.
    #[schemars(range(min = 0.1, max = 5.0))]
    pub braking_mps2: f64,
    /// Which side of the way people keep to, and how much they sway.
    pub side: SideConfig,
    /// Pairs and groups who walk abreast.
    pub groups: GroupConfig,
    /// Stops to wait, telephone and chat, and people who stand.
    pub stops: CrowdStopConfig,
    /// Reluctance to walk on kinds of ground.
    pub ground_cost: GroundCostConfig,
    /// Time that must remain between a person and a moving vehicle for the person to step on a road, seconds. Default 2.
    #[schemars(range(min = 0.0, max = 60.0))]
    pub gap_s: f64,
    /// Body height.
    pub height: HeightRange,
    /// Body radius seen from above; the largest is the least distance from obstacles for all.
    pub radius: RadiusRange,
    /// Cell size of the walkable grid, metres. Default 0.5.
    #[schemars(range(min = 0.1, max = 2.0))]
    pub grid_m: f64,
    /// Distance from the edge of the walkable ground that people like to keep, metres. Default 1.6.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub edge_distance_m: f64,
    /// Ground whose pieces are all smaller than this across is refused, metres. Default 20.
    #[schemars(range(min = 1.0, max = 10_000.0))]
    pub min_route_m: f64,
    /// Areas where people begin and have goals more or less often, and areas that nobody enters. Default none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    pub areas: Vec<AreaConfig>,
}

impl Default for CrowdConfig {
    fn default() -> Self {
        let lone = PedestrianConfig::default();
        Self {
            count: 100,
            kinds: KindShares::default(),
            restless_share: 0.0,
            speed: lone.speed,
            speed_deviation_share: 0.06,
            step_deviation_mps: 0.1,
            braking_mps2: 1.1,
            side: SideConfig::default(),
            groups: GroupConfig::default(),
            stops: CrowdStopConfig::default(),
            ground_cost: GroundCostConfig::default(),
            gap_s: 2.0,
            height: lone.height,
            radius: lone.radius,
            grid_m: lone.grid_m,
            edge_distance_m: 1.6,
            min_route_m: lone.min_route_m,
            areas: lone.areas,
        }
    }
}

/// Place of people across their way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SideConfig {
    /// Mean distance to the right of the middle of the way, metres; negative for the left. Default 0.7.
    #[schemars(range(min = -3.0, max = 3.0))]
    pub mean_m: f64,
    /// Standard deviation of that distance between people, metres. Default 0.5.
    #[schemars(range(min = 0.0, max = 3.0))]
    pub deviation_m: f64,
    /// Standard deviation of the sway of one person about the own line (Ornstein-Uhlenbeck), metres. Default 0.15.
    #[schemars(range(min = 0.0, max = 2.0))]
    pub drift_m: f64,
    /// Time after which the sway is forgotten, seconds. Default 3.
    #[schemars(range(min = 0.1, max = 100.0))]
    pub drift_s: f64,
}

impl Default for SideConfig {
    fn default() -> Self {
        Self { mean_m: 0.7, deviation_m: 0.5, drift_m: 0.15, drift_s: 3.0 }
    }
}

/// Pairs and groups who walk abreast where there is room.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct GroupConfig {
    /// Share of the people who walk in groups. Default 0.6.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub share: f64,
    /// Relative frequency of groups of two, three, four and so on. Default [0.75, 0.18, 0.07].
    #[schemars(length(min = 1, max = 5))]
    pub sizes: Vec<f64>,
    /// Distance between neighbours in a group, metres. Default 0.6.
    #[schemars(range(min = 0.3, max = 3.0))]
    pub abreast_m: f64,
}

impl Default for GroupConfig {
    fn default() -> Self {
        Self { share: 0.6, sizes: vec![0.75, 0.18, 0.07], abreast_m: 0.6 }
    }
}

/// Stops, never on a crossing or a carriageway. Their lengths are lognormal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("x-gone" = { "longest_s": "write `max_s`", "spread": "write `log_deviation`" }))]
pub struct CrowdStopConfig {
    /// Mean number of stops in 100 m of walk. Default 0.8.
    #[schemars(range(min = 0.0, max = 50.0))]
    pub per_100m: f64,
    /// Median length of a stop, seconds. Default 2.2.
    #[schemars(range(min = 0.1, max = 3600.0))]
    pub median_s: f64,
    /// Spread of the lengths: standard deviation of their natural logarithm. Default 1.
    #[schemars(range(min = 0.0, max = 3.0))]
    pub log_deviation: f64,
    /// Longest stop, seconds. Default 120.
    #[schemars(range(min = 0.1, max = 3600.0))]
    pub max_s: f64,
    /// Share of the people, or of their groups, who stand in one place for all frames. Default 0.02.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub standing_share: f64,
}

impl Default for CrowdStopConfig {
    fn default() -> Self {
        Self { per_100m: 0.8, median_s: 2.2, log_deviation: 1.0, max_s: 120.0, standing_share: 0.02 }
    }
}

/// Cost of a metre on kinds of ground, as a multiple of a metre of pavement: people go so far out of their way to avoid it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct GroundCostConfig {
    /// Crossings. Default 1.2.
    #[schemars(range(min = 1.0, max = 1000.0))]
    pub crossing: f64,
    /// Shoulders, verges and grass beside the road. Default 2.
    #[schemars(range(min = 1.0, max = 1000.0))]
    pub shoulder: f64,
    /// Carriageways. Default 20.
    #[schemars(range(min = 1.0, max = 1000.0))]
    pub road: f64,
}

impl Default for GroundCostConfig {
    fn default() -> Self {
        Self { crossing: 1.2, shoulder: 2.0, road: 20.0 }
    }
}

impl CrowdConfig {
    /// Checks the ranges and the rules between values.
    ///
    /// # Errors
    /// The first broken rule.
    pub fn check(&self) -> Result<(), PedestrianConfigRule> {
        PedestrianConfigRule::within(&["count"], f64::from(self.count), 0.0, 20_000.0)?;
        self.body_and_grid().check()?;
        self.kinds.check()?;
        let numbers: [(&'static [&'static str], f64, f64, f64); 18] = [
            (&["restless_share"], self.restless_share, 0.0, 1.0),
            (&["speed_deviation_share"], self.speed_deviation_share, 0.0, 0.5),
            (&["step_deviation_mps"], self.step_deviation_mps, 0.0, 1.0),
            (&["braking_mps2"], self.braking_mps2, 0.1, 5.0),
            (&["side", "mean_m"], self.side.mean_m, -3.0, 3.0),
            (&["side", "deviation_m"], self.side.deviation_m, 0.0, 3.0),
            (&["side", "drift_m"], self.side.drift_m, 0.0, 2.0),
            (&["side", "drift_s"], self.side.drift_s, 0.1, 100.0),
            (&["groups", "share"], self.groups.share, 0.0, 1.0),
            (&["groups", "abreast_m"], self.groups.abreast_m, 0.3, 3.0),
            (&["stops", "per_100m"], self.stops.per_100m, 0.0, 50.0),
            (&["stops", "median_s"], self.stops.median_s, 0.1, 3600.0),
            (&["stops", "log_deviation"], self.stops.log_deviation, 0.0, 3.0),
            (&["stops", "max_s"], self.stops.max_s, 0.1, 3600.0),
            (&["stops", "standing_share"], self.stops.standing_share, 0.0, 1.0),
            (&["ground_cost", "crossing"], self.ground_cost.crossing, 1.0, 1000.0),
            (&["ground_cost", "shoulder"], self.ground_cost.shoulder, 1.0, 1000.0),
            (&["ground_cost", "road"], self.ground_cost.road, 1.0, 1000.0),
        ];
        for (path, value, min, max) in numbers {
            PedestrianConfigRule::within(path, value, min, max)?;
        }
        PedestrianConfigRule::within(&["gap_s"], self.gap_s, 0.0, 60.0)?;
        self.groups.check()?;
        PedestrianConfigRule::in_order(&["stops", "median_s"], self.stops.median_s, "max_s", self.stops.max_s)
    }

    /// Body sizes, speeds and grid, as the pedestrians who walk alone have them.
    pub fn body_and_grid(&self) -> PedestrianConfig {
        PedestrianConfig {
            speed: self.speed.clone(),
            height: self.height.clone(),
            radius: RadiusRange { max_m: self.kinds.clearance_m(self.radius.max_m), ..self.radius.clone() },
            grid_m: self.grid_m,
            edge_distance_m: self.edge_distance_m,
            min_route_m: self.min_route_m,
            areas: self.areas.clone(),
            ..PedestrianConfig::default()
        }
    }
}

impl GroupConfig {
    fn check(&self) -> Result<(), PedestrianConfigRule> {
        let refused = |message: String| Err(PedestrianConfigRule { path: vec!["groups", "sizes"], message });
        if self.sizes.is_empty() || self.sizes.len() > 5 {
            return refused(format!(
                "`sizes` has {}; it must have between 1 and 5",
                counted(self.sizes.len(), "number")
            ));
        }
        if let Some(size) = self.sizes.iter().find(|size| !(0.0..=1e6).contains(*size)) {
            return refused(format!("`sizes` contains `{size}`; its numbers must be within `0` and `1000000`"));
        }
        if self.sizes.iter().sum::<f64>() <= 0.0 {
            return refused("the numbers of `sizes` are all `0`; at least one must be above `0`".into());
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_keep_their_own_rules() {
        CrowdConfig::default().check().unwrap();
    }

    #[test]
    fn a_broken_rule_names_its_field() {
        let refused = |change: fn(&mut CrowdConfig)| {
            let mut config = CrowdConfig::default();
            change(&mut config);
            config.check().unwrap_err().message
        };
        assert_eq!(refused(|it| it.gap_s = f64::NAN), "`gap_s` is `NaN`; it must be within `0` and `60`");
        assert_eq!(refused(|it| it.groups.sizes.clear()), "`sizes` has 0 numbers; it must have between 1 and 5");
        assert_eq!(
            refused(|it| it.groups.sizes = vec![0.0, 0.0]),
            "the numbers of `sizes` are all `0`; at least one must be above `0`"
        );
        assert_eq!(
            refused(|it| it.stops.median_s = 200.0),
            "`median_s` is `200`; it must not be more than `max_s`, which is `120`"
        );
        assert_eq!(
            refused(|it| it.radius.min_m = 1.0),
            "`min_m` is `1`; it must not be more than `max_m`, which is `0.28`"
        );
    }
}
