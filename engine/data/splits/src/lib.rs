//! Splits that do not leak: which flights must stay together, where they go, and a linter of what was published.
//!
//! * [`route`]: how much of one walk another one repeats.
//! * [`facts`]: what the linter needs of a flight.
//! * [`assign`]: groups of flights, their splits, nested subsets.
//! * [`leaks`]: the linter.
//! * [`promise`]: the file `splits.json`, which says what the splits of a dataset keep.

pub mod assign;
pub mod facts;
pub mod leaks;
pub mod promise;
pub mod route;

pub use assign::{Assignment, assign};
pub use facts::{FlightFacts, facts_of_dataset};
pub use leaks::{Leak, Leaks, LintRules, lint, refusal};
pub use promise::promise;
