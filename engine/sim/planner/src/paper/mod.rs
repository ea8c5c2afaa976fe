//! The paper's own pipeline (`preset = "paper"`), as literally as it can be read.

pub mod descent;
pub mod postprocess;
pub mod projection;
pub mod repair;
