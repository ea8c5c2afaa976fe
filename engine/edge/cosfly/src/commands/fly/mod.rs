//! `cosfly fly`: flies the episodes of a suite with policies, in closed loop, and scores them.

mod compare;

use crate::arguments::{RecipeArguments, StoreArguments, count};
use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use clap::{Parser, Subcommand, ValueEnum};
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_env::Settings;
use cosfly_fly::pilot::{ActionKind, Manners, Place};
use cosfly_fly::results::{Card, Folder, PolicyCard, SuiteCard, beside};
use cosfly_fly::run::{Order, Shard, run};
use cosfly_fly::suite::Suite;
use cosfly_runner::RunOptions;
use cosfly_store::check_out_folder;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::time::Duration;

/// Fly a suite's episodes with a policy, in closed loop, and score it
#[derive(Debug, Parser)]
#[command(
    name = "fly",
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_help = "\
Examples:
  cosfly fly recipes/suites/street.toml --policy follow
  cosfly fly recipes/suites/street.toml --policy hold --policy follow --policy causal --policy expert
  cosfly fly recipes/suites/street.toml --policy ws://127.0.0.1:8000 --name mine --latency-ms 57
  cosfly fly recipes/suites/street.toml --policy python:my_policy:act
  cosfly fly compare out/fly/street/follow out/fly/street/mine

A policy is a server that speaks openpi's wire, a function in Python, or a baseline: causal, constant-velocity, expert,
follow, hold, random. It gets a map with `state` (16 numbers), `prompt`, `episode`, `step` and `time_s`, and answers with a
map whose `actions` are rows of numbers. The result is a folder: card.json, report.md, scores.json, episodes.jsonl, rows and
logs. The same command goes on with what a folder lacks. Exits with 1 when a policy could not be had for some episodes."
)]
pub struct Arguments {
    #[command(subcommand)]
    other: Option<Other>,
    #[command(flatten)]
    recipe: Option<RecipeArguments>,
    #[command(flatten)]
    store: StoreArguments,
    /// The policy: ws://HOST:PORT, python:MODULE:FUNCTION, or the name of a baseline (repeatable)
    #[arg(long, value_name = "POLICY", required = true)]
    policy: Vec<String>,
    /// Name of the policy in the result [default: made from its place]
    #[arg(long, value_name = "NAME", value_parser = folder_name)]
    name: Option<String>,
    /// Version of the policy, for the card
    #[arg(long = "policy-version", value_name = "TEXT")]
    version: Option<String>,
    /// Folder for the results, one folder per policy [default: out/fly/<recipe name>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Episodes at the same time [default: one per core]
    #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Fly a share of the episodes, such as 1/4; once the folder has all, the tables are written
    #[arg(long, value_name = "I/N", value_parser = shard, default_value = "1/1")]
    shard: Shard,
    /// Simulated time from an observation to the effect of the action that answers it; the world moves on meanwhile
    #[arg(long, value_name = "MS", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=5000))]
    latency_ms: u32,
    /// Simulated time from one action to the next
    #[arg(long, value_name = "MS", default_value_t = 100, value_parser = clap::value_parser!(u32).range(10..=1000))]
    step_ms: u32,
    /// Kind of the actions that a policy answers with
    #[arg(long, value_enum, default_value_t = ActionChoice::Velocity)]
    actions: ActionChoice,
    /// Steps after which a policy is asked again; rows of its last answer are flown meanwhile
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = count())]
    every: usize,
    /// Text of the task in observations
    #[arg(long, value_name = "TEXT", default_value = "Follow the person and keep them in view.")]
    prompt: String,
    /// Time within which an answer must come, seconds; an episode without one ends
    #[arg(long, value_name = "SECONDS", default_value_t = 10.0, value_parser = seconds)]
    timeout: f64,
    /// Time for which a policy that is absent is waited for, seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0, value_parser = seconds)]
    wait: f64,
    /// Key that a server gets as `Authorization: Api-Key KEY`
    #[arg(long, value_name = "KEY", env = "COSFLY_API_KEY", hide_env_values = true)]
    api_key: Option<String>,
    /// Command of Python, for policies in Python
    #[arg(long, value_name = "COMMAND", default_value = "python3")]
    python: PathBuf,
    /// Print the scores as JSON
    #[arg(long)]
    json: bool,
    /// Print errors and the table only
    #[arg(long, short)]
    quiet: bool,
}

/// Other work with results.
#[derive(Debug, Subcommand)]
enum Other {
    Compare(compare::Arguments),
}

/// Kind of actions.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum ActionChoice {
    /// Five numbers a step: velocity ahead, right, up (m/s), yaw and pitch rate (degrees/s)
    Velocity,
    /// Six numbers a frame of the dataset: dx, dy, dz (m), dpitch, dyaw, droll (degrees), along the world's axes
    DeltasWorld,
    /// As before, along the axes of the body that moves
    DeltasBody,
}

impl From<ActionChoice> for ActionKind {
    fn from(choice: ActionChoice) -> Self {
        match choice {
            ActionChoice::Velocity => Self::Velocity,
            ActionChoice::DeltasWorld => Self::DeltasInWorld,
            ActionChoice::DeltasBody => Self::DeltasInBody,
        }
    }
}

fn folder_name(text: &str) -> Result<String, String> {
    let is_safe = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    let fits = !text.is_empty() && !text.starts_with('.') && text.chars().all(is_safe);
    if fits { Ok(text.to_owned()) } else { Err("letters, digits, `-`, `_` and `.` are allowed".to_owned()) }
}

fn seconds(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| "it is not a number".to_owned())?;
    if (0.001..=86_400.0).contains(&number) { Ok(number) } else { Err("it must be 0.001 to 86400".to_owned()) }
}

fn shard(text: &str) -> Result<Shard, String> {
    let number = |text: &str| text.parse::<usize>().ok();
    let parts = text.split_once('/').and_then(|(index, of)| Some((number(index)?, number(of)?)));
    match parts {
        Some((index, of)) if index >= 1 && index <= of => Ok(Shard { index: index - 1, of }),
        _ => Err("it must be like 1/4: a number from 1 on, and the number of shares".to_owned()),
    }
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        if let Some(Other::Compare(arguments)) = &self.other {
            return arguments.run(console);
        }
        let Some(recipe) = &self.recipe else {
            let message = "a suite is missing: `cosfly fly SUITE --policy POLICY`";
            return Err(Diagnostic::new("fly-suite", Fault::Recipe, message).into());
        };
        let places = self.policy.iter().map(|text| Place::read(text)).collect::<Result<Vec<_>, _>>()?;
        if places.len() > 1 && self.name.is_some() {
            let message = "`--name` names one policy, but several are given";
            return Err(Diagnostic::new("fly-policy", Fault::Recipe, message).hint("leave it out").into());
        }
        let recipe = recipe.load(console)?;
        let out = self.out.clone().unwrap_or_else(|| PathBuf::from("out").join("fly").join(&recipe.name));
        check_out_folder(&self.store.folder(), &out)?;
        let store = self.store.open()?;
        let jobs = self.jobs.map_or_else(|| std::thread::available_parallelism().map_or(1, usize::from), usize::from);
        let options = RunOptions { jobs, cancelled: console.cancelled(), ..RunOptions::default() };
        let suite = {
            let progress = console.run_progress(self.quiet);
            Suite::make(&recipe, &store, &options, &*progress)?
        };
        let mut arms = Vec::new();
        let mut code = exit::SUCCESS;
        for place in &places {
            let name = self.name.clone().unwrap_or_else(|| place.name());
            let card = self.card(&suite, place, &name);
            let folder = Folder::open(&out.join(&name), &card)?;
            let cancelled = console.cancelled();
            let (manners, settings) = (self.manners(), self.settings());
            let (shard, suite) = (self.shard, &suite);
            let order = Order { suite, place, manners: &manners, settings, shard, jobs, cancelled: &cancelled };
            let progress = console.progress("fly", "episodes");
            let outcome = run(&order, &card, &folder, &*progress)?;
            drop(progress);
            if let Some(reason) = &outcome.gone {
                let message = format!("`{name}` could not be had for {} of the episodes", outcome.missing);
                let problem = Diagnostic::new("fly-policy-gone", Fault::Machine, message).because(reason.clone());
                let problem = problem.hint("the episodes that were flown are kept: the same command flies the others");
                console.tell(&cosfly_diagnose::render(&problem, console.colour()));
                code = exit::FOUND_PROBLEMS;
            }
            if !self.quiet && !self.json {
                let state = if outcome.whole { "" } else { ", not yet whole" };
                let kept = outcome.rows.len() - outcome.flown;
                let path = folder.path().display();
                console.print(&format!("{path}: {} flown, {kept} kept{state}\n", outcome.flown))?;
            }
            arms.push((name, outcome.rows));
        }
        self.tell(&arms, console)?;
        Ok(code)
    }
}

impl Arguments {
    fn settings(&self) -> Settings {
        let seconds = |milliseconds: u32| f64::from(milliseconds) / 1000.0;
        Settings { step_s: seconds(self.step_ms), latency_s: seconds(self.latency_ms), ..Settings::default() }
    }

    fn manners(&self) -> Manners {
        Manners {
            actions: self.actions.into(),
            every: u32::try_from(self.every).unwrap_or(u32::MAX),
            prompt: self.prompt.clone(),
            timeout: Duration::from_secs_f64(self.timeout),
            wait: Duration::from_secs_f64(self.wait),
            api_key: self.api_key.clone(),
            python: self.python.clone(),
        }
    }

    fn card(&self, suite: &Suite, place: &Place, name: &str) -> Card {
        let kind = match place {
            Place::Baseline(_) => "baseline",
            Place::Socket(_) => "socket",
            Place::Python { .. } => "python",
        };
        let manners = self.manners();
        Card {
            suite: SuiteCard {
                name: suite.name.clone(),
                hash: suite.digest.to_string(),
                episodes: suite.tasks.len() as u64,
                rejected: suite.rejected,
            },
            policy: PolicyCard {
                name: name.to_owned(),
                version: self.version.clone(),
                kind: kind.to_owned(),
                actions: manners.actions.name().to_owned(),
                every: manners.every,
                prompt: manners.prompt,
            },
            environment: (&self.settings()).into(),
            cosfly: env!("CARGO_PKG_VERSION").to_owned(),
        }
    }

    fn tell(
        &self,
        arms: &[(String, Vec<cosfly_fly::flight::Row>)],
        console: &dyn Console,
    ) -> cosfly_diagnose::Result<()> {
        if self.json {
            let scores = arms.iter().map(|(name, rows)| (name.clone(), cosfly_fly::results::scores(rows)));
            let scores: serde_json::Map<String, serde_json::Value> = scores.collect();
            let mut text = String::new();
            let _ = writeln!(text, "{:#}", serde_json::Value::Object(scores));
            console.print(&text)?;
            return Ok(());
        }
        let arms: Vec<(&str, &[_])> = arms.iter().map(|(name, rows)| (name.as_str(), rows.as_slice())).collect();
        console.print(&beside(&arms))?;
        Ok(())
    }
}
