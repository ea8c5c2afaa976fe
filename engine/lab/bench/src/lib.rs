//! Measurements behind `cosfly-lab`: planners against each other, box queries against other libraries, the renderer.
//!
//! Everything is timed in thread CPU time, contenders interleaved in one run, so that ratios survive a busy machine.

pub mod clock;
pub mod geometry;
pub mod geometry_contenders;
pub mod geometry_scenes;
pub mod planner;
pub mod render;
