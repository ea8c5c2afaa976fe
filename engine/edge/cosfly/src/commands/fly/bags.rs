//! `cosfly fly bags`: the logs of a result as ROS 2 bags.

use crate::command::Outcome;
use crate::console::Console;
use crate::exit;
use crate::text::{bytes, count};
use clap::Args;
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_export::flown_bags;
use cosfly_fly::results::Folder;
use std::path::PathBuf;

/// Most episodes without a log that are named.
const NAMED: usize = 10;

/// Write the logs of a result as ROS 2 bags, one per episode
#[derive(Args, Debug)]
#[command(after_help = "\
Example:
  cosfly fly bags out/fly/street/follow --out out/follow-bags

The new folder appears when it is whole. Its README.md lists the topics. Episodes without a log for Foxglove (`--logs worst`, `none`) have no bag, and are named.")]
pub struct Arguments {
    /// Folder of a finished result
    #[arg(value_name = "RESULT")]
    result: PathBuf,
    /// The folder to make; it must not exist yet
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

impl Arguments {
    /// Does the work.
    pub fn run(&self, console: &dyn Console) -> Outcome {
        let (_, rows) = Folder::read(&self.result)?;
        let log = |name: String| (self.result.join(format!("logs/{name}.mcap")), name);
        let flights = rows.into_iter().map(|row| log(row.episode)).map(|(path, name)| (name, path));
        let (flights, without): (Vec<(String, PathBuf)>, Vec<_>) = flights.partition(|(_, path)| path.is_file());
        if flights.is_empty() {
            let message = format!("`{}` has no logs that bags can be made of", self.result.display());
            return Err(Diagnostic::new("fly-result", Fault::Input, message)
                .hint("fly the suite into another folder with `--logs all`")
                .into());
        }
        let progress = console.progress("bags", "flights");
        let written = flown_bags(&flights, &self.result, &self.out, &*progress)?;
        drop(progress);
        let (bags, size) = (count(flights.len() as u64, "bag"), bytes(written.bytes));
        console.print(&format!("{}: {bags} of {size}\n", self.out.display()))?;
        if !without.is_empty() {
            let names: Vec<String> = without.iter().take(NAMED).map(|(name, _)| format!("`{name}`")).collect();
            let more = if without.len() > NAMED { ", ..." } else { "" };
            let episodes = count(without.len() as u64, "episode");
            console.print(&format!("  {episodes} without a log, so without a bag: {}{more}\n", names.join(", ")))?;
        }
        Ok(exit::SUCCESS)
    }
}
