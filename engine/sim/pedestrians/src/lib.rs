//! Simulated pedestrians: walkable grid, A* routes, smoothing, variable speed, stops.

pub mod path;

pub use path::PedestrianPath;
