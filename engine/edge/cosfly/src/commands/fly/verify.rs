//! `cosfly fly verify`: the actions of a bundle, flown again, or its policy, run again.

use crate::arguments::{RecipeArguments, StoreArguments, threads};
use crate::command::Outcome;
use crate::console::Console;
use crate::exit;
use crate::subject::Subject;
use clap::Args;
use cosfly_diagnose::{Diagnostic, Fault, Result, visible_text};
use cosfly_fly::again::Again;
use cosfly_fly::bundle::Bundle;
use cosfly_fly::pilot::{OnnxPolicy, Runnable};
use cosfly_runner::RunOptions;
use std::fmt::Write as _;
use std::path::PathBuf;

/// Most differences that are shown.
const SHOWN: usize = 10;

/// Fly the actions of a bundle again, or run its policy again: it must come to the same rows, byte for byte
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  cosfly fly verify out/fly/street/mine.jsonl.zst recipes/suites/street.toml
  cosfly fly verify out/fly/street/mine.jsonl.zst recipes/suites/street.toml --run-policy

Success says that these actions give these scores in this suite. It does not say who gave the actions. With `--run-policy` the policy is
asked instead, on what it sees here, and must give the same actions: a baseline, or a network in ONNX in the bundle or in `--policy-file`.
No other code of a bundle is ever run. Exits with 1 when an episode comes
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
    /// Run the policy again on what it sees, and compare its actions with those in the bundle
    #[arg(long)]
    run_policy: bool,
    /// The file of the policy, a network in ONNX, where the bundle names it by its digest alone
    #[arg(long, value_name = "FILE", requires = "run_policy")]
    policy_file: Option<PathBuf>,
}

impl Arguments {
    /// Does the work.
    pub fn run(&self, console: &dyn Console) -> Outcome {
        let bundle = Bundle::read(&self.file)?;
        let policy = if self.run_policy { Some(self.policy(&bundle)?) } else { None };
        let subject = Subject::find(&self.recipe, &bundle.card.suite.name, console)?;
        let jobs = threads(self.jobs);
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
        let (progress, cancelled) = (console.progress("fly again", "episodes"), console.cancelled());
        let deadline = console.deadline(None);
        let again = Again { bundle: &bundle, suite: &suite, settings: &settings, jobs, cancelled: &cancelled };
        let differ = match &policy {
            Some(policy) => again.by_policy(policy, &*progress)?,
            None => again.by_record(&*progress)?,
        };
        drop((progress, deadline));
        let one_line = |text: &str| visible_text(text).replace('\n', " ");
        let (name, all) = (one_line(&bundle.card.policy.name), bundle.episodes.len());
        let how = if policy.is_some() { "re-run" } else { "re-flown" };
        let same = all - differ.len();
        let come = if all == 1 { "episode comes" } else { "episodes come" };
        let mut text = format!("{name}, {how}: {same} of {all} {come} out the same, byte for byte\n");
        for line in differ.iter().take(SHOWN) {
            let _ = writeln!(text, "  {}", one_line(line));
        }
        if differ.len() > SHOWN {
            let _ = writeln!(text, "  and {} more", differ.len() - SHOWN);
        }
        let here = env!("CARGO_PKG_VERSION");
        if bundle.card.cosfly != here {
            let _ = writeln!(text, "  flown by cosfly {} before, by cosfly {here} now", one_line(&bundle.card.cosfly));
        }
        console.print(&text)?;
        Ok(if differ.is_empty() { exit::SUCCESS } else { exit::FOUND_PROBLEMS })
    }

    /// The policy that is run again.
    fn policy(&self, bundle: &Bundle) -> Result<Runnable> {
        let beside = self.policy_file.as_deref().map(OnnxPolicy::read).transpose()?;
        let file = beside.as_ref().map(OnnxPolicy::bytes).or(bundle.policy.as_deref());
        let rule = match Runnable::of(&bundle.card.policy, file) {
            Ok(Some(Runnable::Baseline(..))) if beside.is_some() => "it is a baseline, which has no file".to_owned(),
            Ok(Some(policy)) => return Ok(policy),
            Ok(None) if bundle.card.policy.kind == "onnx" => "the bundle names it by its digest alone".to_owned(),
            Ok(None) => format!("it is of the kind `{}`", bundle.card.policy.kind),
            Err(rule) => rule,
        };
        let message = format!("the policy of `{}` cannot be run again", self.file.display());
        Err(Diagnostic::new("fly-policy", Fault::Input, message).because(rule).hint(
            "baselines and networks in ONNX are run again: give the file of a network with `--policy-file FILE`, or leave `--run-policy` out",
        ))
    }

    fn refused(&self, what: &str, rule: &str) -> Box<Diagnostic> {
        let message = format!("`{}` cannot be flown again: {what}", self.file.display());
        Diagnostic::new("fly-bundle", Fault::Input, message)
            .because(rule)
            .hint("give the recipe of the suite, with the same `--set`, and the version of cosfly that the card names")
    }
}
