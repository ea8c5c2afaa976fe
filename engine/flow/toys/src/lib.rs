//! Toy stages, and the overhead of the engine.
//!
//! * [`Toy`], [`toy_recipe`]: recipes of cheap stages, for tests and measurements of the engine.
//! * [`bench_engine`]: wall times of a six-stage recipe of them; [`bench_cluster`]: the same on HyperQueue.
//! * [`simulate`]: a million trajectories on a thousand workers.

mod bench;
mod cluster;
mod fleet;
mod toy;
mod toy_kind;

pub use bench::{EngineFigures, bench_engine};
pub use cluster::{ClusterFigures, bench_cluster, run_toys};
pub use fleet::{Fleet, FleetFigures, STAGES, simulate};
pub use toy::{Hook, PACK, Toy, toy_recipe};
pub use toy_kind::ToyKind;
