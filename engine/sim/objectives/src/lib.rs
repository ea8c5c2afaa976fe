//! Objectives: what a flight is for, turned into a moving point to be watched and wishes; the planner flies it as it is.
//!
//! * [`track`]: a walker is followed; the point to be watched is the walker.
//! * [`inspect`]: the facades of a building are covered from a stand-off distance.
//! * [`patrol`]: timed waypoints are met, one after the other.
//! * [`reference`]: something from outside says what to look at and where to be (a plugin).
//!
//! An objective makes a [`Mission`]; [`Mission::request`] is what the planner is asked. Adding one: a file here with a
//! function that makes a mission, and its name in [`Objective`].

pub mod config;
pub mod facade;
pub mod inspect;
pub mod meeting;
mod mission;
pub mod patrol;
pub mod reference;
pub mod track;

pub use config::{InspectionConfig, Objective, ObjectiveConfig, PatrolConfig};
pub use mission::{Mission, POINT_HEIGHT_M, Site};
