//! Toy stages, and the cost of the engine itself.
//!
//! * [`Toy`], [`toy_recipe`]: recipes of cheap stages, for the engine's laws and for measuring it.
//! * [`bench_engine`]: wall times of a six-stage recipe of them.

mod bench;
mod toy;

pub use bench::{EngineFigures, bench_engine};
pub use toy::{Hook, Toy, toy_recipe};
