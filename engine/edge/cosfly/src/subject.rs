//! [`Subject`]: episodes as commands are given them: a recipe, or a tier of a benchmark.

use crate::arguments::RecipeArguments;
use crate::command::Refusals;
use crate::console::Console;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fly::benchmark::{Benchmark, Entry, Tier};
use cosfly_fly::held_out;
use cosfly_fly::suite::{Suite, SuitePart};
use cosfly_recipe::Recipe;
use cosfly_runner::RunOptions;
use cosfly_stage::RunEvent;
use cosfly_store::Store;
use std::rc::Rc;

/// A recipe, or a tier of a benchmark.
pub struct Subject {
    /// Name of the recipe or of the tier.
    pub name: String,
    recipes: Rc<Vec<Recipe>>,
    tier: Option<Tier>,
}

impl Subject {
    /// The recipe of a file, or all tiers of the benchmark in it.
    ///
    /// # Errors
    /// All errors of recipes; `fly-benchmark`.
    pub fn all(arguments: &RecipeArguments, console: &dyn Console) -> std::result::Result<Vec<Self>, Refusals> {
        let Some(benchmark) = benchmark(arguments)? else { return Ok(vec![Self::of_recipe(arguments.load(console)?)]) };
        let recipes = recipes(&benchmark, console)?;
        Ok(benchmark.tiers.values().map(|tier| Self::of_tier(tier, &recipes)).collect())
    }

    /// The recipe of a file, or a tier of the benchmark in it.
    ///
    /// # Errors
    /// All errors of recipes; `fly-benchmark`.
    pub fn load(
        arguments: &RecipeArguments,
        tier: Option<&str>,
        console: &dyn Console,
    ) -> std::result::Result<Self, Refusals> {
        if let Some(benchmark) = benchmark(arguments)? {
            let tier = benchmark.tier(tier)?;
            return Ok(Self::of_tier(tier, &recipes(&benchmark, console)?));
        }
        if tier.is_some() {
            let message = format!("`{}` is no benchmark, so it has no tiers", arguments.recipe.display());
            let refusal = Diagnostic::new("fly-benchmark", Fault::Recipe, message);
            return Err(refusal
                .hint("leave `--tier` out, or give a benchmark such as recipes/benchmarks/track_1.toml")
                .into());
        }
        Ok(Self::of_recipe(arguments.load(console)?))
    }

    /// The recipe of a file, or of the benchmark in it the tier of a name, else the first: its hash will tell.
    ///
    /// # Errors
    /// All errors of recipes; `fly-benchmark`.
    pub fn find(arguments: &RecipeArguments, name: &str, console: &dyn Console) -> std::result::Result<Self, Refusals> {
        let all = Self::all(arguments, console)?;
        let at = all.iter().position(|subject| subject.name == name).unwrap_or(0);
        all.into_iter().nth(at).ok_or_else(|| {
            let message = format!("`{}` has no tiers", arguments.recipe.display());
            Diagnostic::new("fly-benchmark", Fault::Recipe, message).into()
        })
    }

    fn of_recipe(recipe: Recipe) -> Self {
        Self { name: recipe.name.clone(), recipes: Rc::new(vec![recipe]), tier: None }
    }

    fn of_tier(tier: &Tier, recipes: &Rc<Vec<Recipe>>) -> Self {
        Self { name: tier.name.clone(), recipes: Rc::clone(recipes), tier: Some(tier.clone()) }
    }

    /// The recipes, with their drones and air.
    ///
    /// # Errors
    /// `fly-settings`.
    pub fn parts(&self) -> Result<Vec<SuitePart>> {
        self.recipes.iter().map(SuitePart::of).collect()
    }

    /// Holds a held-out suite against its commitment: a file, or the digits themselves.
    ///
    /// # Errors
    /// `fly-commitment`.
    pub fn check(&self, suite: &Suite, commitment: &str) -> Result<()> {
        let (None, [recipe]) = (&self.tier, &self.recipes[..]) else {
            let message = format!("`{}` is a tier of a benchmark: `--commitment` is of a held-out suite", self.name);
            return Err(Diagnostic::new("fly-commitment", Fault::Recipe, message));
        };
        let is_digest = |text: &str| text.len() == 64 && text.bytes().all(|digit| digit.is_ascii_hexdigit());
        let published = match is_digest(commitment) {
            true => commitment.to_owned(),
            false => std::fs::read_to_string(commitment)
                .map_err(|error| Diagnostic::unread(format!("the commitment `{commitment}`"), &error))?,
        };
        if !is_digest(published.trim()) {
            let message =
                format!("`{commitment}` is no commitment: it must hold 64 hexadecimal digits and nothing else");
            let refusal = Diagnostic::new("fly-commitment", Fault::Input, message);
            return Err(refusal.hint("give the file NAME.commitment that `cosfly fly commit` wrote, or its digits"));
        }
        held_out::check(recipe, suite, published.trim())
    }

    /// Makes the episodes.
    ///
    /// # Errors
    /// Those of [`Suite::make`]; `fly-benchmark`.
    pub fn make(&self, store: &Store, options: &RunOptions, report: &(dyn Fn(RunEvent) + Sync)) -> Result<Suite> {
        let suite = |recipe: &Recipe| Suite::make(recipe, store, options, report);
        match &self.tier {
            Some(tier) => {
                let suites = self.recipes.iter().map(suite).collect::<Result<Vec<_>>>()?;
                tier.check(&suites)?;
                Ok(tier.of(suites))
            }
            None => suite(&self.recipes[0]),
        }
    }
}

fn benchmark(arguments: &RecipeArguments) -> Result<Option<Benchmark>> {
    let Some(benchmark) = Benchmark::read(&arguments.recipe)? else { return Ok(None) };
    if arguments.overrides.is_empty() {
        return Ok(Some(benchmark));
    }
    let message = format!("`--set` changes recipes, and `{}` is a benchmark", benchmark.name);
    let refusal = Diagnostic::new("fly-benchmark", Fault::Recipe, message);
    Err(refusal.hint("leave `--set` out, or give the recipe of a suite"))
}

fn recipes(benchmark: &Benchmark, console: &dyn Console) -> std::result::Result<Rc<Vec<Recipe>>, Refusals> {
    let load =
        |suite: &Entry| RecipeArguments { recipe: suite.recipe.clone(), overrides: suite.set.clone() }.load(console);
    let recipes: Vec<Recipe> = benchmark.suites.iter().map(load).collect::<std::result::Result<_, _>>()?;
    // Names of suites begin those of episodes.
    let is_twice = |(at, recipe): &(usize, &Recipe)| recipes[..*at].iter().any(|other| other.name == recipe.name);
    if let Some((_, recipe)) = recipes.iter().enumerate().find(is_twice) {
        let message = format!("two suites of the benchmark `{}` are called `{}`", benchmark.name, recipe.name);
        return Err(Diagnostic::new("fly-benchmark", Fault::Recipe, message)
            .hint("give one of them another `name`")
            .into());
    }
    Ok(Rc::new(recipes))
}
