//! Plan, schedule, execute, resume, explain.
//!
//! * [`plan`]: a recipe against a store: every task with its plan digest, the finished ones, and why the others will run.
//! * [`run`]: does what a plan leaves to do, on several threads; resuming is the same as running.
//! * [`deliver`]: a run, then the artifact of a stage as a folder.
//! * [`run_tasks`]: tasks by their plan digests, for another process or machine; the same code as in [`run`].
//! * [`why`]: the ingredient that changed a task's key.

mod change;
mod deliver;
mod document;
mod explain;
mod inputs;
mod intermediates;
mod leaf;
mod options;
mod plan;
mod planning;
mod processor_time;
mod publisher;
mod reason;
mod reasons;
mod run;
mod schedule;
mod single;
mod sources;
mod summary;
mod workers;

pub use change::{Change, definition_difference};
pub use deliver::{Delivery, deliver};
pub use explain::{Explanation, Link, why};
pub use options::RunOptions;
pub use plan::{Plan, PlannedStage, recipe_id};
pub use planning::{plan, plan_elsewhere, plan_for};
pub use processor_time::{processor_s, processor_s_of_children};
pub use reason::Reason;
pub use run::run;
pub use single::run_tasks;
pub use summary::{Failure, RejectionOrigin, RejectionReason, RunOutcome, RunSummary, StageSummary, TaskEnd};
