//! [`VehicleError`]: broken rules and towns without lanes.

use std::fmt;

/// A rule of the config that is broken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VehicleConfigRule {
    /// Keys from the config's table to the value.
    pub path: &'static [&'static str],
    /// The value and the rule.
    pub message: String,
}

/// Reason why a town has no place for vehicles, or why a config cannot be used.
#[derive(Clone, Debug, PartialEq)]
pub enum VehicleError {
    /// A config rule is broken.
    Config(VehicleConfigRule),
    /// The town has no lanes.
    NoLanes {
        /// Name of the town.
        town: String,
    },
    /// No lane has room for any of the vehicles.
    NoRoom {
        /// Number of lanes.
        lanes: usize,
        /// Number of vehicles that were asked for.
        asked: u32,
    },
}

impl VehicleError {
    /// Advice for the user.
    pub fn hint(&self) -> &'static str {
        match self {
            Self::Config(_) => "change the value in the recipe",
            Self::NoLanes { .. } => "lanes come from OpenDRIVE, generated towns and OpenStreetMap; or set `count = 0`",
            Self::NoRoom { .. } => "give a larger `area_m`, or allow smaller vehicles in `mix`",
        }
    }
}

impl fmt::Display for VehicleError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Config(rule) => write!(out, "{}", rule.message),
            Self::NoLanes { town } => write!(out, "the town `{town}` has no lanes for vehicles"),
            Self::NoRoom { lanes, asked } => {
                write!(out, "none of {asked} vehicles has room on the {lanes} lanes of the town")
            }
        }
    }
}

impl std::error::Error for VehicleError {}
