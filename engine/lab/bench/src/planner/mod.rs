//! Planners compared on the same paths, in one run.
//!
//! [`outcomes()`] plans every path of every scene with every [`Contender`], one path after the other, and evaluates all
//! flights against the unsimplified map ([`figures`]); [`tabulate`] summarises them in rows, and [`front`] sets visibility
//! against learnability.

pub mod contacts;
pub mod contender;
pub mod figures;
pub mod front;
pub mod many;
pub mod outcomes;
pub mod phases;
pub mod plain_bvh;
pub mod scene;
pub mod solver;
pub mod table;

pub use contender::Contender;
pub use front::{Front, front};
pub use outcomes::{PathOutcome, PlannerOptions, outcomes};
pub use table::{PlannerTable, Row, tabulate};
