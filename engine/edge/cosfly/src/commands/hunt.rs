//! `cosfly hunt`: searches a recipe's ranges for episodes in which a policy fails and the expert does not.

use super::fly::policy::PolicyArguments;
use crate::arguments::{RecipeArguments, StoreArguments, count};
use crate::command::{Command, Outcome, Refusals};
use crate::console::Console;
use crate::exit;
use clap::{Parser, ValueEnum};
use cosfly_diagnose::{Diagnostic, Fault, counted};
use cosfly_env::EnvironmentSettings;
use cosfly_fly::flight::Latency;
use cosfly_fly::hunt::found;
use cosfly_fly::hunt::pool::{Draw, Pool, draws};
use cosfly_fly::hunt::range::HuntRange;
use cosfly_fly::hunt::scouts::{Scouting, scout};
use cosfly_fly::hunt::search::{Hunted, Search, hunt};
use cosfly_fly::pilot::Place;
use cosfly_fly::results::{Card, EnvironmentCard, Folder, KeptCard, LogChoice, SuiteCard};
use cosfly_fly::run::{EpisodeShare, Order};
use cosfly_fly::suite::{NO_EPISODE, Suite, SuitePart};
use cosfly_recipe::Recipe;
use cosfly_runner::RunOptions;
use cosfly_store::{Store, check_out_folder};
use cosfly_whole::write_file;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Search a recipe's ranges for episodes in which a policy fails and the expert does not
#[derive(Debug, Parser)]
#[command(
    name = "hunt",
    after_help = "\
Examples:
  cosfly hunt recipes/suites/street.toml --policy python:student:act
  cosfly hunt recipes/suites/street.toml --policy follow:delay_s=0.3 --budget 100 --pool 800
  cosfly hunt recipes/suites/crowd.toml --policy causal --vary stages.street.people.count=50..300 --vary tool.fly.latency_ms=0..300
  cosfly fly out/hunt/street/student.act/failures.toml --tier all --policy python:student:act

Each candidate is an episode of the recipe with another seed (other places, walks, turns, crowds) and with values drawn from the ranges.
Without `--vary` these are latency, losses of sight and, for quadrotors, wind. Baselines fly every candidate first; candidates in which the
expert fails are left out. Then the policy flies as many as the budget has, the likeliest failures first; each flight tells of the next.
The folder gets the rows, failures.toml (a benchmark of the failures) and training.toml (a recipe of training data around them). The same
command goes on with what a folder lacks. Exits with 5 when the policy could not be had."
)]
pub struct Arguments {
    #[command(flatten)]
    recipe: RecipeArguments,
    #[command(flatten)]
    store: StoreArguments,
    /// The policy: ws://HOST:PORT, python:MODULE:FUNCTION, onnx:FILE, or the name of a baseline
    #[arg(long, value_name = "POLICY")]
    policy: String,
    /// Name of the policy in the result [default: made from its place]
    #[arg(long, value_name = "NAME", value_parser = super::fly::folder_name)]
    name: Option<String>,
    #[command(flatten)]
    asked: PolicyArguments,
    /// A value that varies: PATH=LOW..HIGH, or PATH=VALUE|VALUE (repeatable) [default: latency, losses of sight, wind of quadrotors]
    #[arg(long, value_name = "RANGE")]
    vary: Vec<String>,
    /// Episodes that the policy flies
    #[arg(long, value_name = "N", default_value_t = 50, value_parser = count())]
    budget: usize,
    /// Candidates that baselines fly first: 32 for each episode of the budget find most
    #[arg(long, value_name = "N", default_value_t = 1600, value_parser = count())]
    pool: usize,
    /// Order of the candidates
    #[arg(long, value_enum, value_name = "ORDER", default_value_t = SearchChoice::Likeliest)]
    search: SearchChoice,
    /// Seed of the draws [default: that of the recipe]
    #[arg(long, value_name = "SEED", value_parser = clap::value_parser!(u64).range(..=i64::MAX.unsigned_abs()))]
    seed: Option<u64>,
    /// Folder of the hunt [default: out/hunt/<recipe name>/<policy>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Episodes at the same time [default: one per core]
    #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Print the outcome as JSON
    #[arg(long)]
    json: bool,
}

/// Most worlds without an episode, one after another, that a hunt passes over.
const MOST_BARREN: usize = 20;

/// Order of the candidates.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum SearchChoice {
    /// The likeliest failures first
    Likeliest,
    /// At random: what a hunt is measured against
    Random,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let place = Place::read(&self.policy)?;
        let ranges = self.vary.iter().map(|text| HuntRange::read(text)).collect::<Result<Vec<_>, _>>()?;
        let recipe = self.recipe.load(console)?;
        if self.recipe.recipe == Path::new("-") {
            let message = "a recipe from standard input cannot be hunted in: the suite that is found names its file";
            return Err(Diagnostic::new("hunt-recipe", Fault::Recipe, message).hint("give the path of a file").into());
        }
        let ranges = if ranges.is_empty() { HuntRange::of_flights(&recipe) } else { ranges };
        let manners = self.asked.manners()?;
        self.asked.check(&place)?;
        let name = self.name.clone().unwrap_or_else(|| place.name());
        let default = || PathBuf::from("out").join("hunt").join(&recipe.name).join(&name);
        let out = self.out.clone().unwrap_or_else(default);
        check_out_folder(&self.store.folder(), &out)?;
        let store = self.store.open()?;
        let jobs = self.jobs.map_or_else(|| std::thread::available_parallelism().map_or(1, usize::from), usize::from);
        let pool = self.pool(&recipe, &ranges, &store, jobs, console)?;
        let parts = pool.suite.parts.iter();
        let settings = parts.map(|part| self.settings(part, &place)).collect::<cosfly_diagnose::Result<Vec<_>>>()?;
        let card = self.card(&pool, &place, &name, &settings);
        let folder = Folder::open(&out, &card)?;
        let cancelled = console.cancelled();
        let _deadline = console.deadline(None);
        let scouting = Scouting { settings: &settings, manners: &manners, jobs, cancelled: &cancelled };
        let told = scout(&pool, &scouting, &*console.progress("fly baselines in", "candidates"))?;
        let (suite, place, manners, settings) = (&pool.suite, &place, &manners, &settings[..]);
        let (latency, shard, cancelled) = (Latency::Simulated, EpisodeShare::WHOLE, &*cancelled);
        let order = Order { suite, place, manners, settings, latency, shard, jobs, cancelled };
        let search = match self.search {
            SearchChoice::Likeliest => Search::Likeliest,
            SearchChoice::Random => Search::Random(self.seed.unwrap_or(recipe.seed)),
        };
        let progress = console.progress("hunt", "episodes");
        let hunted = hunt(&pool, &told, &order, (search, self.budget), &folder, &*progress)?;
        drop(progress);
        self.tell((&recipe, name.as_str()), &pool, &hunted, &out, console)?;
        Ok(exit::SUCCESS)
    }
}

impl Arguments {
    /// The recipe with the changes of a draw.
    fn drawn(&self, draw: &Draw, console: &dyn Console) -> Result<Recipe, Refusals> {
        let overrides = self.recipe.overrides.iter().chain(&draw.changes).cloned().collect();
        RecipeArguments { recipe: self.recipe.recipe.clone(), overrides }.load(console)
    }

    /// Makes the candidates: world by world, until there are enough.
    fn pool(
        &self,
        recipe: &Recipe,
        ranges: &[HuntRange],
        store: &Store,
        jobs: usize,
        console: &dyn Console,
    ) -> Result<Pool, Refusals> {
        let options = RunOptions { jobs, cancelled: console.cancelled(), ..RunOptions::default() };
        let _deadline = console.deadline(None);
        let progress = console.progress("make", "candidates");
        let (mut suites, mut all, mut made, mut barren) = (vec![], vec![], 0, 0);
        for world in 0.. {
            progress(made.min(self.pool) as u64, self.pool as u64);
            if made >= self.pool {
                break;
            }
            let mut known: Option<Suite> = None;
            for draw in draws(&recipe.name, self.seed.unwrap_or(recipe.seed), ranges, world) {
                let recipe = self.drawn(&draw, console)?;
                let part = SuitePart::of(&recipe)?;
                let suite = match known {
                    Some(ref suite) => suite.clone(),
                    None => match Suite::make(&recipe, store, &options, &|_| ()) {
                        Err(refusal) if refusal.code == NO_EPISODE && barren < MOST_BARREN => {
                            barren += 1;
                            break;
                        }
                        made => {
                            barren = 0;
                            made?
                        }
                    },
                };
                made += suite.tasks.len();
                let name = recipe.name.clone();
                suites.push(Suite { name, parts: vec![part], ..suite.clone() });
                known = Some(suite);
                all.push(draw);
            }
        }
        Ok(Pool::of(format!("{}_hunt", recipe.name), suites, all, self.pool))
    }

    fn settings(&self, part: &SuitePart, place: &Place) -> cosfly_diagnose::Result<EnvironmentSettings> {
        let actions = self.asked.actions(place);
        if part.settings.drone.parameters.is_none() && actions.is_of_rotors() {
            let message = format!("a point mass takes no actions of the kind `{}`", actions.name());
            let refusal = Diagnostic::new("fly-drone", Fault::Recipe, message);
            return Err(refusal.hint("choose a quadrotor: `--set tool.fly.drone=pelican`"));
        }
        Ok(EnvironmentSettings { sensors: self.asked.sensors(place), ..part.settings.environment() })
    }

    fn card(&self, pool: &Pool, place: &Place, name: &str, settings: &[EnvironmentSettings]) -> Card {
        let (environment, environments) = EnvironmentCard::of_parts(&pool.suite.parts, settings, Latency::Simulated);
        Card {
            suite: SuiteCard::of(&pool.suite),
            policy: self.asked.card(place, name),
            environment,
            environments,
            kept: KeptCard { logs: LogChoice::None, clips: 0 },
            cosfly: env!("CARGO_PKG_VERSION").to_owned(),
        }
    }

    /// Writes the suite and the recipe, and prints the outcome.
    fn tell(
        &self,
        (recipe, policy): (&Recipe, &str),
        pool: &Pool,
        hunted: &Hunted,
        out: &Path,
        console: &dyn Console,
    ) -> Result<(), Refusals> {
        let (failures, flown) = (hunted.failures(), hunted.flown.len());
        let walks: BTreeSet<(usize, &str)> = failures.iter().map(|at| pool.walk(*at)).collect();
        let (walks, candidates, left_out) = (walks.len(), pool.suite.tasks.len(), hunted.left_out);
        if !failures.is_empty() {
            let absolute = |path: &Path| {
                let path = if path.is_dir() && path != out { path.join("recipe.toml") } else { path.to_owned() };
                path.canonicalize().map_err(|error| Diagnostic::io(format!("find {}", path.display()), &error))
            };
            let folder = absolute(out)?;
            let changes = &self.recipe.overrides;
            let file = found::beside(&folder, &absolute(&self.recipe.recipe)?);
            let suite = found::suite(pool, &format!("{}_{policy}_hunt", recipe.name), &failures, changes, &file);
            write(&out.join("failures.toml"), &suite)?;
            let worst = found::worst(pool, &failures).into_iter();
            let worst = worst.map(|part| self.drawn(&pool.draws[part], console)).collect::<Result<Vec<_>, _>>()?;
            let name = format!("{}_hunted", recipe.name);
            let seed = self.seed.unwrap_or(recipe.seed);
            write(&out.join("training.toml"), &found::training(&worst, &name, seed, &folder))?;
        }
        if self.json {
            let outcome = serde_json::json!({
                "candidates": candidates, "expert_fails": left_out, "flown": flown, "failures": failures.len(), "walks": walks,
            });
            console.print(&format!("{outcome:#}\n"))?;
            return Ok(());
        }
        let place = out.display();
        console.print(&format!(
            "{place}: {} in {flown}, of {candidates} candidates; the expert fails in {left_out}\n",
            counted(failures.len(), "failure"),
            flown = counted(flown, "episode")
        ))?;
        let next = match failures.is_empty() {
            true => "no failure was found: a larger --budget and --pool, or wider ranges with --vary, may have some\n"
                .to_owned(),
            false => format!("failures: {place}/failures.toml\ntraining data around them: {place}/training.toml\n"),
        };
        console.print(&next)?;
        Ok(())
    }
}

fn write(path: &Path, text: &str) -> cosfly_diagnose::Result<()> {
    write_file(path, text.as_bytes()).map_err(|error| Diagnostic::io(format!("write {}", path.display()), &error))
}
