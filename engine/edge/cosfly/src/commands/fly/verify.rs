//! `cosfly fly verify`: the actions of a bundle, flown again.

use crate::arguments::{RecipeArguments, StoreArguments};
use crate::command::Outcome;
use crate::console::Console;
use crate::exit;
use crate::subject::Subject;
use clap::Args;
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_fly::again::fly_again;
use cosfly_fly::bundle::Bundle;
use cosfly_runner::RunOptions;
use std::fmt::Write as _;
use std::path::PathBuf;

/// Most differences that are shown.
const SHOWN: usize = 10;

/// Fly the actions of a bundle again: they must come to the same rows, byte for byte
#[derive(Args, Debug)]
#[command(after_help = "\
Example:
  cosfly fly verify out/fly/street/mine.jsonl.zst recipes/suites/street.toml

Success says that these actions give these scores in this suite. It does not say who gave the actions. Exits with 1 when an episode comes
out differently, and names its first step that does; with 4 when the file is damaged, or of another suite.")]
pub struct Arguments {
    /// The file of `cosfly fly bundle`
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    recipe: RecipeArguments,
    #[command(flatten)]
    store: StoreArguments,
    /// Episodes at the same time [default: one per core]
    #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
}

impl Arguments {
    /// Does the work.
    pub fn run(&self, console: &dyn Console) -> Outcome {
        let bundle = Bundle::read(&self.file)?;
        let subject = Subject::find(&self.recipe, &bundle.card.suite.name, console)?;
        let jobs = self.jobs.map_or_else(|| std::thread::available_parallelism().map_or(1, usize::from), usize::from);
        let options = RunOptions { jobs, cancelled: console.cancelled(), ..RunOptions::default() };
        let suite = {
            let _deadline = console.deadline(None);
            subject.make(&self.store.open()?, &options, &*console.run_progress(true))?
        };
        let (ours, theirs) = (suite.digest.to_string(), &bundle.card.suite.hash);
        if ours != *theirs {
            let rule =
                format!("its suite `{}` has the hash {theirs}, `{}` has {ours}", bundle.card.suite.name, suite.name);
            return Err(self.refused("it is of another suite", &rule).into());
        }
        let settings = bundle.card.settings(&suite.parts);
        let settings = settings.map_err(|rule| self.refused("its environment is not one of this suite", &rule))?;
        let progress = console.progress("fly again", "episodes");
        let differ = fly_again(&bundle, &suite, &settings, jobs, &console.cancelled(), &*progress)?;
        drop(progress);
        let (name, all) = (&bundle.card.policy.name, bundle.episodes.len());
        let mut text = format!("{name}: {} of {all} episodes come out the same, byte for byte\n", all - differ.len());
        for line in differ.iter().take(SHOWN) {
            let _ = writeln!(text, "  {line}");
        }
        if differ.len() > SHOWN {
            let _ = writeln!(text, "  and {} more", differ.len() - SHOWN);
        }
        console.print(&text)?;
        Ok(if differ.is_empty() { exit::SUCCESS } else { exit::FOUND_PROBLEMS })
    }

    fn refused(&self, what: &str, rule: &str) -> Box<Diagnostic> {
        let message = format!("`{}` cannot be flown again: {what}", self.file.display());
        Diagnostic::new("fly-bundle", Fault::Input, message)
            .because(rule)
            .hint("give the recipe of the suite, with the same `--set`, and the version of cosfly that the card names")
    }
}
