//! `cosfly cluster slurm-script`: a script for Slurm that runs a recipe on HyperQueue inside one allocation.

use super::elsewhere::this_program;
use crate::arguments::{RecipeArguments, StoreArguments};
use crate::command::{Command, Entry, Outcome, dispatch, with_commands};
use crate::console::Console;
use crate::exit;
use clap::Parser;
use cosfly_cluster::{Allocation, slurm_script};
use cosfly_diagnose::Diagnostic;

const COMMANDS: &[Entry] = &[Entry::of::<SlurmScript>()];

/// The group.
pub const CLUSTER: Entry = Entry { command: group, run: |matches, console| dispatch(COMMANDS, matches, console) };

fn group() -> clap::Command {
    with_commands(clap::Command::new("cluster").about("Prepare runs on clusters"), COMMANDS)
}

/// Print an sbatch script that starts HyperQueue inside the allocation and runs a recipe there
#[derive(Debug, Parser)]
#[command(
    name = "slurm-script",
    after_help = "\
Examples:
  cosfly cluster slurm-script recipe.toml --nodes 4 --time 08:00:00 --store /shared/store > job.sh
  cosfly cluster slurm-script recipe.toml --sbatch=--partition=cpu --sbatch=--account=p1 > job.sh
  sbatch job.sh"
)]
struct SlurmScript {
    #[command(flatten)]
    recipe: RecipeArguments,
    #[command(flatten)]
    store: StoreArguments,
    /// Folder for the dataset [default: out/<recipe name>]
    #[arg(long, value_name = "DIR")]
    out: Option<std::path::PathBuf>,
    /// Nodes, each with one worker
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    nodes: u32,
    /// Time limit as Slurm reads it
    #[arg(long, value_name = "TIME", default_value = "08:00:00", value_parser = time)]
    time: String,
    /// Another option of sbatch, such as --sbatch=--partition=cpu (repeatable)
    #[arg(long = "sbatch", value_name = "OPTION", allow_hyphen_values = true)]
    options: Vec<String>,
    /// Resources of the tasks of a stage, as of `cosfly run` (repeatable)
    #[arg(long, value_name = "STAGE:RESOURCES")]
    request: Vec<String>,
}

/// Text that Slurm may read as a time limit: digits, colons and a dash.
fn time(text: &str) -> Result<String, String> {
    let is_time = !text.is_empty() && text.chars().all(|c| c.is_ascii_digit() || c == ':' || c == '-');
    if is_time { Ok(text.to_owned()) } else { Err("write minutes, HH:MM:SS or D-HH:MM:SS".to_owned()) }
}

impl Command for SlurmScript {
    fn run(&self, console: &dyn Console) -> Outcome {
        let recipe = self.recipe.load(console)?;
        for change in &self.request {
            cosfly_cluster::RequestChange::read(change)?;
        }
        let text = |path: &std::path::Path| path.to_string_lossy().into_owned();
        let mut command = this_program().map_err(|error| Diagnostic::io("find this program", &error))?;
        command.extend(["run".to_owned(), text(&self.recipe.recipe)]);
        command.extend(["--on", "hq", "--store"].map(str::to_owned));
        command.push(self.store.bucket().map_or_else(|| text(&self.store.folder()), str::to_owned));
        let mut option = |name: &str, value: &str| command.extend([name.to_owned(), value.to_owned()]);
        self.out.iter().for_each(|out| option("--out", &text(out)));
        self.recipe.overrides.iter().for_each(|change| option("--set", change));
        self.request.iter().for_each(|request| option("--request", request));
        let allocation = Allocation {
            name: format!("cosfly-{}", recipe.name),
            nodes: self.nodes,
            time: self.time.clone(),
            options: self.options.iter().map(|option| option.replace(['\n', '\r'], " ")).collect(),
            command,
        };
        console.print(&slurm_script(&allocation))?;
        Ok(exit::SUCCESS)
    }
}
