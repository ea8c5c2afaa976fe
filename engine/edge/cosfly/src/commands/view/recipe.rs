//! A recipe as the viewer shows it: what of it the store holds, again and again, and the flights that were delivered.

use crate::arguments::StoreArguments;
use cosfly_diagnose::{Result, Stop};
use cosfly_recipe::Recipe;
use cosfly_secrets::without_secrets;
use cosfly_view::{DatasetSubject, Index, ViewSubject, ViewedPicture, unknown};
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::OnceLock;

/// Most failures that are told of a stage.
const MOST_FAILURES: usize = 5;

/// A recipe, and the dataset that a run delivered, once it did.
pub struct RecipeSubject {
    recipe: Recipe,
    store: StoreArguments,
    stop: Stop,
    delivered: OnceLock<DatasetSubject>,
}

impl RecipeSubject {
    /// A recipe and its store.
    ///
    /// # Errors
    /// Those of a delivered dataset.
    pub fn open(recipe: Recipe, store: StoreArguments, stop: &Stop) -> Result<Self> {
        let subject = Self { recipe, store, stop: stop.clone(), delivered: OnceLock::new() };
        subject.delivered()?;
        Ok(subject)
    }

    /// The dataset, opened once a run has delivered it.
    fn delivered(&self) -> Result<Option<&DatasetSubject>> {
        let folder = PathBuf::from("out").join(&self.recipe.name);
        if self.delivered.get().is_none() && folder.join("data/trajectories").is_dir() {
            _ = self.delivered.set(DatasetSubject::open(&folder, &self.stop)?);
        }
        Ok(self.delivered.get())
    }

    fn dataset(&self) -> Result<&DatasetSubject> {
        self.delivered()?.ok_or_else(|| unknown("flight yet"))
    }
}

impl ViewSubject for RecipeSubject {
    fn about(&self) -> Result<Value> {
        let mut about = match self.delivered()? {
            Some(dataset) => dataset.about()?,
            None => json!({ "version": "", "flights": 0, "shown": 0, "rejected": 0 }),
        };
        about["name"] = json!(self.recipe.name);
        about["kind"] = json!("recipe");
        Ok(about)
    }

    fn index(&self) -> Result<Index> {
        self.delivered()?.map_or_else(|| Ok(Index::default()), ViewSubject::index)
    }

    fn flight(&self, number: usize) -> Result<Value> {
        self.dataset()?.flight(number)
    }

    fn bodies(&self, number: usize) -> Result<Value> {
        self.dataset()?.bodies(number)
    }

    fn town(&self, number: usize) -> Result<Value> {
        self.dataset()?.town(number)
    }

    fn picture(&self, number: usize, frame: usize, channel: &str) -> Result<ViewedPicture> {
        self.dataset()?.picture(number, frame, channel)
    }

    fn progress(&self) -> Result<Option<Value>> {
        if !self.store.folder().is_dir() {
            return Ok(Some(json!({ "stages": [] })));
        }
        let store = self.store.open_to_read()?;
        let plan = cosfly_runner::plan(&self.recipe, &store)?;
        let stages = plan.stages.iter().map(|stage| {
            let waiting = stage.plans.iter().zip(&stage.finished).filter(|(_, finished)| finished.is_none());
            let failures = waiting.filter_map(|(plan, _)| store.failure(plan)).take(MOST_FAILURES);
            let failures: Vec<String> = failures.map(|refusal| without_secrets(&refusal.message)).collect();
            json!({
                "name": stage.name.as_str(), "kind": stage.kind, "items": stage.items(), "made": stage.cached(),
                "to_run": stage.to_run(), "failures": failures,
            })
        });
        Ok(Some(json!({ "stages": stages.collect::<Vec<_>>() })))
    }
}
