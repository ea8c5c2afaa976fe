//! Simulated pedestrians: walkable grid, A* routes, smoothing, variable speed, stops.
//!
//! [`WalkableGrid::build`] once per town, [`walk`] once per pedestrian. A walk is a pure function of
//! the grid, the config and its seed.

pub mod config;
pub mod crowd;
pub mod error;
mod goal;
pub mod grid;
pub mod ground;
mod motion;
mod obstruction;
pub mod path;
mod polygon;
mod route;
mod smooth;
pub mod walk;

pub use config::{HeightRange, PedestrianConfig, RadiusRange, SpeedConfig, StopConfig};
pub use crowd::{Crowd, CrowdConfig};
pub use error::{ConfigRule, PedestrianError};
pub use grid::WalkableGrid;
pub use ground::Ground;
pub use path::{PedestrianPath, path_of};
pub use walk::walk;
