//! Metrics of predictions, and baselines.
//!
//! All functions are pure arithmetic on poses and pixels. Definitions that the paper leaves open are stated in their
//! docs and in the book's page "Metrics". An outside script compares every number with independent software
//! (`tests/outside/check_metrics.py`).
//!
//! * [`deltas`]: waypoints from predicted increments.
//! * [`waypoint`]: errors of waypoints; [`scores`]: their reported means.
//! * [`boxes`], [`depth`], [`segmentation`], [`detection`]: metrics of pictures.
//! * [`drawn_ground`]: the ground in a picture around somebody's feet.
//! * [`single_target`], [`tracking`]: metrics of trackers, of one target and of many bodies.
//! * [`bootstrap`]: intervals by resampling whole trajectories.
//! * [`shortcuts`]: signs that give the target away.
//! * [`spread`]: towns that fall apart.
//! * [`baselines`]: predictions that a model must beat.

pub mod baselines;
pub mod bootstrap;
pub mod boxes;
pub mod deltas;
pub mod depth;
pub mod detection;
pub mod drawn_ground;
pub mod scanned_mesh;
pub mod scores;
pub mod segmentation;
pub mod shortcuts;
pub mod single_target;
pub mod spread;
pub mod tracking;
pub mod waypoint;

pub use deltas::{DeltaFrame, DeltaOrigin, waypoints};
pub use scores::{METRICS, Metric, Tally};
pub use waypoint::{LastingErrors, WaypointErrors, errors};
