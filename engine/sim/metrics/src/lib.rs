//! Windows for training and evaluation, metrics of predictions, and baselines.
//!
//! All functions are pure arithmetic on poses and pixels. Definitions that the paper leaves open are stated in their
//! docs and in the book's page "Metrics". An outside script compares every number with independent software
//! (`tests/outside/check_metrics.py`).
//!
//! * [`windows`]: starts of the windows of a flight.
//! * [`deltas`]: waypoints from predicted increments.
//! * [`waypoint`]: errors of waypoints; [`scores`]: their reported means.
//! * [`boxes`], [`depth`], [`segmentation`], [`detection`], [`run_lengths`]: metrics of pictures.
//! * [`bootstrap`]: intervals by resampling whole trajectories.
//! * [`difficulty`]: easy, medium and hard windows.
//! * [`shortcuts`]: signs that give the target away.
//! * [`spread`]: towns that fall apart.
//! * [`baselines`]: predictions that a model must beat.

pub mod baselines;
pub mod bootstrap;
pub mod boxes;
pub mod deltas;
pub mod depth;
pub mod detection;
pub mod difficulty;
pub mod run_lengths;
pub mod scores;
pub mod segmentation;
pub mod shortcuts;
pub mod spread;
pub mod waypoint;
pub mod windows;

pub use deltas::{DeltaFrame, DeltaOrigin, waypoints};
pub use difficulty::{Difficulty, WindowFeatures};
pub use scores::{METRICS, Metric, Tally};
pub use waypoint::{WaypointErrors, errors};
pub use windows::WindowShape;
