//! Planners to be measured against: the paper's 4-D A*, the same made flyable, a beam search, the lattice alone.
//!
//! All take what the planner itself takes and give a path; the certificate judges them like any other flight.
//!
//! * [`astar`]: voxels of 2 m x timesteps, visibility and the static terms as costs, safety as a hard
//!   constraint.
//! * [`flyable`]: the A* path smoothed to the limits by the same programme in the same corridor as ours.
//! * [`beam`]: one layer at a time with a bounded number of survivors.
//! * [`lattice_path`]: the path of the polar lattice with nothing after it.

pub mod astar;
pub mod baseline;
pub mod beam;
pub mod clearance_cache;
pub mod flyable;
pub mod grid;
pub mod input;
pub mod lattice_path;
pub mod moving_layers;
pub mod near_track;
pub mod plan;
pub mod queue;
pub mod sight;

pub use baseline::Baseline;
pub use input::{BaselineInput, BaselinePath};
pub use plan::{plan_astar, plan_baseline, plan_baseline_with};

#[cfg(test)]
mod law;
