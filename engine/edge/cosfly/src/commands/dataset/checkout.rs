//! `cosfly dataset checkout`: a named version as a folder.

use crate::arguments::StoreArguments;
use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use crate::text::{bytes, count};
use clap::Parser;
use cosfly_store::{check_out_folder, materialise};
use cosfly_versions::shelf;
use std::path::PathBuf;

/// Write a named version into a folder, byte by byte as it was
#[derive(Debug, Parser)]
#[command(name = "checkout", after_help = "Example:\n  cosfly dataset checkout v1.0.0 --out out/v1")]
pub struct Arguments {
    /// Name of the version
    #[arg(value_name = "NAME")]
    name: String,
    /// Folder for the dataset
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    store: StoreArguments,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let root = self.store.with_versions()?;
        let version = shelf::get(&root, &self.name)?;
        check_out_folder(&root, &self.out)?;
        let folder = materialise(&self.store.open()?, &version.files, &self.out)?;
        let state = if folder.changed { "" } else { " (unchanged)" };
        let (files, size) = (count(folder.files, "file"), bytes(folder.bytes));
        console.print(&format!("{} in {files} of {size}{state}\n", self.out.display()))?;
        Ok(exit::SUCCESS)
    }
}
