//! `cosfly fly`: flies the episodes of a suite with policies, in closed loop, and scores them.

mod bags;
mod bundle;
mod commit;
mod compare;
mod cost;
pub mod policy;
mod verify;

use crate::arguments::{RecipeArguments, StoreArguments, threads};
use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use crate::subject::Subject;
use clap::{Parser, Subcommand, ValueEnum};
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_drone::models::{self, DroneModel};
use cosfly_env::{DroneSettings, EnvironmentSettings, MOST_BLACKOUTS, MOST_LATENCY_MS, MOST_WIND_MPS};
use cosfly_fly::flight::Latency;
use cosfly_fly::pilot::Place;
use cosfly_fly::results::{Card, EnvironmentCard, Folder, KeptCard, LogChoice, SuiteCard, beside};
use cosfly_fly::run::{EpisodeShare, Order, run};
use cosfly_fly::settings::FlySettings;
use cosfly_fly::suite::Suite;
use cosfly_runner::RunOptions;
use cosfly_store::check_out_folder;
use cost::Clock;
use policy::PolicyArguments;
use std::fmt::Write as _;
use std::path::PathBuf;

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
  cosfly fly recipes/suites/street.toml --policy onnx:policy.onnx
  cosfly fly recipes/benchmarks/track_1.toml --tier mini --policy follow
  cosfly fly compare out/fly/street/follow out/fly/street/mine
  cosfly fly bags out/fly/street/mine --out out/mine-bags
  cosfly fly bundle out/fly/street/mine
  cosfly fly verify out/fly/street/mine.jsonl.zst recipes/suites/street.toml

A policy is a server that speaks openpi's wire, a function in Python, a network in an ONNX file, or a baseline: causal,
constant-velocity, expert, follow, hold, random. A network's file says what it sees and how it is asked. Others get a map with `state` (16 numbers), `prompt`, `episode`, `step` and `time_s`, and answer with a
map whose `actions` are rows of numbers. A baseline may be varied: follow:gain=0.5,delay_s=0.3,lead_s=0.2,noise_mps=1. The result is a folder: card.json, report.html with clips of the worst
episodes, report.md, scores.json, episodes.jsonl, rows and logs. The same command goes on with what a folder lacks. Exits with 1 when a policy
has given no right answer (then nothing is an episode, and nothing is kept) or went away before all episodes were flown."
)]
pub struct Arguments {
    #[command(subcommand)]
    other: Option<Other>,
    #[command(flatten)]
    recipe: Option<RecipeArguments>,
    #[command(flatten)]
    store: StoreArguments,
    /// The policy: ws://HOST:PORT, python:MODULE:FUNCTION, onnx:FILE, or the name of a baseline (repeatable)
    #[arg(long, value_name = "POLICY", required = true)]
    policy: Vec<String>,
    /// Tier of a benchmark, such as mini
    #[arg(long, value_name = "NAME")]
    tier: Option<String>,
    /// Hold a held-out suite against its commitment: the file that `cosfly fly commit` wrote, or its 64 digits
    #[arg(long, value_name = "COMMITMENT")]
    commitment: Option<String>,
    /// Name of the policy in the result [default: made from its place]
    #[arg(long, value_name = "NAME", value_parser = folder_name)]
    name: Option<String>,
    /// Folder for the results, one folder per policy [default: out/fly/<recipe name>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Episodes at the same time [default: one per core]
    #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Fly a share of the episodes, such as 1/4; once the folder has all, the tables are written
    #[arg(long, value_name = "I/N", value_parser = shard, default_value = "1/1")]
    shard: EpisodeShare,
    /// Simulated time from an observation to the effect of the action that answers it; the world moves on meanwhile
    /// (`measured`: as long as the policy really takes; then rows and logs differ from run to run) [default: that of the suite, else 0]
    #[arg(long, value_name = "MS", value_parser = latency)]
    latency_ms: Option<LatencyChoice>,
    /// Simulated time from one action to the next
    #[arg(long, value_name = "MS", default_value_t = 100, value_parser = clap::value_parser!(u32).range(10..=1000))]
    step_ms: u32,
    /// The drone [default: that of the suite, else a point mass]
    #[arg(long, value_name = "MODEL", value_parser = models::model)]
    drone: Option<DroneModel>,
    /// Speed of the mean wind that moves a quadrotor, m/s; each episode draws its direction [default: that of the suite, else 0]
    #[arg(long, value_name = "MPS", value_parser = wind)]
    wind_mps: Option<f64>,
    /// Gusts in the wind
    #[arg(long)]
    gusts: bool,
    /// Stretches of an episode in which the camera sees nothing, each of two to four seconds [default: that of the suite, else 0]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=i64::from(MOST_BLACKOUTS)))]
    blackouts: Option<u32>,
    #[command(flatten)]
    asked: PolicyArguments,
    /// Episodes whose logs are also written for Foxglove (MCAP): all, those that have clips, none
    #[arg(long, value_enum, value_name = "WHICH", default_value_t = LogsChoice::All)]
    logs: LogsChoice,
    /// Number of the worst episodes that get a clip on the page
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(0..=100))]
    clips: u32,
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
    Bags(bags::Arguments),
    Bundle(bundle::Arguments),
    Commit(commit::Arguments),
    Compare(compare::Arguments),
    Verify(verify::Arguments),
}

/// Episodes with logs for Foxglove.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum LogsChoice {
    /// All episodes
    All,
    /// The episodes that have clips
    Worst,
    /// No episode
    None,
}

impl From<LogsChoice> for LogChoice {
    fn from(choice: LogsChoice) -> Self {
        match choice {
            LogsChoice::All => Self::All,
            LogsChoice::Worst => Self::Worst,
            LogsChoice::None => Self::None,
        }
    }
}

/// Time from an observation to the effect of its action.
#[derive(Clone, Copy, Debug)]
enum LatencyChoice {
    Milliseconds(u32),
    Measured,
}

fn latency(text: &str) -> Result<LatencyChoice, String> {
    if text == "measured" {
        return Ok(LatencyChoice::Measured);
    }
    let number = text.parse().ok().filter(|number| *number <= MOST_LATENCY_MS);
    number.map(LatencyChoice::Milliseconds).ok_or_else(|| format!("it must be 0 to {MOST_LATENCY_MS}, or `measured`"))
}

fn wind(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (0.0..=MOST_WIND_MPS).contains(number));
    number.ok_or_else(|| format!("it must be 0 to {MOST_WIND_MPS}"))
}

/// Name that can be that of a folder.
pub fn folder_name(text: &str) -> Result<String, String> {
    let is_safe = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    let fits = !text.is_empty() && !text.starts_with('.') && text.chars().all(is_safe);
    if fits { Ok(text.to_owned()) } else { Err("letters, digits, `-`, `_` and `.` are allowed".to_owned()) }
}

fn shard(text: &str) -> Result<EpisodeShare, String> {
    let number = |text: &str| text.parse::<usize>().ok();
    let parts = text.split_once('/').and_then(|(index, of)| Some((number(index)?, number(of)?)));
    match parts {
        Some((index, of)) if index >= 1 && index <= of => Ok(EpisodeShare { index: index - 1, of }),
        _ => Err("it must be like 1/4: a number from 1 on, and the number of shares".to_owned()),
    }
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        match &self.other {
            Some(Other::Compare(arguments)) => return arguments.run(console),
            Some(Other::Bags(arguments)) => return arguments.run(console),
            Some(Other::Bundle(arguments)) => return arguments.run(console),
            Some(Other::Commit(arguments)) => return arguments.run(console),
            Some(Other::Verify(arguments)) => return arguments.run(console),
            None => {}
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
        check_names(&places)?;
        places.iter().try_for_each(|place| self.asked.check(place))?;
        let manners = self.asked.manners()?;
        let subject = Subject::load(recipe, self.tier.as_deref(), console)?;
        let parts = subject.parts()?;
        let settings =
            |place| parts.iter().map(|part| self.settings(&part.settings, place)).collect::<Result<Vec<_>, _>>();
        let settings = places.iter().map(settings).collect::<Result<Vec<_>, _>>()?;
        let out = self.out.clone().unwrap_or_else(|| PathBuf::from("out").join("fly").join(&subject.name));
        check_out_folder(&self.store.folder(), &out)?;
        let store = self.store.open()?;
        let jobs = threads(self.jobs);
        let options = RunOptions { jobs, cancelled: console.cancelled(), ..RunOptions::default() };
        let suite = {
            let _deadline = console.deadline(None);
            let progress = console.run_progress(self.quiet);
            subject.make(&store, &options, &*progress)?
        };
        if let Some(commitment) = &self.commitment {
            subject.check(&suite, commitment)?;
        }
        let mut arms = Vec::new();
        let mut code = exit::SUCCESS;
        for (place, settings) in places.iter().zip(&settings) {
            let name = self.name.clone().unwrap_or_else(|| place.name());
            let card = self.card(&suite, place, &name, settings);
            let folder = Folder::open(&out.join(&name), &card)?;
            let cancelled = console.cancelled();
            let (shard, suite) = (self.shard, &suite);
            let latency = self.latency();
            let order =
                Order { suite, place, manners: &manners, settings, latency, shard, jobs, cancelled: &cancelled };
            let progress = console.progress("fly", "episodes");
            let deadline = console.deadline(None);
            let clock = Clock::start();
            let outcome = run(&order, &card, &folder, &*progress)?;
            drop((progress, deadline));
            if let Some(problem) = &outcome.gone {
                console.tell(&cosfly_diagnose::render(problem, console.colour()));
                code = exit::FOUND_PROBLEMS;
            }
            if !self.quiet && !self.json {
                let state = if outcome.whole { "" } else { ", not yet whole" };
                let kept = outcome.rows.len() - outcome.flown;
                let path = folder.path().display();
                console.print(&format!("{path}: {} flown, {kept} kept{state}\n", outcome.flown))?;
                if outcome.flown > 0 {
                    console.tell(&format!("{name}: {}\n", clock.words(outcome.flown)));
                }
            }
            if !outcome.rows.is_empty() {
                arms.push((name, outcome.rows));
            }
        }
        if self.json || !arms.is_empty() {
            self.tell(&arms, console)?;
        }
        Ok(code)
    }
}

/// Every policy has a name of its own: the folder of its results.
fn check_names(places: &[Place]) -> cosfly_diagnose::Result<()> {
    let names: Vec<String> = places.iter().map(Place::name).collect();
    let Some(name) = names.iter().enumerate().find_map(|(index, name)| names[..index].contains(name).then_some(name))
    else {
        return Ok(());
    };
    let message = format!("two policies have the name `{name}`: results of both would lie in one folder");
    let refusal = Diagnostic::new("fly-policy", Fault::Recipe, message);
    Err(refusal.hint("leave one out, or fly each by a command of its own with `--name`"))
}

impl Arguments {
    /// Settings of the environment: those of the suite, and over them those of the command line.
    fn settings(&self, suite: &FlySettings, place: &Place) -> cosfly_diagnose::Result<EnvironmentSettings> {
        let seconds = |milliseconds: u32| f64::from(milliseconds) / 1000.0;
        let latency_s = match self.latency_ms {
            None => seconds(suite.latency_ms),
            Some(LatencyChoice::Milliseconds(milliseconds)) => seconds(milliseconds),
            Some(LatencyChoice::Measured) => 0.0,
        };
        let drone = DroneSettings {
            model: self.drone.unwrap_or(suite.drone),
            wind_mps: self.wind_mps.unwrap_or(suite.wind_mps),
            gusts: self.gusts || suite.gusts,
            sensors: !matches!(self.logs, LogsChoice::None),
        };
        let actions = self.asked.actions(place);
        let is_point = drone.model.parameters.is_none();
        let refused = |message: &str| {
            let problem = Diagnostic::new("fly-drone", Fault::Recipe, message);
            Err(problem.hint("choose a quadrotor: `--drone pelican` or `--drone crazyflie`"))
        };
        if is_point && actions.is_of_rotors() {
            return refused(&format!("a point mass takes no actions of the kind `{}`", actions.name()));
        }
        if is_point && (drone.wind_mps > 0.0 || drone.gusts) {
            return refused("wind does not move a point mass");
        }
        let (step_s, sensors) = (seconds(self.step_ms), self.asked.sensors(place));
        let suite = FlySettings { blackouts: self.blackouts.unwrap_or(suite.blackouts), ..*suite };
        Ok(EnvironmentSettings { step_s, latency_s, drone, sensors, ..suite.environment() })
    }

    fn latency(&self) -> Latency {
        match self.latency_ms {
            None | Some(LatencyChoice::Milliseconds(_)) => Latency::Simulated,
            Some(LatencyChoice::Measured) => Latency::Measured,
        }
    }

    fn card(&self, suite: &Suite, place: &Place, name: &str, settings: &[EnvironmentSettings]) -> Card {
        let (environment, environments) = EnvironmentCard::of_parts(&suite.parts, settings, self.latency());
        Card {
            suite: SuiteCard::of(suite),
            policy: self.asked.card(place, name),
            environment,
            environments,
            kept: KeptCard { logs: self.logs.into(), clips: self.clips },
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
