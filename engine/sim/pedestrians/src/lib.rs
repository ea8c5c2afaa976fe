//! People on foot: walkable grid, A* routes, smoothing, variable speed, stops; crowds; recorded and scripted people.
//!
//! [`WalkableGrid::build`] once per town. [`walk`] once per person who walks alone: a pure function of the grid, the config and
//! the seed. [`Crowd`], [`Recording::placed`] and [`scripted()`] make populations of a moving world.

mod area_picture;
pub mod areas;
pub mod config;
pub mod crowd;
pub mod error;
mod goal;
pub mod grid;
pub mod ground;
pub mod kinds;
mod motion;
mod obstruction;
pub mod path;
mod polygon;
pub mod recorded;
mod route;
pub mod scripted;
mod smooth;
pub mod walk;

pub use area_picture::AreaPicture;
pub use areas::{AreaConfig, AreaMap};
pub use config::{HeightRange, PedestrianConfig, RadiusRange, SpeedConfig, StopConfig};
pub use crowd::{Crowd, CrowdConfig};
pub use error::{PedestrianConfigRule, PedestrianError};
pub use grid::WalkableGrid;
pub use ground::Ground;
pub use kinds::KindShares;
pub use path::{PedestrianPath, path_of};
pub use recorded::{RecordedConfig, RecordedError, Recording};
pub use scripted::{ScriptedPerson, Waypoint, scripted};
pub use walk::walk;
