//! Measurements of `cosfly-lab`: planners, box queries of several libraries, the renderer.
//!
//! All times are thread CPU time, with contenders interleaved in one run, so that ratios do not depend on the load.

pub mod clock;
pub mod geometry;
pub mod geometry_contenders;
pub mod geometry_scenes;
pub mod look;
pub mod median;
pub mod people;
pub mod planner;
pub mod render;
pub mod simplify;
pub mod small;
pub mod vehicles;
