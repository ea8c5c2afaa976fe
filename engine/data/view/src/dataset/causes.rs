//! Words for what hides a target.

use cosfly_diagnose::Result;
use cosfly_read::{PublishedDataset, read};
use cosfly_schema::losses::cause;
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

    /// Words for what takes the target away in a loss: its cause in table `target_losses`, which is 0 for the ground and where the
    /// target is outside of the image.
    pub fn words(&self, town: &str, loss: &Loss) -> String {
        let instance = cause(loss.occluders.iter().copied());
        let nobody = loss.occluders.iter().filter(|id| **id == 0).count();
        match self.kinds.get(town).and_then(|town| town.get(&instance)) {
            _ if instance == 0 && 2 * loss.out_of_view > nobody => "out of view".to_owned(),
            _ if instance == 0 => "hidden by the ground".to_owned(),
            Some(kind) => format!("hidden by {kind} {instance}"),
            None => format!("hidden by body {instance}"),
        }
    }
}

/// Frames in a row without the target.
#[derive(Default)]
pub struct Loss {
    /// First frame.
    pub begin: usize,
    occluders: Vec<u32>,
    out_of_view: usize,
}

impl Loss {
    /// A loss that begins with the frame `begin`.
    pub fn from(begin: usize) -> Self {
        Self { begin, ..Self::default() }
    }

    /// Adds a frame.
    pub fn add(&mut self, is_in_view: bool, occluder: u32) {
        self.occluders.push(occluder);
        self.out_of_view += usize::from(!is_in_view);
    }

    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.occluders.len()
    }
}

/// A kind in words. Trunk and crown are parts of one object.
fn words_for(kind: &str) -> String {
    match kind {
        "tree_trunk" | "tree_crown" => "tree".to_owned(),
        _ => kind.replace('_', " "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_name_what_takes_the_target_away_in_most_frames() {
        let causes =
            Causes { kinds: BTreeMap::from([("town".to_owned(), BTreeMap::from([(7, words_for("tree_crown"))]))]) };
        let told = |frames: &[(bool, u32)]| {
            let mut loss = Loss::from(3);
            frames.iter().for_each(|(is_in_view, occluder)| loss.add(*is_in_view, *occluder));
            causes.words("town", &loss)
        };
        let (seven, ground, outside) = ((true, 7), (true, 0), (false, 0));
        assert_eq!(told(&[seven, outside, seven]), "hidden by tree 7");
        assert_eq!(told(&[outside, seven, outside]), "out of view");
        assert_eq!(told(&[ground, outside, ground, seven]), "hidden by the ground");
        assert_eq!(told(&[(true, 9)]), "hidden by body 9");
    }
}
