//! `cosfly task run`: one planned task, for another process or machine.

use super::{Outcome, Refusals, store_dir};
use crate::arguments::StoreArguments;
use crate::{exit, interrupt};
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_fingerprint::Digest;
use cosfly_stage::Work;
use cosfly_store::Store;

/// Runs the task whose plan document has the digest `digest`, unless it is finished.
pub fn run(digest: &str, store: &StoreArguments) -> Outcome {
    let plan: Digest = digest.parse().map_err(|_| -> Refusals {
        vec![
            Diagnostic::new("task-digest", Fault::Recipe, format!("`{digest}` is not a plan digest"))
                .hint("a plan digest has 64 hex digits"),
        ]
    })?;
    let one = |refusal| vec![refusal];
    let store = Store::open(&store_dir(store)).map_err(one)?;
    let outcome = cosfly_runner::run_task(&store, &cosfly_stages::registry(), &plan, interrupt::flag()).map_err(one)?;
    crate::print(match outcome {
        Work::Ran => "ran\n",
        Work::Cached | Work::Reused => "already done\n",
    })?;
    Ok(exit::SUCCESS)
}
