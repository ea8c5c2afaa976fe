//! `cosfly task run`: one planned task, for another process or machine.

use crate::arguments::StoreArguments;
use crate::command::{Command, Entry, Outcome, dispatch, with_commands};
use crate::console::Console;
use crate::exit;
use clap::Parser;
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_fingerprint::Digest;
use cosfly_stage::Work;
use cosfly_store::Store;

const COMMANDS: &[Entry] = &[Entry::of::<Arguments>()];

/// The group.
pub const TASK: Entry = Entry { command: group, run: |matches, console| dispatch(COMMANDS, matches, console) };

fn group() -> clap::Command {
    with_commands(clap::Command::new("task").about("Run one planned task (for schedulers)"), COMMANDS)
}

/// Run the task whose plan document has a digest, unless it is finished
#[derive(Debug, Parser)]
#[command(name = "run")]
struct Arguments {
    /// Digest of the plan document, 64 hex digits
    #[arg(value_name = "PLAN-DIGEST")]
    digest: String,
    #[command(flatten)]
    store: StoreArguments,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let plan: Digest = self.digest.parse().map_err(|_| {
            Diagnostic::new("task-digest", Fault::Recipe, format!("`{}` is not a plan digest", self.digest))
                .hint("a plan digest has 64 hex digits")
        })?;
        let store = Store::open(&self.store.folder())?;
        let work = cosfly_runner::run_task(&store, &cosfly_stages::registry(), &plan, console.cancelled())?;
        console.print(match work {
            Work::Ran => "ran\n",
            Work::Cached | Work::Reused => "already done\n",
        })?;
        Ok(exit::SUCCESS)
    }
}
