//! The kit for plugins of cosfly: one trait, one macro.
//!
//! * [`CostTerm`] and [`cost_term!`]: a cost term of the planner.
//! * [`Objective`] and [`objective!`]: what to look at, from where, when.
//! * [`Stage`] and [`stage!`]: judges, labels, annotates or exports finished flights.
//! * [`params!`]: parameters with documentation, defaults and ranges; the schema that recipes are checked against comes from it.
//! * [`town`]: rays, distances, ground and buildings, in batches. [`log`]: messages. [`Random`]: chance from the given seed.
//! * [`libm`]: the mathematics library; the same bits on every machine.
//!
//! Everything compiles natively, too, so that `cargo test` runs without WebAssembly; there the town is empty.
//!
//! ```
//! use cosfly_plugin::{CostTerm, Metadata, Point, Run, Shape, params};
//!
//! params! {
//!     /// How high is too high.
//!     pub struct Params {
//!         /// Altitude above the target that costs nothing, metres.
//!         free_m: f64 = 30.0, [0.0, 400.0];
//!     }
//! }
//!
//! struct Low { params: Params, feet: Vec<Point> }
//!
//! impl CostTerm for Low {
//!     type Params = Params;
//!     fn describe() -> Metadata {
//!         Metadata { name: "low", version: "0.1.0", summary: "Keeps the drone low." }
//!     }
//!     fn new(params: Params) -> Result<Self, String> {
//!         Ok(Self { params, feet: vec![] })
//!     }
//!     fn begin(&mut self, run: Run) -> Result<(), String> {
//!         self.feet = run.targets;
//!         Ok(())
//!     }
//!     fn evaluate(&self, waypoints: &[Point], costs: &mut [f64], _: Option<&mut [Point]>) -> Result<(), String> {
//!         for ((waypoint, feet), cost) in waypoints.iter().zip(&self.feet).zip(costs) {
//!             let above = (waypoint[2] - feet[2] - self.params.free_m).max(0.0);
//!             *cost = above * above;
//!         }
//!         Ok(())
//!     }
//! }
//!
//! cosfly_plugin::cost_term!(Low);
//! # fn main() {}
//! ```

#[doc(hidden)]
pub mod abi;
mod arrow_stream;
mod cost_term;
mod flatbuffers;
mod flight;
mod geometry;
mod json;
pub mod log;
mod objective;
mod params;
mod random;
#[cfg(any(test, target_family = "wasm"))]
mod recent_blocks;
mod running;
mod stage;
pub mod town;

pub use cost_term::{CostTerm, Run, Shape, per_waypoint};
pub use flight::Flight;
pub use geometry::{Point, add, cross_2d, distance, dot, length, scale, sub};
pub use json::Json;
pub use libm;
pub use objective::{Objective, Plan, Site};
pub use params::{NoParams, Param, Params};
#[doc(hidden)]
pub use params::{quoted as __private_quoted, sentence as __private_sentence};
pub use random::Random;
pub use stage::{Answer, Column, File, Gives, Kind, Stage, Value, reals};

#[cfg(target_family = "wasm")]
#[global_allocator]
static ALLOCATOR: recent_blocks::RecentBlocks = recent_blocks::RecentBlocks::new();

/// The description of a plugin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Metadata {
    /// Name in tables and messages: `a-z`, `0-9`, `_`.
    pub name: &'static str,
    /// The version of the plugin.
    pub version: &'static str,
    /// The purpose, one sentence.
    pub summary: &'static str,
}

/// For the macros; no part of the interface for authors.
#[doc(hidden)]
pub mod macros {
    pub use crate::abi;
    pub use crate::cost_term::RunningTerm;
    pub use crate::running::{Running, description};
    pub use std::cell::RefCell;
    pub use std::thread_local;
}
