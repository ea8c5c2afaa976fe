//! Parameters of the `perturb` stage, their defaults and ranges.

use super::mixture::Mixture;
use super::sizes::{FlyableConfig, JumpSizes, OffsetRange};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Departure of a twin from its expert. The defaults are the paper's; `mixture` adds kinds that a drone could fly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PerturbConfig {
    /// Shares of the kinds of perturbation. Default `{ jumps = 1 }`, the paper's.
    pub mixture: Mixture,
    /// Sizes and limits of the kinds that a drone could fly: all but `jumps`.
    pub flyable: FlyableConfig,
    /// Kind `jumps`: probability per frame that drone and aim are displaced. Default 0.6.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub position_probability: f64,
    /// Kind `jumps`: probability per frame that the view is turned, independent of the other. Default 0.6.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub rotation_probability: f64,
    /// Kind `jumps`: length of the drone's displacement, in any direction.
    pub drone_offset: OffsetRange,
    /// Kind `jumps`: length of the displacement of the point aimed at, in any horizontal direction.
    pub aim_offset: OffsetRange,
    /// Kind `jumps`: largest turn of the view, pitch and yaw together, degrees. Default 5.
    #[schemars(range(min = 0.0, max = 90.0))]
    pub max_rotation_deg: f64,
    /// Distance from obstacles that displaced drones keep along the whole swept path, metres. Default 1.
    #[schemars(range(min = 0.05, max = 10.0))]
    pub clearance_m: f64,
    /// Height above the target's feet that displaced drones keep, metres. Default 3.
    #[schemars(range(min = 0.5, max = 100.0))]
    pub min_height_m: f64,
}

impl Default for PerturbConfig {
    fn default() -> Self {
        Self {
            mixture: Mixture::default(),
            flyable: FlyableConfig::default(),
            position_probability: 0.6,
            rotation_probability: 0.6,
            drone_offset: OffsetRange::default(),
            aim_offset: OffsetRange::default(),
            max_rotation_deg: 5.0,
            clearance_m: 1.0,
            min_height_m: 3.0,
        }
    }
}

impl PerturbConfig {
    /// Sizes of kind `jumps`.
    pub(super) fn jumps(&self) -> JumpSizes<'_> {
        JumpSizes {
            position_probability: self.position_probability,
            rotation_probability: self.rotation_probability,
            drone_offset: &self.drone_offset,
            aim_offset: &self.aim_offset,
            max_rotation_deg: self.max_rotation_deg,
            clearance_m: self.clearance_m,
            min_height_m: self.min_height_m,
        }
    }

    /// Refuses values out of range and reversed ranges: (path of the parameter, what is wrong).
    pub fn validate(&self) -> Result<(), (String, String)> {
        let own = [
            ("position_probability", self.position_probability, 0.0, 1.0),
            ("rotation_probability", self.rotation_probability, 0.0, 1.0),
            ("drone_offset.min_m", self.drone_offset.min_m, 0.0, 50.0),
            ("drone_offset.max_m", self.drone_offset.max_m, 0.0, 50.0),
            ("aim_offset.min_m", self.aim_offset.min_m, 0.0, 50.0),
            ("aim_offset.max_m", self.aim_offset.max_m, 0.0, 50.0),
            ("max_rotation_deg", self.max_rotation_deg, 0.0, 90.0),
            ("clearance_m", self.clearance_m, 0.05, 10.0),
            ("min_height_m", self.min_height_m, 0.5, 100.0),
        ];
        let shares: Vec<(String, f64)> =
            self.mixture.shares().map(|(kind, share)| (format!("mixture.{}", kind.name), share)).collect();
        let shares = shares.iter().map(|(path, share)| (path.as_str(), *share, 0.0, 1000.0));
        for (path, value, low, high) in own.into_iter().chain(self.flyable.ranges()).chain(shares) {
            if !(low..=high).contains(&value) {
                return Err((path.to_owned(), format!("`{path}` is {value}; it must be between {low} and {high}")));
            }
        }
        if self.mixture.shares().map(|(_, share)| share).sum::<f64>() <= 0.0 {
            return Err(("mixture".to_owned(), "all shares of `mixture` are 0; one must be above 0".to_owned()));
        }
        for (name, range) in [("drone_offset", &self.drone_offset), ("aim_offset", &self.aim_offset)] {
            if range.min_m > range.max_m {
                let rule = format!(
                    "`{name}.min_m` is {}; it must not be above `{name}.max_m`, which is {}",
                    range.min_m, range.max_m
                );
                return Err((format!("{name}.min_m"), rule));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reversed_range_names_its_parameter() {
        let mut config = PerturbConfig::default();
        assert_eq!(config.validate(), Ok(()));
        config.aim_offset.min_m = 4.0;
        let (path, rule) = config.validate().unwrap_err();
        assert_eq!(path, "aim_offset.min_m");
        assert_eq!(rule, "`aim_offset.min_m` is 4; it must not be above `aim_offset.max_m`, which is 3");
        config.aim_offset.min_m = 2.0;
        config.mixture = Mixture::of(&[]);
        assert_eq!(config.validate().unwrap_err().0, "mixture");
        config.mixture = Mixture::of(&[("gusts", -1.0)]);
        assert_eq!(config.validate().unwrap_err().0, "mixture.gusts");
        config.mixture = Mixture::of(&[("gusts", 1.0)]);
        config.flyable.search_s = 0.0;
        assert_eq!(config.validate().unwrap_err().0, "flyable.search_s");
        config.clearance_m = f64::NAN;
        assert_eq!(config.validate().unwrap_err().0, "clearance_m");
    }
}
