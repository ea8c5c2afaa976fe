//! Kinds of perturbation, one file each.
//!
//! To add one, write its file and add two lines here: its `mod` and its entry in [`KINDS`].

mod aim;
mod displacement;
mod drift;
mod gusts;
mod jumps;
pub(super) mod kind;
mod search;
mod timing;

pub use kind::{Departing, Departure, Kind};

/// All kinds. The order decides which kind a flight draws: new ones stand at the end.
#[rustfmt::skip] // an entry per line
pub const KINDS: &[Kind] = &[
    jumps::KIND,
    drift::KIND,
    gusts::KIND,
    timing::KIND,
    aim::KIND,
    search::KIND,
];
