//! Splits without leaks: groups of flights, their splits, and a linter for published datasets.
//!
//! * [`route`]: ground that a walk covers; [`overlap`]: walks that repeat each other.
//! * [`places`]: towns by their ground plans.
//! * [`facts`]: input of the linter for each flight.
//! * [`assign`]: groups of flights, their splits, nested subsets.
//! * [`area`]: cuts of the map; [`balance`]: shares asked for and reached.
//! * [`leaks`]: the linter.
//! * [`policy`]: the file `splits.json`, the split policy of a dataset.

pub mod area;
pub mod assign;
pub mod balance;
pub mod facts;
pub mod leaks;
pub mod overlap;
pub mod places;
pub mod policy;
pub mod route;

pub use assign::{Assignment, assign};
pub use balance::Balance;
pub use facts::{FlightFacts, facts_of_dataset};
pub use leaks::{Leak, Leaks, LintRules, lint, refusal, ways_back};
pub use policy::split_policy;
