//! Plan, schedule, execute, resume, explain.
//!
//! * [`plan`]: a recipe against a store: every task with its plan digest, what is finished, what will run and why.
//! * [`run`]: does what a plan leaves to do, on several threads; resuming is the same as running.
//! * [`run_task`]: one task by its plan digest, for another process or machine; the same leaf as in [`run`].
//! * [`why`]: the ingredient that changed a task's key.
//! * [`deliver`]: a run, then the artifact of a stage as a folder.
//! * [`bench_engine`]: what the engine itself costs.

mod bench;
mod deliver;
mod document;
mod explain;
#[cfg(test)]
mod laws;
mod leaf;
mod plan;
mod publisher;
mod reasons;
mod run;
mod schedule;
mod single;
mod sources;
mod summary;
mod toy;

pub use bench::{EngineFigures, bench_engine};
pub use deliver::{Delivery, deliver};
pub use explain::{Change, Explanation, Link, definition_difference, why};
pub use plan::{Plan, PlannedStage, plan, recipe_id};
pub use reasons::Reason;
pub use run::{RunOptions, run, run_plan};
pub use single::run_task;
pub use summary::{Failure, RunOutcome, RunSummary, StageSummary};
