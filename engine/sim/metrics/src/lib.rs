//! Windows that models are trained and judged on, the metrics of their predictions, and baselines to beat.
//!
//! Everything is pure arithmetic on poses and pixels; the definitions that the paper leaves open are stated where
//! they are made, and in the book's page "Metrics". An outside script compares every number with other people's
//! software (`tests/outside/check_metrics.py`).
//!
//! * [`windows`]: where the windows of a flight start.
//! * [`deltas`]: from a model's increments to waypoints.
//! * [`waypoint`]: errors of waypoints; [`scores`]: the means of them that are reported.
//! * [`boxes`], [`depth`], [`segmentation`], [`detection`], [`run_lengths`]: metrics of pictures.
//! * [`bootstrap`]: intervals by resampling whole trajectories.
//! * [`difficulty`]: which windows are easy, medium and hard.
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
pub mod waypoint;
pub mod windows;

pub use deltas::{DeltaFrame, DeltaOrigin, waypoints};
pub use difficulty::{Difficulty, WindowFeatures};
pub use scores::{METRICS, Metric, Tally};
pub use waypoint::{WaypointErrors, errors};
pub use windows::WindowShape;
