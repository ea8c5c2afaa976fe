//! MuCO: global start on a lattice, Gauss-Newton refinement, smoothing in a safe corridor, final judgement.
//!
//! ```text
//! filter boxes near the path
//! repeat with growing effort                                        (attempts)
//!   start   <- cheapest way through the lattice of viewpoints       (search, lattice, scan, pricing, start_sector, viterbi, losses)
//!   refined <- Gauss-Newton steps on all terms from there           (refine)
//!   flight  <- flyable path near it, inside its safe corridor       (smoother, corridor, turning, banded)
//! until its certificate holds and it sees what the lattice promises (judge)
//! ```

pub mod attempts;
pub mod banded;
pub mod corridor;
pub mod judge;
pub mod lattice;
pub(crate) mod lead_in;
pub mod losses;
pub mod node_state;
mod pricing;
pub mod refine;
pub mod scan;
pub mod search;
pub mod smoother;
mod start_sector;
mod turning;
pub mod viterbi;
