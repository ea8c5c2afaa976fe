//! `cosfly dagger diff`: two versions of labels.

use crate::command::Outcome;
use crate::console::Console;
use crate::exit;
use clap::Args;
use cosfly_fly::dagger::difference::told;
use cosfly_fly::dagger::folder::LabelFolder;
use std::path::PathBuf;

/// Say which rounds were kept, added, changed or dropped between two versions
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  cosfly dagger diff labels/v1 labels/v2")]
pub struct Arguments {
    /// The earlier version
    #[arg(value_name = "OLD")]
    old: PathBuf,
    /// The later version
    #[arg(value_name = "NEW")]
    new: PathBuf,
}

impl Arguments {
    /// Does the work.
    pub fn run(&self, console: &dyn Console) -> Outcome {
        let (old, new) = (LabelFolder::card(&self.old)?, LabelFolder::card(&self.new)?);
        console.print(&told(Some(&old), &new))?;
        Ok(exit::SUCCESS)
    }
}
