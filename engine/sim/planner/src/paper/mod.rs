//! The paper's own pipeline (`preset = "paper"`), as literally as it can be read: a baseline, not a guarantee.
//!
//! ```text
//! start      <- best viewpoint behind the walker every few frames, straight lines between,
//!               following within bounds, long hidden runs led aside           (start)
//! descent    <- all terms by differences of 0.5 m, adaptive rate, clipped     (differences, descent)
//! seven clean-ups, in the paper's order                                       (postprocess)
//!   1 straighten hidden runs (straighten)   2 remove detours (detours)   3 remove oscillation (oscillation)
//!   4 project out of obstacles (projection) 5 spread spikes of speed     6 low-pass the altitude (repair)
//!   7 check, and project what fails once more
//! ```
//!
//! Its four safety layers are the safety term and the steps 4, 5 and 6. They promise nothing: who calls this measures
//! the result. Where the paper is silent the choice and its effect stand in the book (The paper's ambiguities).

pub mod body_rays;
pub mod counts;
pub mod descent;
pub mod detours;
pub mod differences;
#[cfg(test)]
mod fixtures;
pub mod focus;
pub mod following;
pub mod hidden_runs;
pub mod near_boxes;
pub mod neighbourhood;
pub mod oscillation;
pub mod pipeline;
pub mod postprocess;
pub mod projection;
pub mod repair;
pub mod start;
pub mod straighten;
pub mod window;

pub use crate::config::paper::PaperConfig;
pub use counts::PaperCounts;
pub use descent::{Iteration, iteration};
pub use differences::Threads;
pub use focus::FocusedSurroundings;
pub use near_boxes::NearBoxes;
pub use pipeline::{PaperFlight, plan_paper, plan_paper_in};
