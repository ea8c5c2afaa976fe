//! Toy stages, and the overhead of the engine.
//!
//! * [`Toy`], [`toy_recipe`]: recipes of cheap stages, for tests and measurements of the engine.
//! * [`bench_engine`]: wall times of a six-stage recipe of them.

mod bench;
mod toy;

pub use bench::{EngineFigures, bench_engine};
pub use toy::{Hook, PACK, Toy, toy_recipe};
