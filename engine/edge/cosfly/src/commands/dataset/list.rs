//! `cosfly dataset list`: the named versions of a store.

use super::version_line::line;
use crate::arguments::StoreArguments;
use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use clap::Parser;
use cosfly_diagnose::Result;
use cosfly_versions::shelf;

/// List the named versions
#[derive(Debug, Parser)]
#[command(name = "list")]
pub struct Arguments {
    #[command(flatten)]
    store: StoreArguments,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let lines = shelf::all(&self.store.with_versions()?)?.map(|version| version.map(|version| line(&version)));
        let text: String = lines.collect::<Result<_>>()?;
        console.print(if text.is_empty() {
            "no version has a name yet: `cosfly dataset tag NAME RECIPE`\n"
        } else {
            &text
        })?;
        Ok(exit::SUCCESS)
    }
}
