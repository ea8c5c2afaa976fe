//! Words for what hides a target.

use cosfly_diagnose::Result;
use cosfly_read::{PublishedDataset, read};
use cosfly_schema::tables::Objects;
use std::collections::BTreeMap;

/// Kinds of the objects of all towns by instance id.
#[derive(Default)]
pub struct Causes {
    kinds: BTreeMap<String, BTreeMap<u32, String>>,
}

impl Causes {
    /// Kinds in table `objects`.
    ///
    /// # Errors
    /// Damage of the table.
    pub fn of(dataset: &PublishedDataset) -> Result<Self> {
        let mut causes = Self::default();
        for (_, path) in dataset.files("objects")? {
            read(&path, &mut |rows| {
                let (towns, kinds) = (rows.values(Objects::town)?, rows.values(Objects::kind)?);
                let instances = rows.values(Objects::instance)?;
                for row in 0..rows.len() {
                    let town = causes.kinds.entry(towns.text(row).to_owned()).or_default();
                    town.entry(instances.at(row)?).or_insert_with(|| words_for(kinds.text(row)));
                }
                Ok(())
            })?;
        }
        Ok(causes)
    }

    /// Words for an instance id of a town; 0 is the ground.
    pub fn words(&self, town: &str, instance: u32) -> String {
        match self.kinds.get(town).and_then(|town| town.get(&instance)) {
            _ if instance == 0 => "the ground".to_owned(),
            Some(kind) => format!("{kind} {instance}"),
            None => format!("body {instance}"),
        }
    }
}

/// A kind in words. Trunk and crown are parts of one object.
fn words_for(kind: &str) -> String {
    match kind {
        "tree_trunk" | "tree_crown" => "tree".to_owned(),
        _ => kind.replace('_', " "),
    }
}
