//! A recipe as the viewer shows it: what of it the store holds, again and again, and the flights that were delivered.

use crate::arguments::StoreArguments;
use cosfly_blobs::BlobRef;
use cosfly_diagnose::{Result, Stop};
use cosfly_experts::artifacts::FILM;
use cosfly_recipe::Recipe;
use cosfly_runner::Plan;
use cosfly_secrets::without_secrets;
use cosfly_stage::{BlobSource, StageRole};
use cosfly_store::Store;
use cosfly_view::{DatasetSubject, Index, ViewSubject, ViewedPicture, stored_picture, unknown};
use cosfly_write::FramePackReader;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::OnceLock;

/// Most failures that are told of a stage.
const MOST_FAILURES: usize = 5;
/// Most films whose first pictures are shown.
const MOST_FILMS: usize = 12;

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

    /// A colour picture of a film in the store: item `number` of the first stage that films.
    fn film(&self, number: usize, frame: usize) -> Result<ViewedPicture> {
        let store = self.store.open_to_read()?;
        let plan = cosfly_runner::plan(&self.recipe, &store)?;
        let film = films(&plan, &store).find(|film| film.number == number);
        let pack = film.ok_or_else(|| unknown(format!("film {number} in the store")))?.pack;
        let mut film = FramePackReader::new(store.open(&pack)?)?;
        if frame >= film.len() {
            return Err(unknown(format!("frame {frame}: there are {}, from 0", film.len())));
        }
        let colours = film.frame(frame)?.files.into_iter().find(|(channel, _)| channel.name == "rgb");
        let (_, bytes) = colours.ok_or_else(|| unknown("colour picture in the film"))?;
        stored_picture(bytes.to_vec())
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
        match self.delivered()? {
            Some(dataset) => dataset.picture(number, frame, channel),
            None => self.film(number, frame),
        }
    }

    fn paths(&self, number: usize) -> Result<Value> {
        self.dataset()?.paths(number)
    }

    fn progress(&self) -> Result<Option<Value>> {
        if !self.store.folder().is_dir() {
            return Ok(Some(json!({ "stages": [], "films": [] })));
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
        let shown = films(&plan, &store).take(if self.delivered.get().is_some() { 0 } else { MOST_FILMS });
        // The browser keeps pictures: the version tells those of an earlier recipe apart.
        let films = shown.map(|film| {
            let version = film.pack.digest.to_string();
            json!({ "name": film.name, "number": film.number, "version": version })
        });
        Ok(Some(json!({ "stages": stages.collect::<Vec<_>>(), "films": films.collect::<Vec<_>>() })))
    }
}

/// A film in the store.
struct Film {
    /// Number among the items of its stage.
    number: usize,
    name: String,
    pack: BlobRef,
}

/// Films of the first stage that films, those whose pictures the store still holds.
fn films<'p>(plan: &'p Plan<'_>, store: &'p Store) -> impl Iterator<Item = Film> + 'p {
    let stage = plan.recipe.stages.iter().position(|stage| stage.has_role(StageRole::Films));
    let finished = stage.into_iter().flat_map(|stage| {
        plan.stages[stage].finished.iter().enumerate().map(move |(number, finished)| (stage, number, finished))
    });
    finished.filter_map(|(stage, number, finished)| {
        let pack = *finished.as_ref()?.record.outputs.get(FILM)?;
        let name = plan.recipe.id(stage, number).to_string();
        store.holds_blob(&pack).then_some(Film { number, name, pack })
    })
}
