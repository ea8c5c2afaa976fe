//! `cosfly fly commit`: a suite that nobody knows before it is revealed.

use crate::arguments::{StoreArguments, threads};
use crate::command::Outcome;
use crate::console::Console;
use crate::exit;
use clap::Args;
use cosfly_diagnose::{Diagnostic, Fault, Result, counted};
use cosfly_fly::held_out::{Nonce, commitment, drawn, is_held_out, text, with_suite};
use cosfly_fly::suite::Suite;
use cosfly_runner::RunOptions;
use cosfly_whole::write_file;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Line of `.gitignore` that keeps secrets out of a repository.
const IGNORED: &str = "*.secret.toml";

/// Make a suite that nobody knows before it is revealed: a recipe to keep secret, and a commitment to publish
#[derive(Args, Debug)]
#[command(after_help = "\
Example:
  cosfly fly commit recipes/suites/street.toml

Beside the recipe it writes NAME.secret.toml, the same recipe with a seed that follows from 256 random bits of the operating system, and
NAME.commitment, the digest of that file. Publish the commitment; keep the secret, which a line of .gitignore keeps out of the repository. Once
revealed, `cosfly fly NAME.toml --commitment NAME.commitment` holds file and episodes against it.")]
pub struct Arguments {
    /// Recipe of a suite
    #[arg(value_name = "RECIPE")]
    recipe: PathBuf,
    #[command(flatten)]
    store: StoreArguments,
    /// Threads that make the episodes [default: one per core]
    #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
}

impl Arguments {
    /// Does the work.
    pub fn run(&self, console: &dyn Console) -> Outcome {
        let registry = cosfly_stages::registry();
        let recipe = cosfly_recipe::load(&self.recipe, &[], &registry)?;
        if is_held_out(&recipe) {
            let message = format!("`{}` is a held-out suite already", self.recipe.display());
            let refusal = Diagnostic::new("fly-commitment", Fault::Recipe, message);
            return Err(refusal.hint("give the recipe that it was made of").into());
        }
        let nonce = nonce()?;
        let (name, seed) = drawn(&recipe.name, &nonce);
        let text = text(&recipe.text, &name, seed, &nonce);
        let folder = self.recipe.parent().unwrap_or(Path::new(""));
        let (secret, published) =
            (folder.join(format!("{name}.secret.toml")), folder.join(format!("{name}.commitment")));
        let held_out = cosfly_recipe::read(&secret, &text, &[], &registry)?;
        let jobs = threads(self.jobs);
        let options = RunOptions { jobs, cancelled: console.cancelled(), ..RunOptions::default() };
        let suite = {
            let _deadline = console.deadline(None);
            Suite::make(&held_out, &self.store.open()?, &options, &*console.run_progress(true))?
        };
        let text = with_suite(&text, &suite.digest);
        ignore_secrets(&folder.join(".gitignore"))?;
        write(&secret, &text)?;
        write(&published, &format!("{}\n", commitment(&text)))?;
        let (secret, published, episodes) = (secret.display(), published.display(), suite.tasks.len());
        console.print(&format!(
            "{secret}: {episodes}, to keep\n{published}: {}, to publish\n",
            commitment(&text),
            episodes = counted(episodes, "episode")
        ))?;
        Ok(exit::SUCCESS)
    }
}

/// Random bits of the operating system.
fn nonce() -> Result<Nonce> {
    let mut nonce = Nonce::default();
    let read = File::open("/dev/urandom").and_then(|mut file| file.read_exact(&mut nonce));
    read.map_err(|error| Diagnostic::io("read random bits of the operating system", &error))?;
    Ok(nonce)
}

/// Sees to it that git ignores secrets in the folder of the file.
fn ignore_secrets(path: &Path) -> Result<()> {
    let kept = std::fs::read_to_string(path).unwrap_or_default();
    if kept.lines().any(|line| line == IGNORED) {
        return Ok(());
    }
    let end = if kept.is_empty() || kept.ends_with('\n') { "" } else { "\n" };
    write(path, &format!("{kept}{end}{IGNORED}\n"))
}

fn write(path: &Path, text: &str) -> Result<()> {
    write_file(path, text.as_bytes()).map_err(|error| Diagnostic::io(format!("write {}", path.display()), &error))
}
