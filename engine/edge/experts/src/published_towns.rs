//! Towns of a dataset: the one of each flight, and their tables.

use crate::artifacts;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::Town;
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

impl PublishedTown {
    /// Digest of its artifact, hex digits.
    fn digest(&self) -> String {
        self.artifact.blobs.get(artifacts::TOWN.blob).map(|blob| blob.digest.to_string()).unwrap_or_default()
    }
}

impl PublishedTowns {
    /// Reads the towns.
    ///
    /// # Errors
    /// `towns-same-name`, or failures of reading.
    pub fn of(inputs: &Inputs<'_>) -> Result<Self> {
        let mut towns: BTreeMap<String, PublishedTown> = BTreeMap::new();
        for artifact in inputs.all("town") {
            let town = read(inputs, artifact)?;
            match towns.get(&town.name) {
                Some(known)
                    if known.artifact.blobs.get(artifacts::TOWN.blob) == artifact.blobs.get(artifacts::TOWN.blob) => {}
                Some(known) => return Err(same_name(&town.name, &known.artifact, artifact)),
                None => {
                    let layout = Arc::new(TownLayout::of(&town));
                    let known = PublishedTown { name: town.name, artifact: artifact.clone(), layout };
                    towns.insert(known.name.clone(), known);
                }
            }
        }
        Ok(Self(towns.into_values().collect()))
    }

    /// All boxes of all towns, by town.
    pub fn objects(&self, inputs: &Inputs<'_>) -> Result<Vec<ObjectRecord>> {
        let mut objects = vec![];
        for town in &self.0 {
            objects.extend(ObjectRecord::of(&read(inputs, &town.artifact)?));
        }
        Ok(objects)
    }

    /// Ground plan of the town whose artifact has a digest, hex digits.
    pub fn layout(&self, digest: &str) -> Result<Arc<TownLayout>> {
        self.town_of(digest).map(|town| Arc::clone(&town.layout)).ok_or_else(|| self.elsewhere(digest))
    }

    fn town_of(&self, digest: &str) -> Option<&PublishedTown> {
        self.0.iter().find(|town| town.digest() == digest)
    }

    /// Refuses pictures of a town that is not connected, and towns without pictures. `shown` has an item by the digest
    /// of each town that pictures show.
    ///
    /// # Errors
    /// `towns-differ`, `town-without-pictures`.
    pub fn check_pictures(&self, shown: &BTreeMap<String, String>) -> Result<()> {
        if let Some((_, stray)) = shown.iter().find(|(digest, _)| self.town_of(digest).is_none()) {
            return Err(self.elsewhere(stray));
        }
        let is_shown = |town: &PublishedTown| shown.contains_key(town.digest().as_str());
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

    fn elsewhere(&self, pictures: &str) -> Box<Diagnostic> {
        let stages: Vec<String> = self.0.iter().map(|town| format!("`{}`", town.artifact.id.stage)).collect();
        let message =
            format!("`{pictures}` was made in another town than {}, connected to `inputs.town`", stages.join(", "));
        Diagnostic::new("towns-differ", Fault::Recipe, message)
            .hint("connect to `inputs.town` the `map` stage of every town that `inputs.frames` shows")
    }
}

fn read(inputs: &Inputs<'_>, artifact: &Artifact) -> Result<Town> {
    artifacts::TOWN.read(inputs, artifact)
}

/// Refusal of two towns with one name, which tables and folders could not tell apart.
fn same_name(name: &str, a: &Artifact, b: &Artifact) -> Box<Diagnostic> {
    let (a, b) = (&a.id.stage, &b.id.stage);
    let message = format!("`{a}` and `{b}` are two different towns, and both are called `{name}`");
    Diagnostic::new("towns-same-name", Fault::Recipe, message)
        .hint(format!("give one of them a name of its own: `name = \"{name}_2\"` in `[stages.{b}]`"))
}
