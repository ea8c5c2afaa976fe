//! Splits without leaks: groups of flights, their splits, and a linter for published datasets.
//!
//! * [`route`]: overlap of two walks.
//! * [`facts`]: input of the linter for each flight.
//! * [`assign`]: groups of flights, their splits, nested subsets.
//! * [`leaks`]: the linter.
//! * [`policy`]: the file `splits.json`, the split policy of a dataset.

pub mod assign;
pub mod facts;
pub mod leaks;
pub mod policy;
pub mod route;

pub use assign::{Assignment, assign};
pub use facts::{FlightFacts, facts_of_dataset};
pub use leaks::{Leak, Leaks, LintRules, lint, refusal};
pub use policy::split_policy;
