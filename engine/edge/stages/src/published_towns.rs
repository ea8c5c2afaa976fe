//! Towns of a dataset: the one of each flight, and their tables.

use crate::codec;
use crate::ports::TOWN;
use crate::world::TOWN_BLOB;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_maps::Town;
use cosfly_schema::TownLayout;
use cosfly_schema::tables::ObjectRecord;
use cosfly_stage::{Artifact, Inputs};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Towns at port `town` of a dataset, each once.
pub struct PublishedTowns(Vec<PublishedTown>);

struct PublishedTown {
    name: String,
    artifact: Artifact,
    layout: Arc<TownLayout>,
}

impl PublishedTowns {
    /// Reads the towns and compares them with those that the pictures at port `frames` show.
    ///
    /// # Errors
    /// `towns-same-name`, `towns-differ`, `town-without-pictures`, or failures of reading.
    pub fn of(inputs: &Inputs<'_>) -> Result<Self> {
        let mut towns: BTreeMap<String, PublishedTown> = BTreeMap::new();
        for artifact in inputs.all("town") {
            let town = read(inputs, artifact)?;
            match towns.get(&town.name) {
                Some(known) if known.artifact.blobs.get(TOWN_BLOB) == artifact.blobs.get(TOWN_BLOB) => {}
                Some(known) => return Err(same_name(&town.name, &known.artifact, artifact)),
                None => {
                    let layout = Arc::new(TownLayout::of(&town));
                    let known = PublishedTown { name: town.name, artifact: artifact.clone(), layout };
                    towns.insert(known.name.clone(), known);
                }
            }
        }
        let towns = Self(towns.into_values().collect());
        towns.check_pictures(inputs)?;
        Ok(towns)
    }

    /// All boxes of all towns, by town.
    pub fn objects(&self, inputs: &Inputs<'_>) -> Result<Vec<ObjectRecord>> {
        let mut objects = vec![];
        for town in &self.0 {
            objects.extend(ObjectRecord::of(&read(inputs, &town.artifact)?));
        }
        Ok(objects)
    }

    /// Ground plan of the town that `frames` show.
    pub fn layout(&self, frames: &Artifact) -> Result<Arc<TownLayout>> {
        self.town_of(frames).map(|town| Arc::clone(&town.layout)).ok_or_else(|| self.elsewhere(frames))
    }

    fn town_of(&self, frames: &Artifact) -> Option<&PublishedTown> {
        self.0.iter().find(|town| town.artifact.blobs.get(TOWN_BLOB) == frames.blobs.get(TOWN_BLOB))
    }

    /// Refuses pictures of a town that is not connected, and towns without pictures.
    fn check_pictures(&self, inputs: &Inputs<'_>) -> Result<()> {
        let frames = inputs.all("frames");
        if let Some(stray) = frames.iter().find(|artifact| self.town_of(artifact).is_none()) {
            return Err(self.elsewhere(stray));
        }
        let is_shown = |town: &PublishedTown| {
            frames.iter().any(|artifact| artifact.blobs.get(TOWN_BLOB) == town.artifact.blobs.get(TOWN_BLOB))
        };
        match self.0.iter().find(|town| !is_shown(town)) {
            None => Ok(()),
            Some(town) => {
                let stage = &town.artifact.id.stage;
                let message = format!("`{stage}` is connected to `inputs.town`, but no picture shows that town");
                Err(Diagnostic::new("town-without-pictures", Fault::Recipe, message).hint(format!(
                    "connect the pictures that were taken in `{}` to `inputs.frames`, or leave `{stage}` out",
                    town.name
                )))
            }
        }
    }

    fn elsewhere(&self, frames: &Artifact) -> Box<Diagnostic> {
        let stages: Vec<String> = self.0.iter().map(|town| format!("`{}`", town.artifact.id.stage)).collect();
        let message =
            format!("`{}` was made in another town than {}, connected to `inputs.town`", frames.id, stages.join(", "));
        Diagnostic::new("towns-differ", Fault::Recipe, message)
            .hint("connect to `inputs.town` the `map` stage of every town that `inputs.frames` shows")
    }
}

fn read(inputs: &Inputs<'_>, artifact: &Artifact) -> Result<Town> {
    codec::decode(TOWN, &inputs.read(artifact, TOWN_BLOB)?)
}

/// Refusal of two towns with one name, which tables and folders could not tell apart.
fn same_name(name: &str, a: &Artifact, b: &Artifact) -> Box<Diagnostic> {
    let (a, b) = (&a.id.stage, &b.id.stage);
    let message = format!("`{a}` and `{b}` are two different towns, and both are called `{name}`");
    Diagnostic::new("towns-same-name", Fault::Recipe, message)
        .hint(format!("give one of them a name of its own: `name = \"{name}_2\"` in `[stages.{b}]`"))
}
