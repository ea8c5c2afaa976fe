//! The renderer: CPU time of a frame on one core by stage, throughput of finished logs, and comparison of both with the
//! limits of the machine's memory.
//!
//! [`measure`] runs all measurements; [`views`] holds the towns and the cameras, and exports them for other renderers.

pub mod flight;
pub mod flown;
pub mod machine;
mod measure;
mod options;
pub mod stages;
mod table;
pub mod throughput;
pub mod views;

pub use measure::{RenderReport, RenderRow, measure};
pub use options::RenderOptions;
