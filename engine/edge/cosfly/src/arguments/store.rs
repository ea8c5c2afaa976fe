//! Where the store is, what is freed there, single tasks.

use clap::{Args, Subcommand};
use std::path::PathBuf;

/// Where the store is.
#[derive(Args, Clone, Debug)]
pub struct StoreArguments {
    /// Folder of the store [default: $COSFLY_STORE, else .cosfly in the current folder]
    #[arg(long, value_name = "DIR", env = "COSFLY_STORE", hide_env = true)]
    pub store: Option<PathBuf>,
}

/// Arguments of `gc`.
#[derive(Args, Debug)]
pub struct GcArguments {
    #[command(flatten)]
    pub store: StoreArguments,
    /// Really delete; without it the sizes are only shown
    #[arg(long)]
    pub delete: bool,
    /// Runs per recipe whose results stay
    #[arg(long, value_name = "N", default_value_t = 3)]
    pub keep_runs: usize,
    /// Nothing younger than this goes
    #[arg(long, value_name = "DAYS", default_value_t = 7)]
    pub keep_days: u64,
}

/// Single tasks.
#[derive(Debug, Subcommand)]
pub enum TaskCommand {
    /// Run the task whose plan document has this digest, if it is not done yet
    Run {
        /// Digest of the plan document, 64 hex digits
        #[arg(value_name = "PLAN-DIGEST")]
        digest: String,
        #[command(flatten)]
        store: StoreArguments,
    },
}
