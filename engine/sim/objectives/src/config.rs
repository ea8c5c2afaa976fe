//! Parameters of objectives, their defaults and ranges.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Purpose of flights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Objective {
    /// Follow a walker.
    #[default]
    Track,
    /// Cover the facades of a building.
    Inspect,
    /// Meet timed waypoints, one after the other.
    Patrol,
    /// The purpose that a plugin gives.
    Plugin,
}

impl Objective {
    /// Name in recipes.
    pub fn name(self) -> &'static str {
        match self {
            Self::Track => "track",
            Self::Inspect => "inspect",
            Self::Patrol => "patrol",
            Self::Plugin => "plugin",
        }
    }
}

/// Purpose of flights, with its parameters.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ObjectiveConfig {
    /// Purpose of flights: `track` follows a walker each (the default), `inspect` covers the facades of buildings,
    /// `patrol` meets timed waypoints, `plugin` is what a plugin says. The last three take no `inputs.walks`.
    pub objective: Objective,
    /// Inspection of buildings; `objective = "inspect"` only.
    pub inspect: InspectionConfig,
    /// Waypoints of patrols; `objective = "patrol"` only.
    pub patrol: PatrolConfig,
}

/// Inspection of buildings. Distance, pitch, altitudes and radii of `view` are set by these.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct InspectionConfig {
    /// Number of flights, each around a building of its own draw. Default 1.
    #[schemars(range(min = 1, max = 100_000))]
    pub count: u64,
    /// Distance kept from the wall, metres. Default 12.
    #[schemars(range(min = 4.0, max = 60.0))]
    pub standoff_m: f64,
    /// Height between rows, metres. Default 6.
    #[schemars(range(min = 1.0, max = 30.0))]
    pub row_m: f64,
    /// Speed along the rows, m/s. Default 2.
    #[schemars(range(min = 0.2, max = 10.0))]
    pub speed_mps: f64,
    /// Lowest building that is chosen, metres. Default 6.
    #[schemars(range(min = 2.0, max = 200.0))]
    pub min_height_m: f64,
    /// Highest building that is chosen, metres. Default 40.
    #[schemars(range(min = 2.0, max = 400.0))]
    pub max_height_m: f64,
    /// Fewest of a building's four sides that must have room for a drone in front of them. Default 2.
    #[schemars(range(min = 1, max = 4))]
    pub min_sides: u32,
    /// Longest flight, seconds; buildings that take longer are not chosen. Default 400.
    #[schemars(range(min = 10.0, max = 2000.0))]
    pub max_duration_s: f64,
}

/// Waypoints of patrols. Distance, pitch, altitudes and radii of `view` are set by these.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PatrolConfig {
    /// Places and times: `[x, y, z, t]` in the world frame, metres and seconds; the first at 0 s, times growing. A
    /// loop ends where it begins. Empty (the default): loops are drawn from the seed.
    pub waypoints: Vec<[f64; 4]>,
    /// Number of flights, when loops are drawn. Default 1.
    #[schemars(range(min = 1, max = 100_000))]
    pub count: u64,
    /// Waypoints of a drawn loop. Default 6.
    #[schemars(range(min = 3, max = 100))]
    pub corners: u32,
    /// Radius of a drawn loop, metres. Default 50.
    #[schemars(range(min = 5.0, max = 1000.0))]
    pub radius_m: f64,
    /// Lowest and highest waypoint of a drawn loop, metres above ground. Default 25 and 35.
    pub altitude_m: [f64; 2],
    /// Mean speed of a drawn loop, m/s. Default 5.
    #[schemars(range(min = 0.5, max = 20.0))]
    pub speed_mps: f64,
    /// Distance ahead of the drone of the point that the camera watches, metres over ground. Default 15.
    #[schemars(range(min = 2.0, max = 100.0))]
    pub lead_m: f64,
}

impl Default for InspectionConfig {
    fn default() -> Self {
        Self {
            count: 1,
            standoff_m: 12.0,
            row_m: 6.0,
            speed_mps: 2.0,
            min_height_m: 6.0,
            max_height_m: 40.0,
            min_sides: 2,
            max_duration_s: 400.0,
        }
    }
}

impl InspectionConfig {
    /// Parameters that no single flight depends on; not in its key.
    pub const NOT_IN_KEY: &[&str] = &["count"];
}

impl Default for PatrolConfig {
    fn default() -> Self {
        Self {
            waypoints: Vec::new(),
            count: 1,
            corners: 6,
            radius_m: 50.0,
            altitude_m: [25.0, 35.0],
            speed_mps: 5.0,
            lead_m: 15.0,
        }
    }
}

impl PatrolConfig {
    /// Parameters that no single flight depends on; not in its key.
    pub const NOT_IN_KEY: &[&str] = &["count"];
}

/// Frames are this far apart where nobody walks, seconds.
pub const DT_S: f64 = 0.5;
/// Some waypoint of a patrol is at least this far from the first one, metres.
pub const SHORTEST_REACH_M: f64 = 5.0;
/// Longest flight, seconds: what the planner plans at once, because places are met frame by frame.
pub const LONGEST_S: f64 = 2000.0;

impl ObjectiveConfig {
    /// Number of flights, where that is neither the number of walkers nor a parameter of a plugin.
    pub fn count(&self) -> Option<u64> {
        match self.objective {
            Objective::Track | Objective::Plugin => None,
            Objective::Inspect => Some(self.inspect.count),
            Objective::Patrol if self.patrol.waypoints.is_empty() => Some(self.patrol.count),
            Objective::Patrol => Some(1),
        }
    }

    /// Refuses contradictions: (path of the parameter, what is wrong). `speed_limit_mps` is the drone's.
    pub fn validate(&self, speed_limit_mps: f64) -> Result<(), (String, String)> {
        let refuse = |path: String, rule: String| Err((path, rule));
        let (i, p) = (&self.inspect, &self.patrol);
        for (path, value, low, high) in [
            ("inspect.standoff_m", i.standoff_m, 4.0, 60.0),
            ("inspect.row_m", i.row_m, 1.0, 30.0),
            ("inspect.speed_mps", i.speed_mps, 0.2, 10.0),
            ("inspect.min_height_m", i.min_height_m, 2.0, 200.0),
            ("inspect.max_height_m", i.max_height_m, 2.0, 400.0),
            ("inspect.min_sides", f64::from(i.min_sides), 1.0, 4.0),
            ("inspect.max_duration_s", i.max_duration_s, 10.0, LONGEST_S),
            ("patrol.corners", f64::from(p.corners), 3.0, 100.0),
            ("patrol.radius_m", p.radius_m, 5.0, 1000.0),
            ("patrol.speed_mps", p.speed_mps, 0.5, 20.0),
            ("patrol.lead_m", p.lead_m, 2.0, 100.0),
        ] {
            cosfly_planner::config::in_range(path, value, low, high)?;
        }
        if i.min_height_m > i.max_height_m {
            return refuse(
                "inspect.min_height_m".into(),
                format!(
                    "`inspect.min_height_m` is {}; it must not be above `inspect.max_height_m`, which is {}",
                    i.min_height_m, i.max_height_m
                ),
            );
        }
        for (path, speed) in [("inspect.speed_mps", i.speed_mps), ("patrol.speed_mps", p.speed_mps)] {
            let asked = path.starts_with("inspect") == (self.objective == Objective::Inspect);
            if !matches!(self.objective, Objective::Track | Objective::Plugin) && asked && speed > 0.8 * speed_limit_mps
            {
                let rule = format!(
                    "`{path}` is {speed}; it must be at most 0.8 of `limits.speed_mps`, which is {speed_limit_mps}"
                );
                return refuse(path.into(), rule);
            }
        }
        let [low, high] = p.altitude_m;
        if !(low >= 2.0 && low <= high && high <= 200.0) {
            let rule = format!("`patrol.altitude_m` is [{low}, {high}]; it must rise and lie between 2 and 200");
            return refuse("patrol.altitude_m".into(), rule);
        }
        self.validate_waypoints(speed_limit_mps)
    }

    fn validate_waypoints(&self, speed_limit_mps: f64) -> Result<(), (String, String)> {
        let waypoints = &self.patrol.waypoints;
        if waypoints.len() == 1 {
            let rule = "`patrol.waypoints` has a single waypoint; there must be none or at least 2".to_owned();
            return Err(("patrol.waypoints".into(), rule));
        }
        let places = || waypoints.iter().map(|[x, y, z, _]| cosfly_frames::DVec3::new(*x, *y, *z));
        if let Some(first) = places().next()
            && places().all(|place| place.distance(first) < SHORTEST_REACH_M)
        {
            let rule = format!(
                "`patrol.waypoints` are all at one place; one must be at least {SHORTEST_REACH_M} m from the first, since the camera looks where the flight goes"
            );
            return Err(("patrol.waypoints".into(), rule));
        }
        for (index, [x, y, z, t]) in waypoints.iter().copied().enumerate() {
            let path = format!("patrol.waypoints[{index}]");
            let refuse = |rule: String| Err((path.clone(), format!("`{path}` {rule}")));
            if ![x, y, z].iter().all(|value| value.abs() <= 1e5) || !(0.0..=LONGEST_S).contains(&t) {
                return refuse(format!("must have places within 100 km and a time between 0 and {LONGEST_S} s"));
            }
            let Some(before) = index.checked_sub(1).map(|before| waypoints[before]) else {
                if t != 0.0 {
                    return refuse(format!("is at {t} s; the first one must be at 0 s"));
                }
                continue;
            };
            let time = t - before[3];
            if time < DT_S {
                return refuse(format!("is {time} s after the one before; it must be at least {DT_S} s"));
            }
            let way = cosfly_frames::DVec3::new(x - before[0], y - before[1], z - before[2]).length();
            if way / time > speed_limit_mps {
                return refuse(format!(
                    "needs {:.1} m/s from the one before; `limits.speed_mps` is {speed_limit_mps}",
                    way / time
                ));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_refused(change: impl Fn(&mut ObjectiveConfig), path: &str) {
        let mut config = ObjectiveConfig { objective: Objective::Patrol, ..ObjectiveConfig::default() };
        change(&mut config);
        let (found, message) = config.validate(12.0).expect_err(path);
        assert_eq!(found, path, "{message}");
    }

    #[test]
    fn contradictions_name_their_parameter() {
        assert_eq!(ObjectiveConfig::default().validate(12.0), Ok(()));
        check_refused(|c| c.inspect.min_height_m = 50.0, "inspect.min_height_m");
        check_refused(|c| c.inspect.standoff_m = f64::NAN, "inspect.standoff_m");
        check_refused(|c| c.patrol.lead_m = 1.0, "patrol.lead_m");
        check_refused(|c| c.patrol.speed_mps = 11.0, "patrol.speed_mps");
        check_refused(|c| c.patrol.altitude_m = [30.0, f64::NAN], "patrol.altitude_m");
        check_refused(|c| c.patrol.waypoints = vec![[0.0; 4]], "patrol.waypoints");
        let late = |t: f64| move |c: &mut ObjectiveConfig| c.patrol.waypoints = vec![[0.0; 4], [60.0, 0.0, 0.0, t]];
        check_refused(late(0.0), "patrol.waypoints[1]");
        check_refused(late(4.0), "patrol.waypoints[1]");
        check_refused(late(f64::NAN), "patrol.waypoints[1]");
        check_refused(|c| c.patrol.waypoints = vec![[0.0, 0.0, 0.0, 1.0], [9.0; 4]], "patrol.waypoints[0]");
        check_refused(|c| c.patrol.waypoints = vec![[7.0, 8.0, 30.0, 0.0], [7.0, 8.0, 30.0, 9.0]], "patrol.waypoints");
    }
}
