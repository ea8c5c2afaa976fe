//! The tasks of a recipe on other machines, through other engines. The store alone tells what is finished; an engine only
//! starts commands.
//!
//! * [`leaves`]: the unfinished tasks of a plan as commands (`cosfly task run ...`) with dependencies.
//! * [`Request`]: processors, memory, time of a task; never part of a key.
//! * [`json_lines`]: the commands for any engine.
//! * [`job_file`], [`Hq`], [`Driver`]: HyperQueue.
//! * [`slurm_script`]: HyperQueue within one allocation of Slurm; [`shell_word`]: a word of a command line.

mod chains;
mod driver;
mod emit;
mod hq;
mod job_file;
mod leaves;
mod request;
mod slurm;
mod told;

pub use driver::{ClusterOutcome, Driver};
pub use emit::json_lines;
pub use hq::{Hq, Job};
pub use job_file::job_file;
pub use leaves::{Command, Leaf, kept_stages, leaves};
pub use request::{Request, RequestChange, requests_of};
pub use slurm::{Allocation, shell_word, slurm_script};
