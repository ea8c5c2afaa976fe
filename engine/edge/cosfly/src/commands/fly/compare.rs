//! `cosfly fly compare`: two results of `cosfly fly` over the same episodes.

use crate::command::Outcome;
use crate::console::Console;
use crate::exit;
use clap::Args;
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_fly::compare::{compare, json, told};
use cosfly_fly::results::Folder;
use std::path::PathBuf;

/// Compare two results over the same episodes: differences with 95 % intervals (paired bootstrap)
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  cosfly fly compare out/fly/street/follow out/fly/street/mine")]
pub struct Arguments {
    /// Folder of the first result
    #[arg(value_name = "FIRST")]
    first: PathBuf,
    /// Folder of the second result
    #[arg(value_name = "SECOND")]
    second: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Arguments {
    /// Does the work.
    pub fn run(&self, console: &dyn Console) -> Outcome {
        let (first, first_rows) = Folder::read(&self.first)?;
        let (second, second_rows) = Folder::read(&self.second)?;
        if let Some(difference) = first.incomparable(&second) {
            let message =
                format!("`{}` and `{}` cannot be compared: {difference}", self.first.display(), self.second.display());
            return Err(Diagnostic::new("fly-compare", Fault::Input, message)
                .hint("fly both policies on the same suite with the same settings; latencies may differ")
                .into());
        }
        let differences = compare(&first_rows, &second_rows)?;
        let names = [first.policy.name.as_str(), second.policy.name.as_str()];
        console.print(&if self.json { json(names, &differences) } else { told(names, &differences) })?;
        Ok(exit::SUCCESS)
    }
}
