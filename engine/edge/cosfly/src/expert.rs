//! The expert of a finished recipe for programs that embed cosfly: planned once, asked many times.

use crate::Refusal;
use crate::arguments::{RecipeArguments, StoreArguments};
use crate::commands::ask_expert::{answer_line, opened};
use crate::console::Console;
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_fly::experts::Experts;
use cosfly_runner::Plan;
use cosfly_store::Store;
use rayon::prelude::*;
use serde::Deserialize;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A finished recipe and its store.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExpertOptions {
    /// The recipe, or a folder with a `recipe.toml`.
    pub recipe: PathBuf,
    /// Changes, `PATH=VALUE` each.
    #[serde(default)]
    pub set: Vec<String>,
    /// Folder of the store, or `s3://BUCKET/PREFIX`; that of the environment without it.
    #[serde(default)]
    pub store: Option<PathBuf>,
}

/// The experts of a planned recipe, one set for each part of a batch.
pub struct ExpertBatches<'a> {
    plan: Arc<Plan<'a>>,
    store: &'a Store,
    parts: Vec<Experts<'a>>,
}

/// Plans the recipe and gives its experts to `work`.
///
/// # Errors
/// The errors of the recipe and of the store.
pub fn with_expert(
    options: ExpertOptions,
    console: &dyn Console,
    work: impl FnOnce(&mut ExpertBatches<'_>),
) -> Result<(), Refusal> {
    let from_environment = || std::env::var_os("COSFLY_STORE").filter(|place| !place.is_empty()).map(PathBuf::from);
    let arguments = RecipeArguments { recipe: options.recipe, overrides: options.set };
    let store = StoreArguments { store: options.store.or_else(from_environment) };
    let recipe = arguments.load(console).map_err(|refusals| Refusal::Work(refusals.0))?;
    let refused = |refusal: Box<Diagnostic>| Refusal::Work(vec![refusal]);
    let store = opened(&arguments, &store).map_err(refused)?;
    let plan = Arc::new(cosfly_runner::plan(&recipe, &store).map_err(refused)?);
    work(&mut ExpertBatches { plan, store: &store, parts: vec![] });
    Ok(())
}

impl ExpertBatches<'_> {
    /// Answers to states, both lines of JSON as `cosfly ask-expert --batch` has them, in `jobs` parts side by side. Lines that
    /// are left when `is_cancelled` have no answer.
    pub fn answers(&mut self, lines: &[String], jobs: usize, is_cancelled: &AtomicBool) -> Vec<String> {
        let size = lines.len().div_ceil(jobs.max(1)).max(1);
        while self.parts.len() < lines.len().div_ceil(size) {
            self.parts.push(Experts::new(Arc::clone(&self.plan), self.store));
        }
        let parts = self.parts.par_iter_mut().zip(lines.par_chunks(size));
        let answered = parts.map(|(experts, lines)| {
            let wanted = lines.iter().take_while(|_| !is_cancelled.load(Ordering::Relaxed));
            wanted.map(|line| answer_line(experts, line.as_bytes(), None).0).collect::<Vec<_>>()
        });
        answered.collect::<Vec<_>>().concat()
    }
}

/// Options out of their JSON.
///
/// # Errors
/// `python-value`.
pub fn options(text: &str) -> Result<ExpertOptions, Refusal> {
    serde_json::from_str(text).map_err(|error| {
        Refusal::Work(vec![
            Diagnostic::new("python-value", Fault::Input, "the options are not those of an expert").because(error),
        ])
    })
}
