//! `cosfly dagger`: flights under a mixture of policy and expert, with the expert's action in every state.

mod diff;

use super::fly::policy::{Observed, PolicyArguments, observed, sensors_of};
use crate::arguments::{RecipeArguments, StoreArguments, threads};
use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use clap::{Parser, Subcommand};
use cosfly_diagnose::{Diagnostic, Fault, counted};
use cosfly_env::EnvironmentSettings;
use cosfly_fly::dagger::difference::told;
use cosfly_fly::dagger::folder::{LabelCard, LabelFolder, RoundCard};
use cosfly_fly::dagger::kept::KeptObservations;
use cosfly_fly::dagger::rollout::PolicyMixture;
use cosfly_fly::dagger::run::{Round, run};
use cosfly_fly::flight::Latency;
use cosfly_fly::pilot::{ActionKind, Place};
use cosfly_fly::results::{EnvironmentCard, PicturesCard, SuiteCard};
use cosfly_fly::settings::FlySettings;
use cosfly_fly::suite::Suite;
use cosfly_frames::Seed;
use cosfly_runner::RunOptions;
use cosfly_sensors::SensorSet;
use cosfly_store::check_out_folder;
use std::path::PathBuf;

/// Fly a suite under a mixture of a policy and the expert, and label every state with the expert's action
#[derive(Debug, Parser)]
#[command(
    name = "dagger",
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_help = "\
Examples:
  cosfly dagger recipes/suites/street.toml --policy hold --expert-share 1 --round clone --out labels/v1
  cosfly dagger recipes/suites/street.toml --policy python:student:act --expert-share 0.5 --round first --out labels/v2 --onto labels/v1
  cosfly dagger recipes/suites/street.toml --policy hold --expert-share 1 --round clone --keep depth,mask,odometry --out labels/seen
  cosfly dagger diff labels/v1 labels/v2

A version is a folder: card.json, rounds/ROUND/EPISODE.jsonl with a line per step, and arrays of numpy over all rounds:
states.npy (n, 16), expert_actions.npy (n, 5), actions.npy (n, 5), expert_visibility.npy (n, 1), by_expert.npy (n,).
With --keep a file NAME.npy has what is seen in each state: pictures (n, rows, columns) or (n, rows, columns, 3), readings
(n, quantities).
States without a way on for the expert are left out of the arrays. The same command goes on with what a folder lacks. Exits
with 1 when the policy has given no right answer (then nothing is kept) or went away before all episodes were flown."
)]
pub struct Arguments {
    #[command(subcommand)]
    other: Option<Other>,
    #[command(flatten)]
    recipe: Option<RecipeArguments>,
    #[command(flatten)]
    store: StoreArguments,
    /// The policy: ws://HOST:PORT, python:MODULE:FUNCTION, onnx:FILE, or the name of a baseline
    #[arg(long, value_name = "POLICY", required = true)]
    policy: Option<String>,
    /// Name of the policy on the card [default: made from its place]
    #[arg(long, value_name = "NAME", value_parser = super::fly::folder_name)]
    name: Option<String>,
    #[command(flatten)]
    asked: PolicyArguments,
    /// Share of frames that the expert flies, 0 to 1; each frame of the dataset draws anew
    #[arg(long, value_name = "SHARE", default_value_t = 0.5, value_parser = share)]
    expert_share: f64,
    /// Name of the round; it draws the frames that the expert flies
    #[arg(long, value_name = "NAME", required = true, value_parser = super::fly::folder_name)]
    round: Option<String>,
    /// Pictures, of `--size-px` and `--look`, and readings of sensors that are kept with every state (repeatable)
    #[arg(long, value_name = "NAME", value_parser = observed(), value_delimiter = ',')]
    keep: Vec<Observed>,
    /// Folder for the new version
    #[arg(long, value_name = "DIR", required = true)]
    out: Option<PathBuf>,
    /// Version whose rounds the new version begins with; it stays as it is
    #[arg(long, value_name = "DIR")]
    onto: Option<PathBuf>,
    /// Episodes at the same time [default: one per core]
    #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Print the card as JSON
    #[arg(long)]
    json: bool,
}

/// Other work with versions.
#[derive(Debug, Subcommand)]
enum Other {
    Diff(diff::Arguments),
}

fn share(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (0.0..=1.0).contains(number));
    number.ok_or_else(|| "it must be 0 to 1".to_owned())
}

fn missing(what: &str) -> Box<Diagnostic> {
    Diagnostic::new("dagger-arguments", Fault::Recipe, format!("{what} is missing")).hint("see `cosfly dagger --help`")
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        if let Some(Other::Diff(arguments)) = &self.other {
            return arguments.run(console);
        }
        let recipe = self.recipe.as_ref().ok_or_else(|| missing("the suite"))?.load(console)?;
        let place = Place::read(self.policy.as_deref().ok_or_else(|| missing("`--policy`"))?)?;
        let (Some(out), Some(name)) = (&self.out, &self.round) else {
            return Err(missing("`--out` or `--round`").into());
        };
        self.asked.check(&place)?;
        if self.asked.actions(&place) != ActionKind::Velocity {
            let message = "labels are velocities; a policy of other actions cannot be labelled";
            return Err(Diagnostic::new("dagger-actions", Fault::Recipe, message).hint("leave `--actions` out").into());
        }
        let manners = self.asked.manners()?;
        check_out_folder(&self.store.folder(), out)?;
        let store = self.store.open()?;
        let jobs = threads(self.jobs);
        let options = RunOptions { jobs, cancelled: console.cancelled(), ..RunOptions::default() };
        let suite = {
            let _deadline = console.deadline(None);
            let progress = console.run_progress(self.json);
            Suite::make(&recipe, &store, &options, &*progress)?
        };
        // A label belongs to the state it is for: actions take effect at once.
        let (latency_s, seen) = (0.0, self.asked.sensors(&place));
        let kept = sensors_of(&self.keep);
        let sensors = SensorSet::of(|sensor| seen.iter().chain(kept.iter()).any(|it| it.name == sensor.name));
        let settings = EnvironmentSettings { latency_s, sensors, ..FlySettings::of(&recipe)?.environment() };
        let onto = self.onto.as_deref().map(LabelFolder::card).transpose()?;
        let card = self.card(&suite, &settings, &place, name, onto.as_ref())?;
        let folder = LabelFolder::open(out, &card, self.onto.as_deref())?;
        let mixture = PolicyMixture { by_expert: self.expert_share, seed: Seed::of_item(recipe.seed, "dagger", name) };
        let cancelled = console.cancelled();
        let policy = self.name.clone().unwrap_or_else(|| place.name());
        let (recipe, store, suite, place, manners) = (&recipe, &store, &suite, &place, &manners);
        let (policy, cancelled) = (policy.as_str(), &*cancelled);
        let round = Round {
            recipe,
            store,
            suite,
            place,
            manners,
            settings,
            mixture,
            name,
            policy,
            kept: self.kept(),
            jobs,
            cancelled,
        };
        let progress = console.progress("dagger", "episodes");
        let deadline = console.deadline(None);
        let flown = run(&round, &folder, &*progress)?;
        drop((progress, deadline));
        if let Some(problem) = &flown.gone {
            console.tell(&cosfly_diagnose::render(problem, console.colour()));
            return Ok(exit::FOUND_PROBLEMS);
        }
        if let Some((count, first)) = &flown.failures {
            let count = if *count == 1 { "1 episode".to_owned() } else { format!("{count} episodes") };
            console.tell(&format!("the policy ended {count} by its fault, whose labels end there; {first}"));
        }
        let names: Vec<&str> = suite.tasks.iter().map(|task| task.episode.name.as_str()).collect();
        let card = folder.finish(card, &names)?;
        if self.json {
            console.print(&format!("{:#}\n", serde_json::to_value(&card).unwrap_or_default()))?;
        } else {
            let path = out.display();
            console.print(&format!(
                "{path}: {} flown, the expert asked {} times\n{}",
                counted(flown.episodes, "episode"),
                flown.asked,
                told(onto.as_ref(), &card)
            ))?;
        }
        Ok(exit::SUCCESS)
    }
}

impl Arguments {
    fn kept(&self) -> KeptObservations {
        KeptObservations { pictures: self.asked.pictures_of(&self.keep), sensors: sensors_of(&self.keep) }
    }

    /// The card of the new version: the rounds of the one before, and the round to be made.
    fn card(
        &self,
        suite: &Suite,
        settings: &EnvironmentSettings,
        place: &Place,
        name: &str,
        onto: Option<&LabelCard>,
    ) -> cosfly_diagnose::Result<LabelCard> {
        let policy = self.asked.card(place, &self.name.clone().unwrap_or_else(|| place.name()));
        let round = RoundCard { name: name.to_owned(), policy, by_expert: self.expert_share, made: None };
        let (suite, environment) = (SuiteCard::of(suite), EnvironmentCard::new(settings, Latency::Simulated));
        let mut rounds = onto.map_or_else(Vec::new, |onto| onto.rounds.clone());
        let refused = |message: String| Diagnostic::new("dagger-onto", Fault::Recipe, message);
        if onto.is_some_and(|onto| onto.suite != suite || onto.environment != environment) {
            let message = "the version of `--onto` has another suite or environment".to_owned();
            return Err(refused(message).hint("its card.json names them; begin a version of its own without `--onto`"));
        }
        if let Some(round) = rounds.iter().find(|round| round.made.is_none()) {
            let message = format!("round `{}` of the version of `--onto` has not all its episodes", round.name);
            return Err(
                refused(message).hint("run the command that makes it once more: it goes on with what is missing")
            );
        }
        let kept = self.kept();
        let pictures = kept.pictures.as_ref().map(PicturesCard::of);
        let readings: Vec<String> = kept.sensors.iter().map(|sensor| sensor.name.to_owned()).collect();
        if onto.is_some_and(|onto| (&onto.pictures, &onto.readings) != (&pictures, &readings)) {
            let message = "the version of `--onto` keeps other observations".to_owned();
            let hint = "its card.json has them under `pictures` and `readings`; give the same with `--keep`";
            return Err(refused(message).hint(hint));
        }
        if rounds.iter().any(|round| round.name == name) {
            let message = format!("the version of `--onto` has a round `{name}` already");
            return Err(refused(message).hint("give the new round another name with `--round`"));
        }
        rounds.push(round);
        Ok(LabelCard { suite, environment, pictures, readings, rounds, cosfly: env!("CARGO_PKG_VERSION").to_owned() })
    }
}
