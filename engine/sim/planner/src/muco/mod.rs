//! MuCO: global start, smoothing in a safe corridor, descent on nine terms, post-processing, final judgement.
//!
//! ```text
//! filter boxes near the path
//! repeat with growing effort:
//!   start   <- cheapest way through the lattice of viewpoints      (start, lattice, viterbi)
//!   safe    <- flyable path near it, inside its safe corridor       (smoother, corridor, banded)
//!   lower   <- descent from safe on the terms, seven clean-ups      (descent, gradient, postprocess)
//!   lower   <- flyable path near it, inside the corridor of safe
//!   publish the cheaper one whose certificate holds                 (certificate)
//! ```

pub mod banded;
pub mod corridor;
pub mod lattice;
pub mod plan;
pub mod refine;
pub mod scan;
pub mod search;
pub mod smoother;
pub mod track_check;
pub mod viterbi;

pub use plan::{plan, plan_with_terms};
