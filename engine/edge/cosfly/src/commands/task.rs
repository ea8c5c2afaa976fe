//! `cosfly task run`: planned tasks, for another process or machine.

use crate::arguments::StoreArguments;
use crate::command::{Command, Entry, Outcome, Refusals, dispatch, with_commands};
use crate::console::Console;
use crate::exit;
use clap::Parser;
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_fingerprint::Digest;
use cosfly_runner::{RunOptions, run_tasks};
use cosfly_stage::Work;

const COMMANDS: &[Entry] = &[Entry::of::<Arguments>()];

/// The group.
pub const TASK: Entry = Entry { command: group, run: |matches, console| dispatch(COMMANDS, matches, console) };

fn group() -> clap::Command {
    with_commands(clap::Command::new("task").about("Run planned tasks (for schedulers)"), COMMANDS)
}

/// Run the tasks whose plan documents have the digests, unless they are finished
#[derive(Debug, Parser)]
#[command(
    name = "run",
    after_help = "\
Examples:
  cosfly run recipe.toml --on emit --store /shared/store > commands.jsonl
  cosfly task run --store /shared/store --jobs 4 <plan digest> <plan digest>"
)]
struct Arguments {
    /// Digests of plan documents, 64 hex digits each; tasks that others read come first
    #[arg(value_name = "PLAN-DIGEST")]
    digests: Vec<String>,
    #[command(flatten)]
    store: StoreArguments,
    /// Threads of a task
    #[arg(long, short, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: u16,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let digest = |text: &String| -> cosfly_diagnose::Result<Digest> {
            text.parse().map_err(|_| {
                Diagnostic::new("task-digest", Fault::Recipe, format!("`{text}` is not a plan digest"))
                    .hint("a plan digest has 64 hex digits")
            })
        };
        let plans: Vec<Digest> = self.digests.iter().map(digest).collect::<Result<_, _>>()?;
        // A list without tasks stands between the leaves of two stages.
        if plans.is_empty() {
            return Ok(exit::SUCCESS);
        }
        let store = self.store.open_as_worker()?;
        let options =
            RunOptions { jobs: usize::from(self.jobs), cancelled: console.cancelled(), ..RunOptions::default() };
        let mut failures = Vec::new();
        let _deadline = console.deadline(None);
        for end in run_tasks(&store, &cosfly_stages::registry(), &plans, &options)? {
            match end {
                Ok(Work::Ran) => console.print("ran\n")?,
                Ok(Work::Cached | Work::Reused) => console.print("already done\n")?,
                Err(failure) => {
                    failures.push(failure);
                    true
                }
            };
        }
        if failures.is_empty() { Ok(exit::SUCCESS) } else { Err(Refusals(failures)) }
    }
}
